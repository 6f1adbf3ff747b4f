#include <polybody/integrators/radau.hpp>

#include <gtest/gtest.h>

#include <complex>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/forces/user_force.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/penalty.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/testing/integrator_laws.hpp>

#include "support/held.hpp"
#include "support/integrator_cases.hpp"
#include "support/oscillator.hpp"
#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace radau_test {

struct RadauOnBar {
  using Model = SwingingBar;
  static auto integrators() { return std::vector<Radau>{{.tolerance = 1e-12}}; }
  static constexpr double end_time = 1.0;
  static constexpr int steps = 16;
};
struct RadauOnTop {
  using Model = SlowTop;
  static auto integrators() { return std::vector<Radau>{{.tolerance = 1e-12}}; }
  static constexpr double end_time = 0.5;
  static constexpr int steps = 16;
};
struct RadauOnSprungBody {
  using Model = SprungBody;
  static auto integrators() { return std::vector<Radau>{{.tolerance = 1e-12}}; }
  static constexpr double end_time = 1.0;
  static constexpr int steps = 24;
};

}  // namespace radau_test

namespace polybody {
bool const radau_obey[] = {obeys<radau_test::RadauOnBar, IntegratorLaws>("RadauOnBar"),
                           obeys<radau_test::RadauOnTop, IntegratorLaws>("RadauOnTop"),
                           obeys<radau_test::RadauOnSprungBody, IntegratorLaws>("RadauOnSprungBody")};
}  // namespace polybody

namespace radau_test {

/// The stability function: the Padé approximation of exp with degrees 2 and 3 [Hairer & Wanner 1996, §IV.5].
std::complex<double> growth(std::complex<double> z) {
  return (1.0 + 0.4 * z + z * z / 20.0) / (1.0 - 0.6 * z + 3.0 * z * z / 20.0 - z * z * z / 60.0);
}

// (q + i v)˙ = −i (q + i v): a step multiplies q + i v by R(−ih), for any h.
TEST(Radau, GivesItsStabilityFunctionOnAnOscillator) {
  for (double const h : {0.2, 1.0, 5.0, 1e3}) {
    Oscillator o;
    int const n = h < 10.0 ? 20 : 2;
    o.run(Radau{.tolerance = 1e-13}, h, n);
    std::complex<double> const exact = std::pow(growth({0.0, -h}), n);
    auto const claim = [](char const* what) {
      return Claim{"I1", what, By::closed_form, "stability function, Padé (2, 3) of exp", "Radau IIA"};
    };
    held(claim("place of the oscillator after n steps"), o.x.q[0], exact.real(), 1e-12, {equals("h", h), 1.0});
    held(claim("speed of the oscillator after n steps"), o.x.v[0], exact.imag(), 1e-12, {equals("h", h), 1.0});
  }
}

/// A unit mass on a spring of stiffness k whose other end moves as cos t: x˙˙ = −k (x − cos t).
struct Led {
  static constexpr double k = 1e10;
  static constexpr auto law = [](auto const& frames, double t) {
    using T = std::decay_t<decltype(frames[0].r[0])>;
    Wrench<T> w;
    w.f[0] = -k * (frames[0].r[0] - std::cos(t));
    return std::array{w};
  };
  using Force = UserForce<1, std::remove_const_t<decltype(law)>>;
  Model<Bodies<planar::Rigid>, Joints<>, Forces<Force>> model;
  State x;

