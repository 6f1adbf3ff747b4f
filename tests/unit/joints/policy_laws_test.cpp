// The requirements on policies with a force law, applied to the policies of the library.
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/policies/penalty.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/policy_laws.hpp>

namespace polybody {
using namespace laws;
namespace policy_laws_test {

struct PenaltyCase {
  static constexpr int rows = 5;
  static constexpr double violation = 1e-3;
  static Penalty policy() { return {.stiffness = 2000.0, .damping = 30.0}; }
};
struct PenaltyPerRowCase {
  static constexpr int rows = 3;
  static PenaltyPerEquation<3> policy() { return {.stiffness = Vec3(1, 10, 100), .damping = Vec3(0, 2, 4)}; }
};
struct BushingCase {
  static constexpr int rows = 6;
  static Bushing policy() {
    Mat<double, 6, 6> const b = Numbers(1).vec<6>() * Numbers(2).vec<6>().transpose();
    Bushing::Matrix const k = b.transpose() * b + Bushing::Matrix::Identity();
    return {.stiffness = 100.0 * k, .damping = 3.0 * k};
  }
};
struct NonlinearBushingCase {
  static constexpr int rows = 6;
  static auto policy() {
    LinearLaw const linear{.stiffness = 40.0, .damping = 2.0};
    MonotoneTable const table{{{-1.0, -9.0}, {-0.2, -1.0}, {0.0, 0.0}, {0.3, 2.0}, {1.0, 20.0}}};
    TabulatedLaw const tabulated{table, 0.5};
    return NonlinearBushing(linear, tabulated, linear, tabulated, linear, linear);
  }
};
bool const policies_obey[] = {
    obeys<PenaltyCase, PolicyLaws>("Penalty"), obeys<PenaltyPerRowCase, PolicyLaws>("PenaltyPerEquation"),
    obeys<BushingCase, PolicyLaws>("Bushing"), obeys<NonlinearBushingCase, PolicyLaws>("NonlinearBushing")};

}  // namespace policy_laws_test
}  // namespace polybody
