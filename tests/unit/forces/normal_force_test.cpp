#include <polybody/forces/normal_force.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/differences.hpp>

#include <numbers>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace normal_force_test {

/// Calls visit(law, name) for one law of each kind. All their parameters differ from 1.
template <class Visit>
void with_each_law(Visit&& visit) {
  visit(SpringDamperContact{.stiffness = 2000.0, .damping = 30.0}, "SpringDamperContact");
  visit(SpringDamperContact{.stiffness = 2000.0}, "SpringDamperContact without damping");
  visit(HertzContact{.modulus = 3e6, .radius = 0.04}, "HertzContact");
  visit(HuntCrossleyContact{.stiffness = 1e4, .damping = 0.5}, "HuntCrossleyContact");
  visit(HuntCrossleyContact{.stiffness = 1e4, .exponent = 2.2, .damping = 0.3},
        "HuntCrossleyContact of another exponent");
  visit(HuntCrossleyContact{.stiffness = 1e4, .exponent = 1.0, .damping = 0.3},
        "HuntCrossleyContact of a straight spring");
}
constexpr double overlaps[] = {1e-4, 0.01, 0.04, 0.3}, rates[] = {-9.0, -1.0, -0.2, 0.0, 0.1, 3.0};

// --- values computed by hand ----------------------------------------------------------------------------------

TEST(SpringDamperContact, AddsSpringAndDamperUntilTheyWouldPull) {
  SpringDamperContact const law{.stiffness = 2000.0, .damping = 30.0};
  EXPECT_DOUBLE_EQ(law.force(0.01, 0.2), 20.0 + 6.0);
  EXPECT_DOUBLE_EQ(law.force(0.01, -0.5), 20.0 - 15.0);
  EXPECT_EQ(law.force(0.01, -1.0), 0.0);
  EXPECT_DOUBLE_EQ(law.potential(0.01), 0.1);
}

// E* √R = 3e6 · 0.2, 4/3 of it 8e5, times 0.01^1.5 = 1e-3
TEST(HertzContact, GrowsWithThePowerOfThreeHalves) {
  HertzContact const law{.modulus = 3e6, .radius = 0.04};
  EXPECT_NEAR(law.stiffness(), 8e5, 1e-9);
  EXPECT_NEAR(law.force(0.01, 7.0), 800.0, 1e-12 * 800.0);  // for every rate
  EXPECT_NEAR(law.potential(0.01), 0.4 * 800.0 * 0.01, 1e-13);
}

// 1e4 · 0.04^1.5 = 80
TEST(HuntCrossleyContact, ScalesThePowerByTheRate) {
  HuntCrossleyContact const law{.stiffness = 1e4, .damping = 0.5};
  EXPECT_NEAR(law.force(0.04, 1.0), 80.0 * 1.5, 1e-11);
  EXPECT_NEAR(law.force(0.04, -1.0), 80.0 * 0.5, 1e-11);
  EXPECT_EQ(law.force(0.04, -3.0), 0.0);
  EXPECT_NEAR(law.potential(0.04), 80.0 * 0.04 / 2.5, 1e-13);
}

// --- properties of all laws -----------------------------------------------------------------------------------

TEST(NormalForces, NeverPull) {
  with_each_law([](auto const& law, char const* name) {
    for (double const d : overlaps)
      for (double const rate : rates) {
        EXPECT_GE(law.force(d, rate), 0.0) << name;
        EXPECT_GE(law.slope(d, rate, 1.0, 1.0), 0.0) << name;
      }
    EXPECT_GT(law.force(0.01, 0.0), 0.0) << name;
  });
}

TEST(NormalForces, SlopeIsThatOfTheForce) {
  double const ck = 0.7, cd = 31.0;
  with_each_law([&](auto const& law, char const* name) {
    int pressing = 0;
    for (double const d : overlaps)
      for (double const rate : rates) {
        double const slope = law.slope(d, rate, ck, cd);
        using D = Dual<2>;
        D const seeded = law.template force<D>(D::variable(d, 0), D::variable(rate, 1));
        EXPECT_NEAR(slope, ck * seeded.d[0] + cd * seeded.d[1], 1e-13 * std::abs(slope)) << name;
        if (law.force(d, rate) == 0.0) {
          EXPECT_EQ(slope, 0.0) << name;
          continue;
        }
        ++pressing;
        double const by_d = slope_at_zero([&](double h) { return law.force(d + h, rate); }, 1e-3 * d);
        double const by_rate = slope_at_zero([&](double h) { return law.force(d, rate + h); }, 1e-6);
        EXPECT_NEAR(slope, ck * by_d + cd * by_rate, 1e-7 * slope) << name;
      }
    EXPECT_GT(pressing, 12) << name;
  });
}

