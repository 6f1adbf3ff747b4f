#include <polybody/joints/standard_joints.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/joint_laws.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace revolute_pin_test {

struct RevolutePinCase {
  static constexpr bool planar = false;
  static constexpr int world_rows = 0;
  static RevolutePin geometry() { return {.distance = 0.6}; }
  static Mate mate(Numbers& number, double) {
    Mate mate{.d = Vec3(0, 0, 0.6), .R = exp_so3<double>(Vec3(0, 0, number(3.0))), .free_directions = MatX::Zero(6, 1)};
    mate.free_directions(5, 0) = 1.0;
    return mate;
  }
};

// Constraint equations of the revolute joint [Wallin 2016, Eq. 3.8] by hand: b is tilted about a₁ by φ, b₃ = (0, −sin
// φ, cos φ), d = (0.1, 0.2, 0.3).
TEST(RevolutePin, RowsAreThoseOfTheThesis) {
  Frame<double> const b{.r = {0.1, 0.2, 0.3}, .A = exp_so3<double>(Vec3(0.25, 0, 0))};
  Vec<double, 5> expected;
  expected << 0, -std::sin(0.25), 0.1, 0.2, 0.14 - 0.25;
  EXPECT_LT((constraint_function<double>(RevolutePin{.distance = 0.5}, {}, b, 0.0).g - expected).norm(), 1e-15);
}

// The requirement L > 0: at coincident points the fifth row of the Jacobian is zero.
TEST(RevolutePin, WouldHaveRankFourAtOnePoint) {
  EXPECT_EQ((constraint_function<double>(RevolutePin{.distance = 0.0}, {}, {}, 0.0).Gb.row(4).norm()), 0.0);
  for (double const l : {0.0, -0.1, double(NAN)})
    EXPECT_TRUE(has(refusal([&] { RevolutePin{.distance = l}.check("\"pin\""); }),
                    "\"pin\": the distance of its points along the axis must be positive"));
}

TEST(RevolutePin, RefusesAnAxisThatIsNotAUnitVector) {
  EXPECT_TRUE(
      has(refusal([] { (void)RevolutePin{.distance = 1.0, .axis = {0, 0, 2}}.triad(); }), "RevolutePin: the axis"));
}

}  // namespace revolute_pin_test

namespace polybody {
bool const revolute_pin_obeys = obeys<revolute_pin_test::RevolutePinCase, JointLaws>("RevolutePin");
}  // namespace polybody
