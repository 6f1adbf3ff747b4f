#include <polybody/forces/force_element.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/force_differences.hpp>

using namespace polybody;
using namespace polybody::laws;

namespace force_element_test {

// f = (k · pose, c · twist) of a frame, whose gradient is (k, c).
struct Linear {
  static constexpr int markers = 2;
  static constexpr MarkerKind needs = MarkerKind::point;
  static constexpr bool is_load = false;
  void check(std::string const&) const {}
  template <StateScalar T>
  std::array<Wrench<T>, 2> wrenches(std::array<Frame<T>, 2> const& f, double) const {
    std::array<Wrench<T>, 2> w;
    w[0].f = f[1].r * 2.0;
    w[0].m = f[0].v * 3.0;
    w[1].f = f[1].w * 5.0;
    w[1].m = f[0].A.col(0) * 7.0;
    return w;
  }
};
static_assert(ForceElement<Linear> && !HasPotential<Linear>);

TEST(WrenchGradient, HasPoseTimesCkAndTwistTimesCd) {
  std::array<Frame<double>, 2> const frames{};
  double const ck = 0.7, cd = 31.0;
  Mat<double, 12, 12> expected = Mat<double, 12, 12>::Zero();
  expected.block<3, 3>(0, 6) = ck * 2.0 * Mat3::Identity();
  expected.block<3, 3>(3, 0) = cd * 3.0 * Mat3::Identity();
  expected.block<3, 3>(6, 9) = cd * 5.0 * Mat3::Identity();
  expected.block<3, 3>(9, 3) = -ck * 7.0 * skew<double>(Vec3::UnitX());
  EXPECT_LT((wrench_gradient(Linear{}, frames, 0.0, ck, cd) - expected).norm(), 1e-13);
  EXPECT_LT(gradient_mismatch(Linear{}, frames, 0.0, ck, cd), 1e-10);
}

// --- concept: each requirement is checked ---------------------------------------------------------------------

struct Unchecked : Linear {
  void check(double) const {}
};
struct OfNoMarker : Linear {
  static constexpr int markers = 0;
};
struct OfOneWrenchTooMany : Linear {
  static constexpr int markers = 1;
};
struct Silent {
  static constexpr int markers = 1;
  static constexpr MarkerKind needs = MarkerKind::point;
  static constexpr bool is_load = false;
  void check(std::string const&) const {}
};
static_assert(!ForceElement<Unchecked> && !ForceElement<OfOneWrenchTooMany> && !ForceElement<Silent>);
static_assert(!ForceElement<OfNoMarker>);

}  // namespace force_element_test