// Derivative with a damper that grows with the penetration. During the approach it is the derivative of the force.
// During separation the decreasing part by d is omitted.
TEST(NormalForces, SlopeWhereTheDamperComesIn) {
  SpringDamperContact const law{.stiffness = 2000.0, .damping = 30.0, .onset = 0.02};
  for (double const d : {0.001, 0.01, 0.019, 0.021, 0.3})
    for (double const rate : {-0.2, 0.0, 0.1, 3.0}) {
      using D = Dual<2>;
      D const seeded = law.force<D>(D::variable(d, 0), D::variable(rate, 1));
      double const by_d = rate < 0.0 ? 2000.0 : seeded.d[0];
      EXPECT_NEAR(law.slope(d, rate, 0.7, 31.0), 0.7 * by_d + 31.0 * seeded.d[1], 1e-10) << d << ' ' << rate;
    }
}

TEST(NormalForces, PotentialIsTheIntegralOfTheForceAtRest) {
  with_each_law([](auto const& law, char const* name) {
    EXPECT_EQ(law.potential(0.0), 0.0) << name;
    for (double const d : overlaps) {
      double const slope = slope_at_zero([&](double h) { return law.potential(d + h); }, 1e-3 * d);
      EXPECT_NEAR(slope, law.force(d, 0.0), 1e-9 * slope) << name;
    }
  });
}

// --- restitution ----------------------------------------------------------------------------------------------

/// Restitution of a body of mass m with the initial velocity `speed`: m d̈ = −N(d, ḋ) by the classical method of
/// order four, from d = 0 to the separation. If N reaches zero at a positive penetration, it has a kink. Only there
/// the accuracy of the step is h².
template <class N>
double restitution(N const& law, double mass, double speed, double step) {
  auto const acceleration = [&](double d, double v) {
    return d > 0.0 || v > 0.0 ? -law.force(std::max(d, 0.0), v) / mass : 0.0;
  };
  double d = 0.0, v = speed;
  for (int k = 0; k < 10'000'000; ++k) {
    double const a1 = acceleration(d, v), v2 = v + 0.5 * step * a1, a2 = acceleration(d + 0.5 * step * v, v2);
    double const v3 = v + 0.5 * step * a2, a3 = acceleration(d + 0.5 * step * v2, v3);
    double const v4 = v + step * a3, a4 = acceleration(d + step * v3, v4);
    d += step / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
    v += step / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    if (v < 0.0 && (d <= 0.0 || law.force(d, v) == 0.0)) return -v / speed;
  }
  ADD_FAILURE() << "the body does not leave";
  return 0.0;
}

constexpr double wanted[] = {0.05, 0.3, 0.8, 0.99, 1.0};

TEST(SpringDamperContact, LeavesWithTheRestitutionThatWasAskedFor) {
  double const k = 3e5, m = 0.7;
  for (double const e : wanted) {
    SpringDamperContact const law = SpringDamperContact::with_restitution(k, m, e);
    EXPECT_EQ(law.stiffness, k);
    // in steps of 1e-4/√(k/m); the kink costs (ωh)² of the velocity, less than a tenth of the tolerance
    for (double const speed : {0.02, 5.0})
      EXPECT_NEAR(restitution(law, m, speed, 1e-4 * std::sqrt(m / k)), e, 1e-7) << speed;
  }
  EXPECT_EQ(SpringDamperContact::with_restitution(k, m, 1.0).damping, 0.0);
}

