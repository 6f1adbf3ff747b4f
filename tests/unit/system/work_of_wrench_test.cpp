// Work of a force and a moment over a step: rotations of any size, springs of any stiffness.
#include <gtest/gtest.h>

#include <polybody/system/work_account.hpp>

namespace polybody {
namespace work_of_wrench_test {

/// Rotation by `angle` [rad] about a unit axis (3), by Rodrigues' formula.
Mat3 turned(Vec3 const& axis, double angle) {
  Mat3 k;
  k << 0.0, -axis[2], axis[1], axis[2], 0.0, -axis[0], -axis[1], axis[0], 0.0;
  return Mat3::Identity() + std::sin(angle) * k + (1.0 - std::cos(angle)) * k * k;
}

// The angular velocity determines the number of whole turns, and the side of a half turn.
TEST(WorkOfWrench, CountsWholeTurns) {
  Vec3 const axis(2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0);
  Mat3 const first = turned(Vec3::UnitX(), 0.7);
  for (double const angle : {1e-12, 0.3, 3.0, 3.3, -3.3, 6.0, 20.0, -100.0, 4.0 * std::numbers::pi}) {
    Mat3 const second = turned(axis, angle) * first;
    Vec3 const turn = detail::turn_between(first.data(), second.data(), axis * (angle + 0.5));
    if (std::abs(angle) == 4.0 * std::numbers::pi) {  // the axes have no unique direction
      EXPECT_NEAR(turn.dot(axis), angle, 1.0);
      continue;
    }
    EXPECT_LT((turn - axis * angle).norm(), 1e-9 * (1.0 + std::abs(angle))) << angle;
  }
}

// ½ k (x₀² − x₁²) for any two positions.
TEST(WorkOfWrench, IsExactForALinearSpring) {
  double const k = 1e6;
  for (double const to : {0.1, -2.0, 1e6}) {
    double from[23] = {0.5}, end[23] = {to};
    from[3] = from[7] = from[11] = end[3] = end[7] = end[11] = 1.0;
    from[12] = -k * from[0];
    end[12] = -k * end[0];
    double const expected = 0.5 * k * (0.25 - to * to);
    EXPECT_NEAR(detail::work_along_path(from, end, 1e-3), expected, 1e-12 * std::abs(expected));
  }
}

}  // namespace work_of_wrench_test
}  // namespace polybody
