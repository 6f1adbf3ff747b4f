// Prescribed motions whose values do not match their derivatives, and valid ones that only appear not to match.
#include <gtest/gtest.h>

#include <functional>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/integrators/energy_momentum.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/system/model.hpp>

#include "support/refusal.hpp"

namespace polybody {
namespace law_watch_test {

constexpr double pi = std::numbers::pi;

/// Any function of time, with declared breakpoints.
struct Any {
  std::function<Motion(double)> motion;
  std::vector<double> jumps = {};

  Motion operator()(double t) const { return motion(t); }
  std::vector<double> breakpoints() const { return jumps; }
};
Any step_to(double value) {
  return {[=](double t) { return Motion{t < 0.5 ? 0.0 : value, 0.0, 0.0}; }};
}
Any const kink{[](double t) { return t < 0.5 ? Motion{} : Motion{t - 0.5, 1.0, 0.0}; }};

/// A rod on a pin with a prescribed motion.
struct Driven {
  using Pin = Joint<planar::Revolute, Constraint>;
  using Drive = Joint<PrescribedAngle<Any>, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Pin, Drive>> model{Gravity{0, -9.81, 0}};
  State x;

  explicit Driven(Any const& law) {
    auto const rod = model.add(planar::Rigid(1.0, 1.0 / 12.0, Placement::planar(0.5, 0)), "rod");
    model.connect(Pin{}, model.ground().at({0, 0, 0}), rod.at(Vec2(-0.5, 0)), "pin");
    model.connect(Drive{{.law = law}, {}}, model.ground().at({0, 0, 0}), rod.at(Vec2(-0.5, 0)), "drive");
    x = model.reference_state();
    x.v[2] = law(0.0).rate;
    x.v[1] = 0.5 * x.v[2];
  }
};

/// Message of a run of 1 s, and its last time and angle.
struct Said {
  std::string message;
  double t, angle;
};
template <class I>
Said said(I const& integrator, Any const& law, double h = 1e-3, std::vector<double> const& breakpoints = {}) {
  Driven driven(law);
  std::string message;
  try {
    simulate(driven.model, driven.x, integrator, {.end_time = 1.0, .step = h, .breakpoints = breakpoints}).run();
  } catch (InvalidInput const& error) {
    message = error.what();
  }
  return {message, driven.x.t, driven.x.q[2]};
}

template <class I>
void expect_refused_at_jumps(I const& integrator) {
  for (double const jump : {0.1, 2.0, pi}) {
    Said const s = said(integrator, step_to(jump));
    for (char const* part : {"joint \"drive\"", "the prescribed value", "to t = 0.5", "breakpoint"})
      EXPECT_TRUE(has(s.message, part)) << I::name << ' ' << jump << ": " << s.message;
    EXPECT_LT(s.t, 0.5005);
    EXPECT_NEAR(s.angle, 0.0, 1e-9) << I::name;
  }
  Said const s = said(integrator, kink);
  EXPECT_TRUE(has(s.message, "the prescribed rate changes by 1")) << I::name << s.message;
  EXPECT_NEAR(s.t, 0.5, 2e-3);
}

TEST(LawWatch, RefusesAJumpThatIsNotDeclaredUnderEveryIntegrator) {
  expect_refused_at_jumps(GeneralisedAlpha{});
  expect_refused_at_jumps(RungeKutta4<Projection>{});
  expect_refused_at_jumps(Radau{});
  expect_refused_at_jumps(EnergyMomentum{});
}

TEST(LawWatch, RefusesDerivativesOfAnotherFunction) {
  Any const without_rate{[](double t) { return Motion{t * t, 0.0, 0.0}; }};
  Any const half_the_rate{[](double t) { return Motion{t * t, t, 1.0}; }};
  Any const without_acceleration{
      [](double t) { return Motion{0.1 * (1.0 - std::cos(5.0 * t)), 0.5 * std::sin(5.0 * t)}; }};
  for (Any const& law : {without_rate, half_the_rate}) {
    EXPECT_TRUE(has(said(GeneralisedAlpha{}, law).message, "joint \"drive\""));
    EXPECT_TRUE(has(said(RungeKutta4<Projection>{}, law).message, "Correct the derivatives"));
    EXPECT_LT(said(Radau{}, law).t, 0.02);
  }
  EXPECT_TRUE(has(said(GeneralisedAlpha{}, without_acceleration).message, "the prescribed rate"));
}

TEST(LawWatch, AcceptsABreakpointThatIsDeclared) {
  Any declared = kink;
  declared.jumps = {0.5};
  EXPECT_EQ(said(GeneralisedAlpha{}, declared).message, "");
  EXPECT_EQ(said(EnergyMomentum{}, declared).message, "");
  Said const s = said(RungeKutta4<Projection>{}, kink, 1e-3, {0.5});  // declared in the options of the run
  EXPECT_EQ(s.message, "");
  EXPECT_NEAR(s.angle, 0.5, 1e-9);
}

// A jump of the value is refused at a breakpoint of the run too.
TEST(LawWatch, RefusesAJumpOfTheValueAtABreakpointOfTheRun) {
  Said const s = said(RungeKutta4<Projection>{}, step_to(0.1), 1e-3, {0.5});
  EXPECT_TRUE(has(s.message, "joint \"drive\": the prescribed value jumps by 0.1 at the breakpoint t = 0.5 s"))
      << s.message;
  EXPECT_NEAR(s.angle, 0.0, 1e-9);
}

// An angle may restart at zero after a full turn.
TEST(LawWatch, AcceptsWholeTurns) {
  Any const turns{[](double t) { return Motion{std::fmod(40.0 * t, 2.0 * pi), 40.0, 0.0}; }};
  EXPECT_EQ(said(GeneralisedAlpha{}, turns).message, "");
}

// Functions of time that oscillate within a step, and functions whose second derivative jumps.
TEST(LawWatch, AcceptsLawsThatStepsDoNotResolve) {
  for (double const phase : {0.0, 1.0, pi}) {
    Any const fast{[=](double t) {
      double const w = 2.0 * pi / 0.01;
      return Motion{1e-4 * (std::sin(w * t + phase) - std::sin(phase)), 1e-4 * w * std::cos(w * t + phase),
                    -1e-4 * w * w * std::sin(w * t + phase)};
    }};
    EXPECT_EQ(said(Radau{}, fast, 1e-2).message, "") << phase;
  }
  Ramp const rounded{.target = 0.1, .duration = 0.3, .start = 0.35, .rounding = 1e-3};
  EXPECT_EQ(said(GeneralisedAlpha{}, {[=](double t) { return rounded(t); }}, 5e-3).message, "");
  SmoothRamp const smooth{.target = 1.0, .duration = 0.2, .start = 0.301};
  EXPECT_EQ(said(GeneralisedAlpha{}, {[=](double t) { return smooth(t); }}, 1e-2).message, "");
}

}  // namespace law_watch_test
}  // namespace polybody