// ζ = ½: with the time T in units of √(m/k), d = e^(−T/2) sin(√3 T/2). The contact ends at d̈ = 0, T = 4π/(3√3), with
// ḋ = −e^(−T/2). ζ = 1: d = T e^(−T), d̈ = 0 at T = 2, ḋ = −e⁻².
TEST(SpringDamperContact, HasTheDampingOfKnownCases) {
  double const k = 100.0, m = 4.0, critical = 2.0 * std::sqrt(k * m);
  EXPECT_NEAR(
      SpringDamperContact::with_restitution(k, m, std::exp(-2.0 * std::numbers::pi / (3.0 * std::sqrt(3.0)))).damping,
      0.5 * critical, 1e-13 * critical);
  for (double const beside : {-1e-9, 0.0, 1e-9})
    EXPECT_NEAR(SpringDamperContact::with_restitution(k, m, std::exp(-2.0) + beside).damping, critical,
                1e-7 * critical);
}

TEST(SpringDamperContact, LosesMoreTheMoreItIsDamped) {
  double before = std::numeric_limits<double>::infinity();
  for (double e = 0.01; e <= 1.0; e += 0.01) {
    double const c = SpringDamperContact::with_restitution(1e4, 2.0, e).damping;
    EXPECT_LT(c, before);
    before = c;
  }
}

TEST(HuntCrossleyContact, LeavesWithTheRestitutionThatWasAskedForWhateverMassAndStiffness) {
  for (double const e : wanted)
    for (double const exponent : {1.0, 1.5, 2.2})
      for (double const m : {0.3, 20.0}) {
        double const k = 1e5, speed = 2.0;
        HuntCrossleyContact const law = HuntCrossleyContact::with_restitution(k, exponent, e, speed);
        // half a period of the undamped impact has the order of depth/speed; the force has no jump
        double const depth = std::pow(0.5 * (exponent + 1.0) * m * speed * speed / k, 1.0 / (exponent + 1.0));
        EXPECT_NEAR(restitution(law, m, speed, 1e-4 * depth / speed), e, 1e-7) << exponent << ' ' << m;
      }
}

TEST(HuntCrossleyContact, LosesMoreTheFasterItComes) {
  HuntCrossleyContact const law = HuntCrossleyContact::with_restitution(1e5, 1.5, 0.7, 1.0);
  EXPECT_NEAR(restitution(law, 1.0, 1.0, 1e-6), 0.7, 1e-7);
  // slow impacts: 1 − e = (2/3) D v [Hunt & Crossley 1975, to the first order], to the second order 4/9 (D v)²
  double const slow = law.damping * 1e-3;
  EXPECT_NEAR(restitution(law, 1.0, 1e-3, 1e-5), 1.0 - 2.0 / 3.0 * slow, slow * slow);
  EXPECT_LT(restitution(law, 1.0, 3.0, 1e-6), 0.6);
}

// Errors of the explicit formulas that the comments of `with_restitution` state, by integration.
TEST(NormalForces, ExplicitFormulasForTheRestitutionHaveTheStatedErrors) {
  double const k = 1e4, m = 1.0, speed = 1.0, step = 1e-6;
  struct Stated {
    double wanted, decrement, hunt_crossley;
  };
  for (Stated const& s :
       {Stated{0.95, 0.951, 0.952}, Stated{0.7, 0.718, 0.768}, Stated{0.5, 0.550, 0.663}, Stated{0.1, 0.253, 0.516}}) {
    double const e = s.wanted, zeta = -std::log(e) / std::hypot(std::numbers::pi, std::log(e));
    SpringDamperContact const spring{.stiffness = k, .damping = 2.0 * zeta * std::sqrt(k * m)};
    EXPECT_NEAR(restitution(spring, m, speed, step), s.decrement, 6e-4);
    HuntCrossleyContact const power{.stiffness = k, .damping = 1.5 * (1.0 - e) / speed};
    EXPECT_NEAR(restitution(power, m, speed, step), s.hunt_crossley, 6e-4);
  }
}

