#include <polybody/forces/tyre.hpp>

#include <gtest/gtest.h>

#include "support/held.hpp"
#include "support/refusal.hpp"
#include "support/tyres.hpp"

namespace polybody::tyre_test {

static_assert(TyreLaw<LinearTyre> && TyreLaw<MagicFormula> && !TyreLaw<MagicCurve>);

TyreForce<double> of(auto const& law, double kappa, double tangent, double camber, double load) {
  return law.template force<double>({kappa, tangent, camber, load});
}

TEST(LinearTyre, IsLinearWithinTheEllipse) {
  auto const f = of(linear_tyre, 0.01, -0.02, 0.1, 4e3);
  EXPECT_NEAR(f.x, 600.0, 1e-10);
  EXPECT_NEAR(f.y, -800.0 - 200.0, 1e-10);
  EXPECT_NEAR(f.aligning, 0.03 * 1000.0, 1e-12);
}

TEST(LinearTyre, SaturatesOnTheEllipse) {
  for (double const load : {100.0, 1e3, 3e3}) {
    auto const f = of(linear_tyre, -0.3, 0.2, 0.0, load);
    EXPECT_NEAR(std::hypot(f.x / 1.1, f.y / 0.9), load, 1e-10 * load);
    EXPECT_NEAR(f.x / f.y, -0.3 * 6e4 / (0.2 * 4e4), 1e-12);  // the direction of the linear forces
  }
  EXPECT_NEAR(of(linear_tyre, -1.0, 0.0, 0.0, 2e3).x, -1.1 * 2e3, 1e-9);
  EXPECT_NEAR(of(linear_tyre, 0.0, 1.0, 0.0, 2e3).y, 0.9 * 2e3, 1e-9);
}

TEST(LinearTyre, IsContinuousAtTheEllipseAndWithoutLoad) {
  double const edge = 0.9 * 3e3 / 4e4;  // tan α at which F_y = μ_y N
  EXPECT_NEAR(of(linear_tyre, 0.0, edge * (1.0 - 1e-9), 0.0, 3e3).y,
              of(linear_tyre, 0.0, edge * (1.0 + 1e-9), 0.0, 3e3).y, 1e-5);
  auto const f = of(linear_tyre, 0.2, 0.1, 0.0, 1e-6);
  EXPECT_LT(std::hypot(f.x, f.y), 2e-6);
  auto const none = of(linear_tyre, 0.2, 0.1, 0.0, 0.0);
  EXPECT_EQ(std::hypot(none.x, none.y), 0.0);
}

// Coefficients a₁ to a₈ of Bakker, Nyborg & Pacejka 1987 at a load of 4 kN, with x in degrees or percent:
//   D = a₁ F² + a₂ F, E = a₆ F² + a₇ F + a₈, BCD = a₃ sin(a₄ atan(a₅ F)) for F_y, (a₃ F² + a₄ F) e^{−a₅ F} otherwise.
// The values follow from the formula with 25 digits (mpmath).
TEST(MagicFormula, AgreesWithPublishedCoefficients) {
  struct Row {
    double x, value;
  };
  auto const check = [](char const* what, MagicCurve const& curve, std::initializer_list<Row> rows) {
    for (Row const& row : rows)
      held({"Magic Formula", what, By::published, "Magic Formula, coefficients of the paper at 4 kN", "MagicCurve"},
           curve.value(row.x), row.value, 1e-9 * std::abs(row.value), {equals("x", row.x)});
  };
  double const f = 4.0;
  double const side = 1078.0 * std::sin(1.82 * std::atan(0.208 * f)), side_peak = -22.1 * f * f + 1011.0 * f;
  check("lateral force [N] at a slip angle [°]",
        {.B = side / (1.3 * side_peak), .C = 1.3, .D = side_peak, .E = -0.354 * f + 0.707},
        {{0.5, 511.43296366593},
         {2.0, 1911.0598390579},
         {5.0, 3389.6009850925},
         {20.0, 3557.9247422029},
         {-5.0, -3389.6009850925}});
  double const along = (49.6 * f * f + 226.0 * f) * std::exp(-0.069 * f), peak = -21.3 * f * f + 1144.0 * f;
  check("brake force [N] at a slip [%]",
        {.B = along / (1.65 * peak), .C = 1.65, .D = peak, .E = -0.006 * f * f + 0.056 * f + 0.486},
        {{0.5, 638.71477239561}, {2.0, 2281.7749558502}, {5.0, 3823.6815961286}, {20.0, 4014.7632901488}});
  double const turn = (-1.86 * f * f - 2.73 * f) * std::exp(-0.110 * f), turn_peak = -2.72 * f * f - 2.28 * f;
  check("aligning moment [N m] at a slip angle [°]",
        {.B = turn / (2.4 * turn_peak), .C = 2.4, .D = turn_peak, .E = -0.070 * f * f + 0.643 * f - 4.04},
        {{0.5, -13.035435729725}, {2.0, -45.810502265871}, {5.0, -33.314088460316}, {20.0, 21.409318251693}});
}

// y = D at the peak; y(x)/x → B C D at zero.
TEST(MagicFormula, PureSlipGivesTheCurves) {
  for (double const s : {-1.0, -0.1, 1e-12, 0.004, 0.3}) {
    auto const along = of(magic_tyre, s, 0.0, 0.0, 3e3), side = of(magic_tyre, 0.0, s, 0.0, 3e3);
    EXPECT_NEAR(along.x, 3e3 * magic_tyre.longitudinal.value.value(s), 1e-11 * 3e3);
    EXPECT_NEAR(side.y, 3e3 * magic_tyre.lateral.value.value(s), 1e-11 * 3e3);
    EXPECT_NEAR(side.aligning, 3e3 * magic_tyre.aligning.value(s), 1e-11 * 3e3);
    EXPECT_EQ(along.y, 0.0);
    EXPECT_EQ(side.x, 0.0);
  }
  EXPECT_NEAR(of(magic_tyre, 1e-6, 0.0, 0.0, 1.0).x, 10.0 * 1.9 * 1e-6, 1e-14);
}

TEST(MagicFormula, CombinedSlipRemainsWithinTheEllipse) {
  double greatest = 0.0;
  for (double angle = 0.0; angle < 6.3; angle += 0.1)
    for (double s = 0.01; s < 2.0; s *= 1.3) {
      auto const f = of(magic_tyre, s * std::cos(angle), s * std::sin(angle), 0.0, 2.0);
      double const use = std::hypot(f.x / 1.0, f.y / 0.92) / 2.0;
      greatest = std::max(greatest, use);
      EXPECT_GE(f.x * std::cos(angle), -1e-12);  // both forces oppose the slip velocity
      EXPECT_GE(f.y * std::sin(angle), -1e-12);
    }
  EXPECT_LE(greatest, 1.0 + 1e-12);
  EXPECT_GT(greatest, 0.99);
}

TEST(MagicFormula, CamberShiftsTheSlipAngle) {
  EXPECT_NEAR(of(magic_tyre, 0.02, 0.03, 0.2, 3e3).y, of(magic_tyre, 0.02, 0.03 - 0.05 * 0.2, 0.0, 3e3).y, 1e-9);
  EXPECT_LT(of(magic_tyre, 0.0, 0.0, 0.2, 3e3).y, 0.0);  // a wheel that leans to the right is pushed to the right
}

// Sentences of invalid parameters.
TEST(TyreLaws, RefuseInvalidParameters) {
  double const nan = std::numeric_limits<double>::quiet_NaN();
  auto const refused = [](auto law, auto const& change, char const* sentence) {
    change(law);
    EXPECT_TRUE(has(refusal([&] { law.check("tyre"); }), sentence));
  };
  refused(
      linear_tyre, [](LinearTyre& t) { t.longitudinal_stiffness = 0.0; },
      "tyre: the longitudinal stiffness of the tyre must be positive and finite, but is 0");
  refused(
      linear_tyre, [](LinearTyre& t) { t.cornering_stiffness = -1.0; },
      "the cornering stiffness of the tyre must be pos");
  refused(
      linear_tyre, [](LinearTyre& t) { t.longitudinal_friction = 0.0; },
      "the longitudinal friction of the tyre must be");
  refused(
      linear_tyre, [&](LinearTyre& t) { t.lateral_friction = nan; },
      "the lateral friction of the tyre must be positive");
  refused(
      linear_tyre, [](LinearTyre& t) { t.camber_stiffness = -2.0; },
      "the camber stiffness of the tyre must be zero or");
  refused(linear_tyre, [&](LinearTyre& t) { t.trail = nan; }, "the trail of the tyre must be finite");
  refused(
      magic_tyre, [](MagicFormula& t) { t.longitudinal.value.B = 0.0; },
      "the stiffness factor B of the longitudinal curve");
  refused(
      magic_tyre, [](MagicFormula& t) { t.lateral.value.C = -1.3; }, "the shape factor C of the lateral curve must be");
  refused(
      magic_tyre, [](MagicFormula& t) { t.lateral.value.D = -1.0; },
      "the peak factor D of the lateral curve must be positive");
  refused(
      magic_tyre, [&](MagicFormula& t) { t.aligning.D = nan; },
      "the peak factor D of the aligning curve must be finite");
  refused(
      magic_tyre, [](MagicFormula& t) { t.aligning.E = 1.5; },
      "the curvature factor E of the aligning curve must be at most 1, but is 1.5");
  refused(
      magic_tyre, [](MagicFormula& t) { t.camber_factor = -0.1; },
      "the camber factor of the tyre must be zero or positive");
}

}  // namespace polybody::tyre_test
