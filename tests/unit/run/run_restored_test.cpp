// Refusals: steps past the end of a run, clocks with insufficient resolution, snapshots that fail or are damaged.
#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/forces/user_force.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/run/simulate.hpp>

#include "support/refusal.hpp"

using namespace polybody;

namespace run_restored_test {

long made = 0, bad = -1;
auto shaken() {
  return user_force<1>([](auto const& frames, double t) {
    using T = typename std::decay_t<decltype(frames[0].r)>::Scalar;
    if (++made == bad) throw std::runtime_error("a force throws");
    Wrench<T> w;
    w.f << T(3.0 * std::sin(20.0 * t)), T(0.0), T(0.0);
    return std::array{w};
  });
}

struct Pendulum {
  using Pin = Joint<planar::Revolute, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Pin>, Forces<decltype(shaken())>> model{Gravity{0, -9.81, 0}};
  State x;
  Pendulum() {
    auto const a = model.add(planar::Rigid(1, 0.1, Placement::planar(0.5, 0)), "a");
    model.connect(Pin{}, model.ground().at({0, 0, 0}), a.at(Vec2(-0.5, 0)), "pin");
    model.apply(shaken(), a.at(Vec2(0.5, 0)), "shaker");
    x = model.reference_state();
  }
};

template <class I>
void expect_end(I const& integrator) {
  Pendulum p;
  auto run = simulate(p.model, p.x, integrator, {.end_time = 0.1, .step = 0.01});
  run.run();
  State const end = p.x;
  EXPECT_TRUE(has(refusal([&] { run.advance(); }), "advance: the run has ended at t = 0.1 s. Check done() first"));
  EXPECT_EQ(p.x.q, end.q);
  Pendulum still;
  auto none = simulate(still.model, still.x, integrator, {.end_time = 0.0, .step = 0.01});
  EXPECT_TRUE(has(refusal([&] { none.advance(); }), "advance: the run has ended at t = 0 s"));
}
TEST(RunEnd, StepsPastItAreRefused) {
  expect_end(GeneralisedAlpha{});
  expect_end(RungeKutta4<Projection>{});
  expect_end(DormandPrince<Projection>{});
}

TEST(RunClock, StepsBelowItsResolutionAreRefused) {
  auto const run_at = [](double start, double step, double length) {
    Pendulum p;
    p.x.t = start;
    simulate(p.model, p.x, GeneralisedAlpha{}, {.end_time = start + length, .step = step}).run();
    return p.x;
  };
  EXPECT_TRUE(
      has(refusal([&] { run_at(1e15, 0.01, 1.0); }), "simulate: double precision resolves 0.125 s at t = 1e+15 s"));
  EXPECT_TRUE(has(refusal([&] { run_at(1e10, 1e-8, 1e-5); }), "too coarse for steps of 1e-08 s"));
  EXPECT_TRUE(has(refusal([&] { run_at(-1e10, 1e-8, 1e-5); }), "simulate: double precision resolves"));
  State const late = run_at(1e6, 1e-3, 0.1);
  EXPECT_NEAR(late.t, 1e6 + 0.1, 1e-9);
}

template <class I>
void expect_bits_after_failed_snapshot(I const& integrator) {
  RunOptions const options{.end_time = 0.5, .step = 0.01};
  Pendulum reference, p;
  bad = -1;
  simulate(reference.model, reference.x, integrator, options).run();
  auto run = simulate(p.model, p.x, integrator, options);
  for (int i = 0; i < 20; ++i) run.advance();
  bad = made + 1;
  EXPECT_THROW((void)run.snapshot(), std::runtime_error);
  bad = -1;
  run.run();  // bitwise identical to a run without a snapshot
  EXPECT_EQ(p.x.q, reference.x.q);
  EXPECT_EQ(p.x.v, reference.x.v);
}
TEST(RunSnapshot, OneThatFailsLeavesTheBitsOfTheRun) {
  expect_bits_after_failed_snapshot(GeneralisedAlpha{});
  expect_bits_after_failed_snapshot(RungeKutta4<Projection>{});
}

TEST(RunSnapshot, NumbersThatAreNotFiniteAreRefused) {
  Pendulum p;
  RunOptions const options{.end_time = 0.5, .step = 0.01};
  auto run = simulate(p.model, p.x, GeneralisedAlpha{}, options);
  run.advance();
  RunSnapshot const sound = run.snapshot();
  auto const said = [&](auto const& spoil) {
    RunSnapshot damaged = sound;
    spoil(damaged.state);
    Pendulum other;
    State const before = other.x;
    std::string const message =
        refusal([&] { (void)resume(other.model, other.x, GeneralisedAlpha{}, options, damaged); });
    EXPECT_EQ(other.x.q, before.q);
    return message;
  };
  double const nan = std::nan("");
  EXPECT_TRUE(has(said([&](State& x) { x.q[0] = nan; }), "resume: the coordinates of the snapshot"));
  EXPECT_TRUE(has(said([&](State& x) { x.v[1] = nan; }), "resume: the velocities of the snapshot"));
  EXPECT_TRUE(has(said([&](State& x) { x.a[2] = nan; }), "resume: the accelerations of the snapshot"));
  EXPECT_TRUE(has(said([&](State& x) { x.lambda[0] = nan; }), "resume: the multipliers of the snapshot"));
  EXPECT_TRUE(has(said([&](State& x) { x.history[0] = nan; }), "resume: the integrator history of the snapshot"));
}

}  // namespace run_restored_test
