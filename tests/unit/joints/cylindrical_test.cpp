#include <polybody/joints/standard_joints.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/joint_laws.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace cylindrical_test {

struct CylindricalCase {
  static constexpr bool planar = false;
  static constexpr int world_rows = 0;
  static Cylindrical geometry() { return {}; }
  static Mate mate(Numbers& number, double) {
    Mate mate{.d = Vec3(0, 0, number(2.0)),
              .R = exp_so3<double>(Vec3(0, 0, number(3.0))),
              .free_directions = MatX::Zero(6, 2)};
    mate.free_directions(2, 0) = mate.free_directions(5, 1) = 1.0;
    return mate;
  }
};

// b has the offset (0.3, −0.4) from the axis and is tilted about a₁ by φ, b₃ = (0, −sin φ, cos φ).
TEST(Cylindrical, RowsAreTheOffsetAndTheTilt) {
  Frame<double> const b{.r = {0.3, -0.4, 7.0}, .A = exp_so3<double>(Vec3(0.2, 0, 0))};
  Vec4 const expected(0.3, -0.4, 0.0, -std::sin(0.2));
  EXPECT_LT((constraint_function<double>(Cylindrical{}, {}, b, 0.0).g - expected).norm(), 1e-15);
}

TEST(Cylindrical, RefusesAnAxisThatIsNotAUnitVector) {
  EXPECT_TRUE(has(refusal([] { (void)Cylindrical{.axis = {0, 0, 2}}.triad(); }),
                  "Cylindrical: the axis must be a unit vector"));
}

}  // namespace cylindrical_test

namespace polybody {
bool const cylindrical_obeys = obeys<cylindrical_test::CylindricalCase, JointLaws>("Cylindrical");
}  // namespace polybody
