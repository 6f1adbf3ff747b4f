#include <polybody/integrators/adams_bashforth_moulton.hpp>

#include <gtest/gtest.h>

#include <polybody/forces/user_force.hpp>
#include <polybody/integrators/coordinate_partitioning.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"
#include "support/integrator_cases.hpp"
#include "support/refusal.hpp"

using namespace polybody;

namespace adams_bashforth_moulton_test {

template <class Stabilisation = UnconstrainedOnly>
AdamsBashforthMoulton<Stabilisation> with_tolerance(double tolerance) {
  return {.relative_tolerance = tolerance, .absolute_tolerance = tolerance};
}

/// A point of mass 1 on the x axis under the force law(x, v, t).
template <class Law>
struct AdamsPoint {
  using Force = UserForce<1, Law>;
  Model<Bodies<planar::Rigid>, Joints<>, Forces<Force>> model;
  State x;

  AdamsPoint(Law law, double x0, double v0) {
    auto const point = model.add(planar::Rigid(1.0, 1.0, Placement::planar(x0, 0.0)), "point");
    model.apply(user_force<1>(law), point.at(Vec2(0, 0)), "law");
    x = model.reference_state();
    model.set_velocity(x, point, Vec3(v0, 0, 0), Vec3::Zero());
  }
};
template <class F>
auto force_along_x(F f) {
  return [f](auto const& frames, double t) {
    using T = std::decay_t<decltype(frames[0].r[0])>;
    Wrench<T> w;
    w.f[0] = f(frames[0].r[0], frames[0].v[0], t);
    return std::array{w};
  };
}
/// x¨ = −x.
constexpr auto spring = [](auto const& x, auto const&, double) { return -x; };

/// Largest error of the angle of the exact pendulum over every step of 2 s, and the report of the run.
template <class I>
std::pair<double, RunReport> pendulum(I const& integrator) {
  SwingingBar bar;
  State x = bar.start;
  double worst = 0.0;
  auto run = simulate(bar.model, x, integrator, {.end_time = 2.0, .step = 0.01});
  for (State const& now : run)
    worst = std::max(worst, std::abs(now.q[2] + 0.5 * std::numbers::pi - bar.exact(bar.phase + now.t).angle));
  return {worst, run.report()};
}

// The bound holds at every step, not only at the end.
TEST(AdamsBashforthMoulton, ErrorOfAPendulumIsProportionalToTheTolerance) {
  std::vector<double> errors;
  for (double const tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
    auto const partitioned = pendulum(with_tolerance<CoordinatePartitioning>(tolerance)).first;
    auto const projected = pendulum(with_tolerance<Projection>(tolerance)).first;
    auto const claim = [](char const* rows) {
      return Claim{"R1", "angle of the swinging bar over 2 s [rad]", By::closed_form, "elliptic functions",
                   std::string("Adams–Bashforth–Moulton, ") + rows};
    };
    held_within(claim("CoordinatePartitioning"), partitioned, 100.0 * tolerance, {equals("tolerance", tolerance), 1.0});
    held_within(claim("Projection"), projected, 100.0 * tolerance, {equals("tolerance", tolerance), 1.0});
    errors.push_back(partitioned);
  }
  EXPECT_NEAR(std::log10(errors.front() / errors.back()), 6.0, 1.5) << testing::PrintToString(errors);
  for (std::size_t i = 1; i < errors.size(); ++i)
    EXPECT_GT(std::log10(errors[i - 1] / errors[i]), 1.0) << testing::PrintToString(errors);
}

// x of the centre of mass of a slow asymmetric top (R6b, independent solution by DOP853): a rotating body with
// constraint equations.
TEST(AdamsBashforthMoulton, FollowsATop) {
  SlowTop top;
  State x = top.start;
  struct {
    double t;
    Vec3 at;
  } const exact[] = {{0.25, {0.0906153700, 0.2910247004, -0.2170103188}},
                     {0.5, {-0.2364177304, -0.2668963764, -0.1134591602}},
                     {1.0, {0.3294674415, -0.1755435591, -0.0252123748}}};
  for (auto const& e : exact) {
    simulate(top.model, x, with_tolerance<CoordinatePartitioning>(1e-11), {.end_time = e.t, .step = 1e-3}).run();
    held_within({"R6", "centre of the slow top [m]", By::independent, "ordinary solver of order eight",
                 "Rigid, Adams–Bashforth–Moulton, CoordinatePartitioning"},
                (x.q.head<3>() - e.at).norm(), 1e-8, {equals("t", e.t), e.at.norm()});
  }
}

// Torque-free rigid body (R7, Dzhanibekov): the rotation about the intermediate axis flips. There are no constraint
// equations and no forces.
TEST(AdamsBashforthMoulton, FollowsATorqueFreeBody) {
  Model<Bodies<Rigid<>>, Joints<>> model;
  auto const body = model.add(Rigid<>(1.0, Vec3(1, 2, 3).asDiagonal().toDenseMatrix()), "body");
  State x = model.reference_state();
  model.set_velocity(x, body, Vec3::Zero(), Vec3(0.01, 5, 0.01));
  struct {
    double t;
    Vec3 omega;
  } const exact[] = {{0.5, {-0.0122755034, 4.9999949312, 0.0108118451}},
                     {1.0, {-0.0648826095, 4.9995890078, 0.0383395054}},
                     {2.0, {-1.1612500596, 4.8632908919, 0.6704977507}},
                     {3.0, {-3.8681418083, -3.1682138423, 2.2332876400}}};
  for (auto const& e : exact) {
    simulate(model, x, with_tolerance(1e-12), {.end_time = e.t, .step = 1e-3}).run();
    held_within({"R7", "angular velocity of the torque-free body [rad/s]", By::independent,
                 "ordinary solver of order eight", "Rigid, Adams–Bashforth–Moulton"},
                (x.v.tail<3>() - e.omega).norm(), 1e-8, {equals("t", e.t), 5.0});
    EXPECT_NEAR(x.q.tail<4>().norm(), 1.0, 1e-15);
    if (e.t == 1.0) {
      Vec<double, 4> const q(-0.8011321124, 0.0017634284, 0.5984399441, 0.0073390884);
      held_within({"R7", "quaternion of the torque-free body at 1 s", By::independent, "ordinary solver of order eight",
                   "Rigid, Adams–Bashforth–Moulton"},
                  std::min((x.q.tail<4>() - q).norm(), (x.q.tail<4>() + q).norm()), 1e-9, {.scale = 1.0});
    }
  }
}

// Fixed order k with fixed steps: local extrapolation raises the order to k + 1. The first step, of order one, has an
// error of at most h³.
TEST(AdamsBashforthMoulton, HasTheOrderAboveThatOfItsPredictor) {
  for (int const k : {1, 2}) {
    double error[2];
    for (int const refined : {0, 1}) {
      AdamsPoint point(force_along_x(spring), 1.0, 0.0);
      AdamsBashforthMoulton<> const integrator{.relative_tolerance = 1e6, .absolute_tolerance = 1e6, .max_order = k};
      System system(point.model);
      auto workspace = integrator.workspace<DenseLu>(system);
      int const steps = refined ? 200 : 100;
      integrator.start(system, point.x, 1.0 / steps, workspace);
      for (int i = 0; i < steps; ++i)
        EXPECT_EQ(integrator.step(system, point.x, 1.0 / steps, workspace).taken, 1.0 / steps);
      error[refined] = std::abs(point.x.q[0] - std::cos(1.0)) + std::abs(point.x.v[0] + std::sin(1.0));
    }
    EXPECT_NEAR(std::log2(error[0] / error[1]), k + 1, 0.1) << k;
  }
}

// The order rises from one and does not exceed the allowed order.
TEST(AdamsBashforthMoulton, RaisesItsOrderFromOne) {
  for (int const most : {12, 4}) {
    AdamsPoint point(force_along_x(spring), 1.0, 0.0);
    AdamsBashforthMoulton<> integrator = with_tolerance(1e-12);
    integrator.max_order = most;
    auto run = simulate(point.model, point.x, integrator, {.end_time = 20.0, .step = 1e-3});
    int highest = 0, first = 0;
    while (!run.done()) {
      run.advance();
      if (first == 0) first = run.report().last.order;
      highest = std::max(highest, run.report().last.order);
    }
    EXPECT_EQ(first, 1);
    EXPECT_GE(highest, std::min(most, 8));
    EXPECT_LE(highest, most);
    held({"closed forms", "place of an oscillator at 20 s", By::closed_form, "cos t", "Adams–Bashforth–Moulton"},
         point.x.q[0], std::cos(20.0), 1e-9, {equals("highest order", most)});
  }
}

// At a tight tolerance the method evaluates the forces less often than Dormand–Prince.
TEST(AdamsBashforthMoulton, NeedsFewerEvaluationsThanDormandPrince) {
  DormandPrince<Projection> const one_step{.relative_tolerance = 1e-11, .absolute_tolerance = 1e-11};
  auto const [error, adams] = pendulum(with_tolerance<Projection>(1e-11));
  auto const [other, pair] = pendulum(one_step);
  EXPECT_LT(2 * adams.evaluations, pair.evaluations);
  EXPECT_LT(error, 1e-9);
  EXPECT_LT(other, 1e-9);
}

// The solution of x˙˙ = 6 x² with x(0) = 1, x˙(0) = 2 is x = 1/(1 − t)²: no step reaches t = 1.
TEST(AdamsBashforthMoulton, StopsBeforeABlowUp) {
  AdamsPoint point(force_along_x([](auto const& x, auto const&, double) { return 6.0 * x * x; }), 1.0, 2.0);
  auto run = simulate(point.model, point.x, AdamsBashforthMoulton<>{}, {.end_time = 2.0, .step = 0.01});
  std::string const message = message_of<MinimumStepReached>([&] { run.run(); });
  EXPECT_TRUE(has(message, "AdamsBashforthMoulton"));
  held({"closed forms", "time at which a solution blows up", By::closed_form, "x = 1/(1 − t)²",
        "Adams–Bashforth–Moulton"},
       point.x.t, 1.0, 1e-6);
  EXPECT_TRUE(point.x.q.allFinite());
}

// x¨ = −x, with an additional force of 10 from t = ½: x = cos t + 10 − 10 cos(t − ½).
TEST(AdamsBashforthMoulton, RefusesStepsOverAJump) {
  auto const jump = force_along_x([](auto const& x, auto const&, double t) { return -x + (t < 0.5 ? 0.0 : 10.0); });
  double const exact = std::cos(1.0) + 10.0 - 10.0 * std::cos(0.5);
  RunReport reports[2];
  for (int announced : {0, 1}) {
    AdamsPoint point(jump, 1.0, 0.0);
    RunOptions options{.end_time = 1.0, .step = 0.1};
    if (announced) options.breakpoints = {0.5};
    reports[announced] = simulate(point.model, point.x, with_tolerance(1e-8), options).run();
    held({"closed forms", "place of an oscillator after a jump of its force", By::closed_form,
          "cos t + 10 − 10 cos(t − ½)",
          announced ? "Adams–Bashforth–Moulton, jump announced" : "Adams–Bashforth–Moulton"},
         point.x.q[0], exact, 1e-6);
  }
  EXPECT_GE(reports[0].rejected, 3);
  EXPECT_LT(reports[1].evaluations, reports[0].evaluations);
}

// x = cos t passes through zero at π/2. The state contains the history, so trial steps from the same state are
// repeatable.
TEST(AdamsBashforthMoulton, FindsEvents) {
  AdamsPoint point(force_along_x(spring), 1.0, 0.0);
  Event const zero{.name = "zero", .value = [](State const& x) { return x.q[0]; }, .terminal = true};
  auto run = simulate(point.model, point.x, with_tolerance(1e-11), {.end_time = 3.0, .step = 0.01, .events = {zero}});
  run.run();
  held({"closed forms", "time at which an oscillator passes zero", By::closed_form, "π/2", "Adams–Bashforth–Moulton"},
       point.x.t, 0.5 * std::numbers::pi, 1e-9);
}

TEST(AdamsBashforthMoulton, FailedStepLeavesTheStateAsItWas) {
  SlowTop top;
  System system(top.model);
  auto const integrator = with_tolerance<Projection>(1e-8);
  auto workspace = integrator.workspace<DenseLu>(system);
  State x = top.start;
  integrator.start(system, x, 1e-3, workspace);
  for (int i = 0; i < 20; ++i) integrator.step(system, x, 1e-3, workspace);
  State const sound = x;
  x.v.setConstant(1e200);
  State const before = x;
  EXPECT_THROW(integrator.step(system, x, 1e-3, workspace), Error);
  EXPECT_EQ(x.q, before.q);
  EXPECT_EQ(x.v, before.v);
  EXPECT_EQ(x.a, before.a);
  EXPECT_EQ(x.lambda, before.lambda);
  EXPECT_EQ(x.history, before.history);
  EXPECT_EQ(x.t, before.t);
  x = sound;
  State again = sound;
  integrator.step(system, x, 1e-3, workspace);
  integrator.step(system, again, 1e-3, workspace);
  EXPECT_EQ(x.q, again.q);
  EXPECT_EQ(x.history, again.history);
  // constraint violation after a step
  Violation const open = largest_violation(system, x);
  EXPECT_LT(open.position, 1e-11);
  EXPECT_LT(open.velocity, 1e-11);
  EXPECT_LT(open.acceleration, 1e-9);
}

TEST(AdamsBashforthMoulton, RefusesOptionsThatCannotBeMeant) {
  SprungBody body;
  auto const told = [&](AdamsBashforthMoulton<> const& integrator) {
    State x = body.start;
    return refusal([&] { simulate(body.model, x, integrator, {.end_time = 1.0, .step = 0.1}); });
  };
  EXPECT_TRUE(has(told({.relative_tolerance = 0.0}), "the relative tolerance must be positive"));
  EXPECT_TRUE(has(told({.absolute_tolerance = -1.0}), "the absolute tolerance must be positive"));
  EXPECT_TRUE(has(told({.min_step = 0.0}), "the smallest step must be positive"));
  EXPECT_TRUE(has(told({.max_order = 13}), "max_order must lie in [1, 12], but is 13"));
  State x = body.start;
  System system(body.model);
  AdamsBashforthMoulton<> const integrator;
  auto workspace = integrator.workspace<DenseLu>(system);
  EXPECT_TRUE(has(refusal([&] { integrator.step(system, x, 0.1, workspace); }), "The state has no integrator history"));
}

// f = t³ on an uneven grid: the divided differences are those of a cubic, and Σ c_j D_j is its integral.
TEST(AdamsHistory, IntegratesACubicExactly) {
  VecX memory, f(1);
  double t = 0.0;
  f[0] = 0.0;
  AdamsHistory::reset(memory, f);
  AdamsHistory history(memory, 1);
  for (double const h : {0.3, 0.1, 0.5, 0.2, 0.4}) {
    t += h;
    f[0] = t * t * t;
    history.push(h, f);
  }
  EXPECT_EQ(history.known(), 6.0);
  EXPECT_NEAR(history.difference(3)[0], 1.0, 1e-13);  // the leading coefficient
  EXPECT_NEAR(history.difference(4)[0], 0.0, 1e-12);
  double const h = 0.7;
  auto const c = AdamsHistory::weights(h, history.ages());
  double integral = 0.0;
  for (int j = 0; j < 4; ++j) integral += c[std::size_t(j)] * history.difference(j)[0];
  EXPECT_NEAR(integral, 0.25 * (std::pow(t + h, 4) - std::pow(t, 4)), 1e-13);
}

}  // namespace adams_bashforth_moulton_test