// Within the onset δ, the damper takes ∫ (c/δ) d ḋ² dt = (2/3) (c/δ) v³ m/k of ½ m v² in an impact of the velocity v,
// so that 1 − e = (2/3) c v/(k δ) to the first order. An impact far beyond the onset has the restitution without it.
TEST(SpringDamperContact, OnsetRaisesTheRestitutionOfSlowImpacts) {
  double const k = 1e4, m = 1.0, onset = 1e-3;
  SpringDamperContact law = SpringDamperContact::with_restitution(k, m, 0.5);
  law.onset = onset;
  double before = 1.0;
  for (double const speed : {1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0}) {
    double const e = restitution(law, m, speed, 1e-6), first_order = 2.0 / 3.0 * law.damping * speed / (k * onset);
    EXPECT_LT(e, before) << speed;
    if (speed < 0.01) {
      EXPECT_NEAR(1.0 - e, first_order, 3.0 * first_order * first_order) << speed;
    }
    before = e;
  }
  EXPECT_NEAR(before, 0.5, 0.01);
}

// --- bad input ------------------------------------------------------------------------------------------------

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();

TEST(NormalForces, RefuseNumbersThatCannotBeMeantByName) {
  auto const told = [](auto const& law) { return refusal([&] { law.check("\"bumper\""); }); };
  for (double const bad : {-1.0, nan, infinity}) {
    EXPECT_TRUE(has(told(SpringDamperContact{.stiffness = bad}), "\"bumper\": the contact stiffness must be positive"));
    EXPECT_TRUE(has(told(SpringDamperContact{.stiffness = 1.0, .damping = bad}),
                    "\"bumper\": the contact damping must be zero"));
    EXPECT_TRUE(
        has(told(HertzContact{.modulus = bad, .radius = 1.0}), "\"bumper\": the contact modulus must be positive"));
    EXPECT_TRUE(
        has(told(HertzContact{.modulus = 1.0, .radius = bad}), "\"bumper\": the contact radius must be positive"));
    EXPECT_TRUE(has(told(HuntCrossleyContact{.stiffness = bad, .damping = 0.0}), "\"bumper\": the contact stiffness"));
    EXPECT_TRUE(has(told(HuntCrossleyContact{.stiffness = 1.0, .damping = bad}), "\"bumper\": the contact damping"));
    EXPECT_TRUE(has(told(HuntCrossleyContact{.stiffness = 1.0, .exponent = bad, .damping = 0.0}),
                    "\"bumper\": the exponent of the contact law must be at least 1, but is " + number(bad)));
  }
  EXPECT_TRUE(has(told(HuntCrossleyContact{.stiffness = 1.0, .exponent = 0.5, .damping = 0.0}),
                  "must be at least 1, but is 0.5"));
  with_each_law([](auto const& law, char const*) { EXPECT_NO_THROW(law.check("\"bumper\"")); });
}

TEST(NormalForces, RefuseRestitutionsThatNoImpactHas) {
  std::string const range = "Contact: the coefficient of restitution must lie in (0, 1], but is ";
  for (double const bad : {0.0, -0.5, 1.01, nan, infinity}) {
    EXPECT_TRUE(has(refusal([&] { SpringDamperContact::with_restitution(1e5, 1.0, bad); }),
                    "SpringDamper" + range + number(bad)));
    EXPECT_TRUE(has(refusal([&] { HuntCrossleyContact::with_restitution(1e5, 1.5, bad, 1.0); }),
                    "HuntCrossley" + range + number(bad)));
  }
  for (double const bad : {0.0, -1.0, nan, infinity}) {
    EXPECT_TRUE(
        has(refusal([&] { SpringDamperContact::with_restitution(bad, 1.0, 0.5); }), "the stiffness must be positive"));
    EXPECT_TRUE(
        has(refusal([&] { SpringDamperContact::with_restitution(1e5, bad, 0.5); }), "the mass must be positive"));
    EXPECT_TRUE(has(refusal([&] { HuntCrossleyContact::with_restitution(1e5, 1.5, 0.5, bad); }),
                    "the speed of the impact must be positive"));
  }
}

// --- the concept ----------------------------------------------------------------------------------------------

struct WithoutSlope {
  template <StateScalar T>
  T force(T const& d, T const&) const {
    return d;
  }
  double potential(double d) const { return 0.5 * d * d; }
  void check(std::string const&) const {}
};
static_assert(!NormalForce<WithoutSlope> && !NormalForce<double>);

}  // namespace normal_force_test
