#include <polybody/integrators/runge_kutta.hpp>

#include <gtest/gtest.h>

#include <polybody/forces/user_force.hpp>
#include <polybody/testing/integrator_laws.hpp>

#include "support/integrator_cases.hpp"
#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace runge_kutta_test {

struct Rk4OnFreeBody {
  using Model = SprungBody;
  static auto integrators() { return std::vector<RungeKutta4<>>(1); }
  static constexpr double end_time = 1.0;
  static constexpr int steps = 32;
};
struct Rk4OnBar {
  using Model = SwingingBar;
  static auto integrators() { return std::vector<RungeKutta4<Projection>>(1); }
  static constexpr double end_time = 0.5;
  static constexpr int steps = 8;
};
struct Rk4OnTop {
  using Model = SlowTop;
  static auto integrators() { return std::vector<RungeKutta4<Projection>>(1); }
  static constexpr double end_time = 0.5;
  static constexpr int steps = 16;
};

}  // namespace runge_kutta_test

namespace polybody {
bool const runge_kutta_obey[] = {obeys<runge_kutta_test::Rk4OnFreeBody, IntegratorLaws>("Rk4OnFreeBody"),
                                 obeys<runge_kutta_test::Rk4OnBar, IntegratorLaws>("Rk4OnBar"),
                                 obeys<runge_kutta_test::Rk4OnTop, IntegratorLaws>("Rk4OnTop")};
}  // namespace polybody

namespace runge_kutta_test {

template <class Stabilisation>
DormandPrince<Stabilisation> with_tolerance(double tolerance) {
  return {.relative_tolerance = tolerance, .absolute_tolerance = tolerance};
}

/// Errors of a run to 1 s with tolerances 1e-4, 1e-6, 1e-8, 1e-10, relative to `exact`.
template <class I, class M>
std::vector<double> errors_by_tolerance(M const& model, State const& start, VecX const& exact) {
  std::vector<double> errors;
  for (double const tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
    State x = start;
    I integrator;
    integrator.relative_tolerance = integrator.absolute_tolerance = tolerance;
    simulate(model, x, integrator, {.end_time = 1.0, .step = 0.01}).run();
    errors.push_back((x.q - exact).norm());
    EXPECT_LT(errors.back(), 100.0 * tolerance);
  }
  return errors;
}

/// Over six decades of tolerance the error falls by six decades, within one decade, and by at least one decade
/// between successive tolerances.
void expect_proportional(std::vector<double> const& errors) {
  EXPECT_NEAR(std::log10(errors.front() / errors.back()), 6.0, 1.0) << testing::PrintToString(errors);
  for (std::size_t i = 1; i < errors.size(); ++i)
    EXPECT_GT(std::log10(errors[i - 1] / errors[i]), 1.0) << testing::PrintToString(errors);
}

TEST(DormandPrince, ErrorOfAPendulumIsProportionalToTheTolerance) {
  SwingingBar bar;
  double const angle = bar.exact(bar.phase + 1.0).angle;
  VecX const exact = Vec3(0.5 * std::sin(angle), -0.5 * std::cos(angle), angle - 0.5 * std::numbers::pi);
  expect_proportional(errors_by_tolerance<DormandPrince<Projection>>(bar.model, bar.start, exact));
}

TEST(DormandPrince, ErrorOfAFreeBodyIsProportionalToTheTolerance) {
  SprungBody body;
  State fine = body.start;
  simulate(body.model, fine, RungeKutta4<>{}, {.end_time = 1.0, .step = 1.0 / 8192}).run();
  expect_proportional(errors_by_tolerance<DormandPrince<>>(body.model, body.start, fine.q));
}

/// A point of mass 1 on the x axis under the force law(x, v, t); the rotation in the plane stays at rest.
template <class Law>
struct Point {
  using Force = UserForce<1, Law>;
  Model<Bodies<planar::Rigid>, Joints<>, Forces<Force>> model;
  State x;

