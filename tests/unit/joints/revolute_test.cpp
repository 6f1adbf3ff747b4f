#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/standard_joints.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/joint_laws.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace revolute_test {

struct RevoluteCase {
  static constexpr bool planar = false;
  static constexpr int world_rows = 3;
  static Revolute geometry() { return {}; }
  static Mate mate(Numbers& number, double) {
    Mate mate{.R = exp_so3<double>(Vec3(0, 0, number(3.0))), .free_directions = MatX::Zero(6, 1)};
    mate.free_directions(5, 0) = 1.0;
    return mate;
  }
};

struct PlanarRevoluteCase {
  static constexpr bool planar = true;
  static constexpr int world_rows = 2;
  static planar::Revolute geometry() { return {}; }
  static Mate mate(Numbers& number, double t) { return RevoluteCase::mate(number, t); }
};

TEST(Revolute, TurnsAboutItsAxis) {
  Vec3 const axis = Vec3(2, -1, 2) / 3.0;
  Mat3 const e = Revolute{.axis = axis}.triad();
  EXPECT_LT((e.transpose() * e - Mat3::Identity()).norm(), 1e-15);
  EXPECT_EQ(e.col(2), axis);
}

TEST(Revolute, RefusesAnAxisThatIsNotAUnitVector) {
  for (Vec3 const& axis : {Vec3(0, 0, 0), Vec3(0, 0, 1.001), Vec3(1, 1, 0)})
    EXPECT_TRUE(
        has(refusal([&] { (void)Revolute{.axis = axis}.triad(); }), "Revolute: the axis must be a unit vector"));
  EXPECT_TRUE(has(refusal([] { (void)Revolute{.axis = {0, NAN, 1}}.triad(); }), "Revolute: the axis must be finite"));
}

// A pin assembled in the opposite direction also satisfies the constraint equations: b₃ = −a₃.
TEST(Revolute, TakesNoAccountOfWhichWayTheAxisPoints) {
  Frame<double> const a;
  Frame<double> const b{.A = exp_so3<double>(Vec3(std::numbers::pi, 0, 0))};
  EXPECT_LT(constraint_function<double>(Revolute{}, a, b, 0.0).g.norm(), 1e-15);
}

}  // namespace revolute_test

namespace polybody {
bool const revolute_obey[] = {obeys<revolute_test::RevoluteCase, JointLaws>("Revolute"),
                              obeys<revolute_test::PlanarRevoluteCase, JointLaws>("PlanarRevolute")};
}  // namespace polybody
