// Law tests of force elements for those of the library.
#include <polybody/forces/loads.hpp>
#include <polybody/forces/springs.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/force_laws.hpp>

namespace polybody {
using namespace laws;
namespace force_laws_test {

struct SpringDamperCase {
  static SpringDamper force() { return {.stiffness = 80.0, .damping = 3.0, .free_length = 0.7}; }
};
struct AxialSpringCase {
  static AxialSpring force() {
    return {.stiffness = 70.0, .damping = 2.0, .preload = 5.0, .axis = Vec3(2, -1, 2) / 3.0};
  }
};
struct MaxwellCase {
  static MaxwellElement force() { return {.stiffness = 80.0, .damping = 3.0, .free_length = 0.7}; }
};
struct DeadForceCase {
  static PointForce<> force() { return {.force = {1, 2, 3}, .axes = LoadAxes::world}; }
};
struct FollowerMomentCase {
  static PointMoment<> force() { return {.moment = {1, 2, 3}, .axes = LoadAxes::marker}; }
};
bool const forces_obey[] = {
    obeys<SpringDamperCase, ForceLaws>("SpringDamper"), obeys<AxialSpringCase, ForceLaws>("AxialSpring"),
    obeys<MaxwellCase, ForceLaws>("MaxwellElement"), obeys<DeadForceCase, ForceLaws>("PointForce"),
    obeys<FollowerMomentCase, ForceLaws>("PointMoment")};

}  // namespace force_laws_test
}  // namespace polybody