  Point(Law law, double x0, double v0) {
    auto const point = model.add(planar::Rigid(1.0, 1.0, Placement::planar(x0, 0.0)), "point");
    model.apply(user_force<1>(law), point.at(Vec2(0, 0)), "law");
    x = model.reference_state();
    model.set_velocity(x, point, Vec3(v0, 0, 0), Vec3::Zero());
  }
};

/// Converts a function of x and v to a force law over frames.
template <class F>
auto along_x(F f) {
  return [f](auto const& frames, double t) {
    using T = std::decay_t<decltype(frames[0].r[0])>;
    Wrench<T> w;
    w.f[0] = f(frames[0].r[0], frames[0].v[0], t);
    return std::array{w};
  };
}

// The solution of x˙˙ = 6 x² with x(0) = 1, x˙(0) = 2 is x = 1/(1 − t)²: no step reaches t = 1.
TEST(DormandPrince, StopsBeforeABlowUp) {
  Point point(along_x([](auto const& x, auto const&, double) { return 6.0 * x * x; }), 1.0, 2.0);
  auto run = simulate(point.model, point.x, DormandPrince<>{}, {.end_time = 2.0, .step = 0.01});
  EXPECT_THROW(run.run(), MinimumStepReached);
  EXPECT_NEAR(point.x.t, 1.0, 1e-6);
  // the state is the last accepted one: finite, with the first integral x˙² = 4 x³
  double const x = point.x.q[0], v = point.x.v[0];
  EXPECT_GT(x, 1e10);
  EXPECT_NEAR(v * v / (4.0 * x * x * x), 1.0, 1e-3);
}

// A stiff model: stability limits the step, not accuracy. A smallest step above this limit is refused.
TEST(DormandPrince, SaysThatAStiffModelNeedsAnImplicitMethod) {
  auto const stiff = along_x([](auto const& x, auto const& v, double) { return -1e8 * x - 1e5 * v; });
  Point point(stiff, 0.1, 0.0);
  DormandPrince<> const careful{.relative_tolerance = 1e-4, .absolute_tolerance = 1e-6, .min_step = 1e-3};
  auto run = simulate(point.model, point.x, careful, {.end_time = 1.0, .step = 0.01});
  State const before = point.x;
  try {
    run.run();
    FAIL() << "the step was not refused";
  } catch (MinimumStepReached const& error) {
    EXPECT_TRUE(has(error.what(), "implicit integrator"));
  }
  EXPECT_EQ(point.x.q, before.q);
  EXPECT_EQ(point.x.t, before.t);
}

// A force that jumps at t = 0.5. Without a breakpoint the step-size control refuses steps over the jump and still
// reaches the requested accuracy. With a breakpoint the jump costs almost nothing.
TEST(DormandPrince, RefusesStepsOverAJump) {
  auto const jump = along_x([](auto const& x, auto const&, double t) { return -x + (t < 0.5 ? 0.0 : 10.0); });
  // x = cos t, with the additional term 10 − 10 cos(t − ½)
  double const exact = std::cos(1.0) + 10.0 - 10.0 * std::cos(0.5);
  RunReport reports[2];
  for (int announced : {0, 1}) {
    Point point(jump, 1.0, 0.0);
    RunOptions options{.end_time = 1.0, .step = 0.1};
    if (announced) options.breakpoints = {0.5};
    reports[announced] = simulate(point.model, point.x, with_tolerance<NoStabilisation>(1e-8), options).run();
    EXPECT_NEAR(point.x.q[0], exact, 1e-6);
  }
  EXPECT_GE(reports[0].rejected, 3);
  EXPECT_LT(reports[1].rejected, reports[0].rejected);
  EXPECT_LT(reports[1].evaluations, reports[0].evaluations);
}

TEST(DormandPrince, TakesAtMostTheStepItIsGiven) {
  SprungBody body;
  State x = body.start;
  RunOptions options{.end_time = 1.0, .step = 1e-3};
  options.max_step = 0.02;
  auto run = simulate(body.model, x, with_tolerance<NoStabilisation>(1e-2), options);
  double before = 0.0, largest = 0.0;
  for (State const& now : run) {
    largest = std::max(largest, now.t - before);
    before = now.t;
  }
  EXPECT_NEAR(largest, 0.02, 1e-12);
  EXPECT_EQ(x.t, 1.0);
}

TEST(ErrorTolerance, IsAbsoluteAndRelativeTogether) {
  detail::ErrorTolerance const tolerance{1e-3, 1e-2};
  EXPECT_NEAR(tolerance.of_one(0.0, 0.0), 1e-3, 1e-18);
  EXPECT_NEAR(tolerance.of_one(-2.0, 1.0), 1e-3 + 2e-2, 1e-17);
}

TEST(DormandPrince, RefusesTolerancesThatCannotBeMeant) {
  SprungBody body;
  auto const try_with = [&](DormandPrince<> const& integrator) {
    State x = body.start;
    return refusal([&] { simulate(body.model, x, integrator, {.end_time = 1.0, .step = 0.1}); });
  };
  EXPECT_TRUE(has(try_with({.relative_tolerance = 0.0}), "the relative tolerance must be positive"));
  EXPECT_TRUE(has(try_with({.absolute_tolerance = -1.0}), "the absolute tolerance must be positive"));
  EXPECT_TRUE(has(try_with({.min_step = 0.0}), "the smallest step must be positive"));
}

// A start with a constraint violation that is too large for the correction in a step.
TEST(Projection, SaysThatThePositionsCannotBeBroughtBack) {
  SwingingBar bar;
  System system(bar.model);
  RungeKutta4<Projection> const integrator{.stabilisation = {.max_iterations = 1}};
  auto workspace = integrator.workspace<DenseLu>(system);
  State x = bar.start;
  integrator.start(system, x, 0.3, workspace);
  State const before = x;
  EXPECT_THROW(integrator.step(system, x, 0.3, workspace), NewtonConvergenceFailure);
  EXPECT_EQ(x.q, before.q);
  EXPECT_EQ(x.t, before.t);
}

}  // namespace runge_kutta_test
