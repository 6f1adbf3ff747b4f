#include <polybody/math/secant.hpp>

#include <gtest/gtest.h>

#include <polybody/math/simd_vector.hpp>
#include <polybody/math/types.hpp>

using namespace polybody;

namespace secant_test {

static_assert(StateScalar<Secant<3>> && KernelScalar<Secant<3>>);

/// Requirements on the discrete gradient s of a function of two variables. Its values are exact at both ends; s·Δx =
/// Δf; s is symmetric in start and end. s equals the gradient at the middle, computed by dual numbers, up to
/// O(|Δx|²).
template <class F>
void expect_slope(F&& f) {
  double const x = 0.7, y = 1.3;
  for (double const step : {0.0, 1e-8, 1e-4, 1e-2, 0.5}) {
    double const dx = step, dy = -0.8 * step;
    using S = Secant<2>;
    S const s = f(S::variable(x, x + dx, 0), S::variable(y, y + dy, 1));
    S const back = f(S::variable(x + dx, x, 0), S::variable(y + dy, y, 1));
    using D = Dual<2>;
    D const middle = f(D::variable(x + 0.5 * dx, 0), D::variable(y + 0.5 * dy, 1));
    EXPECT_NEAR(s.a, f(D(x), D(y)).v, 1e-15);
    EXPECT_NEAR(s.b, f(D(x + dx), D(y + dy)).v, 1e-15);
    EXPECT_NEAR(s.d[0] * dx + s.d[1] * dy, s.change(), 2e-15) << step;
    for (int i = 0; i < 2; ++i) {
      EXPECT_NEAR(s.d[i], back.d[i], 1e-14);
      EXPECT_NEAR(s.d[i], middle.d[i], 1e-13 + step * step) << step;
    }
  }
}

TEST(Secant, SlopesGiveTheChangeAndTendToTheGradient) {
  expect_slope([](auto const& x, auto const& y) { return x + y * 2.0 - 3.0; });
  expect_slope([](auto const& x, auto const& y) { return x * y; });
  expect_slope([](auto const& x, auto const& y) { return x / y; });
  expect_slope([](auto const& x, auto const& y) { return 1.0 / (x * x + y); });
  expect_slope([](auto const& x, auto const& y) { return sqrt(x * x + y * y); });
  expect_slope([](auto const& x, auto const& y) { return sin(x) + cos(y); });
  expect_slope([](auto const& x, auto const& y) { return atan2(y, x); });
  expect_slope([](auto const& x, auto const& y) { return atan(x * y); });
  expect_slope([](auto const& x, auto const& y) { return -(x * x) + sqrt(y); });
}

// Slightly less than half a turn, across the negative axis: the angle is continuous at the jump of atan2.
TEST(Secant, AngleGoesOnAcrossTheNegativeAxis) {
  using S = Secant<2>;
  S const x = S::variable(-1.0, -1.0, 0), y = S::variable(0.1, -0.1, 1), angle = atan2(y, x);
  EXPECT_NEAR(angle.change(), 2.0 * std::atan(0.1), 1e-15);
  EXPECT_NEAR(angle.d[1] * -0.2, angle.change(), 1e-15);
}

// For |p| and any function of it the discrete gradient is along p̄ and perpendicular to ω × p̄, although p rotates by
// 1 rad and stretches.
TEST(Secant, SlopeOfALengthHasNoMoment) {
  using S = Secant<3>;
  Vec3 const from(1.0, 0.2, -0.3), to(0.4, 1.3, 0.5), middle = 0.5 * (from + to);
  Vec<S, 3> p;
  for (int i = 0; i < 3; ++i) p[i] = S::variable(from[i], to[i], i);
  S const f = 1.0 / sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) + p.squaredNorm();
  Vec3 const slope = f.d.matrix();
  EXPECT_GT(slope.norm(), 0.1);
  EXPECT_LT(middle.cross(slope).norm(), 1e-15);
}

TEST(Secant, RootOfAConstantZeroIsConstant) {
  Secant<1> const root = sqrt(Secant<1>(0.0));
  EXPECT_EQ(root.a, 0.0);
  EXPECT_EQ(root.d[0], 0.0);
}

}  // namespace secant_test