  Led() {
    auto const mass = model.add(planar::Rigid(1.0, 1.0, Placement::planar(k / (k - 1.0), 0.0)), "mass");
    model.apply(Force{law}, mass.at(Vec2(0, 0)), "spring");
    x = model.reference_state();
  }
};

// Stiff accuracy [Prothero & Robinson 1974]: the initial condition is x = cos t · k/(k − 1). The force balance of the
// third stage determines x to (error of v̇)/k. Then v is the derivative of a cubic through x and converges with the
// order three of the stages.
TEST(Radau, FollowsAStiffSpringWithoutResolvingIt) {
  std::vector<double> errors;
  for (double const h : {0.2, 0.1, 0.05}) {
    Led led;
    simulate(led.model, led.x, Radau{}, {.end_time = 2.0, .step = h}).run();
    held({"I1", "place of a mass led by a stiff spring at 2 s", By::closed_form, "cos t (Prothero & Robinson)",
          "Radau IIA"},
         led.x.q[0], std::cos(2.0), 10.0 / Led::k, {equals("h", h)});
    errors.push_back(std::abs(led.x.v[0] + std::sin(2.0)));
  }
  EXPECT_GT(slopes(errors).back(), 2.8) << testing::PrintToString(errors);
  held_within({"I1", "speed of a mass led by a stiff spring at 2 s", By::closed_form, "−sin t (Prothero & Robinson)",
               "Radau IIA, h = 0.05"},
              errors.back(), 1e-5, {.scale = 1.0});
}

// Simple pendulum (R1, IFToMM A01): the exact motion, its reaction at the pivot and its acceleration.
TEST(Radau, PendulumAgreesWithTheExactMotion) {
  SwingingBar bar;
  State x = bar.start;
  simulate(bar.model, x, Radau{.tolerance = 1e-12}, {.end_time = 2.0, .step = 0.005}).run();
  auto const [angle, rate, acceleration] = bar.exact(bar.phase + 2.0);
  auto const claim = [](char const* what) {
    return Claim{"R1", what, By::closed_form, "elliptic functions", "planar Rigid, Radau IIA, h = 5e-3 s"};
  };
  held(claim("angle of the swinging bar at 2 s [rad]"), x.q[2] + 0.5 * std::numbers::pi, angle, 1e-10, {.scale = 1.0});
  held(claim("rate of the swinging bar at 2 s [rad/s]"), x.v[2], rate, 1e-10, {.scale = 1.0});
  held(claim("angular acceleration of the swinging bar at 2 s [rad/s²]"), x.a[2], acceleration, 1e-9, {.scale = 1.0});
  held_within(claim("reaction of the swinging bar at 2 s [N]"), (x.lambda + bar.reaction(2.0)).norm(), 1e-9,
              {.scale = bar.reaction(2.0).norm()});
}

// The round-off of positions divided by h² is not a tolerance for accelerations: at h = 2e-5 it would be 2e-6.
TEST(Radau, PendulumAgreesWithTheExactMotionBySmallSteps) {
  SwingingBar bar;
  State x = bar.start;
  simulate(bar.model, x, Radau{}, {.end_time = 0.2, .step = 2e-5}).run();
  auto const [angle, rate, acceleration] = bar.exact(bar.phase + 0.2);
  EXPECT_NEAR(x.q[2] + 0.5 * std::numbers::pi, angle, 3e-11);
  EXPECT_NEAR(x.v[2], rate, 3e-10);
  EXPECT_NEAR(x.a[2], acceleration, 1e-8);
}

/// Angle of a bar of 1 m and 1 kg after 0.1 s, released at rest at its pin, with steps of 1 ms that are not halved.
template <class Policy>
double angle_of_bar(Policy const& policy) {
  using Pin = Joint<planar::Revolute, Policy>;
  Model<Bodies<planar::Rigid>, Joints<Pin>> model{Gravity{0, -9.81, 0}};
  auto const bar = model.add(planar::Rigid(1.0, 1.0 / 12.0, Placement::planar(0.5, 0.0)));
  model.connect(Pin{{}, policy}, model.ground().at({0, 0, 0}), bar.at(Vec2(-0.5, 0)));
  State x = model.reference_state();
  simulate(model, x, Radau{}, {.end_time = 0.1, .step = 1e-3, .max_step_halvings = 0}).run();
  return x.q[2];
}
// The bar rotates by ωh within a step. One matrix for all stages then has an error of k (ωh)² across the spring. If h²
// times this error exceeds the mass, as for 1e15 N/m, only a matrix for each stage converges.
TEST(Radau, PassesPenaltiesOfAnyStiffness) {
  double const rigid = angle_of_bar(Constraint{});
  for (double const stiffness : {1e12, 1e13, 1e15, 1e18})
    EXPECT_NEAR(angle_of_bar(Penalty{.stiffness = stiffness, .damping = 0.0}), rigid, 1e-7) << stiffness;
}

// Lagrange polynomials of the nodes: one at their own node, zero at the others. Simpson's rule integrates them
// exactly.
TEST(RadauTableau, InterpolatesBetweenItsNodes) {
  using Tableau = detail::RadauTableau;
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(Tableau::inside(j, Tableau::c[i]).value, i == j ? 1.0 : 0.0, 1e-14);
      EXPECT_NEAR(Tableau::inside(j, Tableau::c[i]).integral, Tableau::a[i][j], 1e-14);
    }
    for (double const s : {0.3, 1.25}) {
      double const simpson =
          s / 6.0 *
          (Tableau::inside(j, 0.0).value + 4.0 * Tableau::inside(j, 0.5 * s).value + Tableau::inside(j, s).value);
      EXPECT_NEAR(Tableau::inside(j, s).integral, simpson, 1e-14);
    }
  }
}

TEST(Radau, RefusesWhatItCannotMean) {
  Oscillator o;
  EXPECT_TRUE(has(refusal([&] { o.run(Radau{.tolerance = 0.0}, 0.1, 1); }), "Radau: the tolerance must be positive"));
}

}  // namespace radau_test
