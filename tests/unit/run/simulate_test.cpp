// Properties of a run for its user, with a rigid uniform rod that hangs on a pin (m = 1, L = 1, g = 9.81) and with a
// free rod.
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/forces/user_force.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/system/model.hpp>

#include <gtest/gtest.h>

#include "support/refusal.hpp"

namespace polybody {
namespace simulate_test {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

// Force that is not finite from a given time on.
auto poison(double from) {
  return user_force<1>([from](auto const& frames, double t) {
    using T = typename std::decay_t<decltype(frames[0].r)>::Scalar;
    Wrench<T> w;
    w.f << T(t >= from ? nan : 0.0), T(0.0), T(0.0);
    return std::array{w};
  });
}

using Pin = Joint<planar::Revolute, Constraint>;
using Push = PointForce<Window>;
using TestModel = Model<Bodies<planar::Rigid>, Joints<Pin>, Forces<Push, decltype(poison(0.0))>>;
using Adaptive = DormandPrince<Projection>;

planar::Rigid uniform_rod() {
  return planar::Rigid::from({.length = 1.0, .constants = BarConstants{.EA = 1.0, .EI = 1.0, .mass_per_length = 1.0}});
}

// Pendulum released at rest from the horizontal.
struct Pendulum {
  TestModel model{Gravity{0.0, -9.81, 0.0}};
  BodyHandle<planar::Rigid> rod = model.add(uniform_rod(), "rod");
  ElementHandle<Pin> pin = model.connect(Pin{}, model.ground().at({0, 0, 0}), rod.at(0.0), "pin");
  State x = model.reference_state();

  Vec3 tip(State const& now) const { return position(model, now, rod.at(1.0)); }
  Event crossing(bool stops = false) const {
    return {.name = "vertical", .value = [this](State const& now) { return tip(now)[0]; }, .terminal = stops};
  }
};

// Rod without joints and gravity.
struct FreeRod {
  TestModel model;
  BodyHandle<planar::Rigid> rod = model.add(uniform_rod(), "rod");
  State x = model.reference_state();

  void push(Vec3 const& force, Window const& law) { model.apply(Push{.force = force, .law = law}, rod.at(0.5)); }
};

// A quarter of the period at an amplitude of 90 degrees: K(sin 45°)/ω, ω² = 3g/2L, with the complete elliptic
// integral K. The reactions (J1) are R(release) = mg/4 and R(bottom) = 5mg/2.
double const quarter_period = std::comp_ellint_1(std::sqrt(0.5)) / std::sqrt(1.5 * 9.81);

std::vector<double> times_of(auto&& run) {
  std::vector<double> t;
  for (State const& now : run) t.push_back(now.t);
  return t;
}

void expect_same(State const& a, State const& b) {
  EXPECT_EQ(a.t, b.t);
  EXPECT_EQ(a.q, b.q);
  EXPECT_EQ(a.v, b.v);
  EXPECT_EQ(a.a, b.a);
  EXPECT_EQ(a.lambda, b.lambda);
  EXPECT_EQ(a.history, b.history);
}

// --- the range ------------------------------------------------------------------------------------------------

TEST(Simulate, YieldsTheStartAndTheEndOfEveryStep) {
  Pendulum p;
  std::vector<double> const t = times_of(simulate(p.model, p.x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 0.25}));
  EXPECT_EQ(t, (std::vector{0.0, 0.25, 0.5, 0.75, 1.0}));
  EXPECT_EQ(p.x.t, 1.0);  // the caller's state is updated
  EXPECT_LT(p.tip(p.x)[0], -0.9);
}

TEST(Simulate, AnEndThatIsTheStartTakesNoStep) {
  Pendulum p;
  auto run = simulate(p.model, p.x, GeneralisedAlpha{}, {.end_time = 0.0, .step = 0.1});
  EXPECT_TRUE(run.done());
  EXPECT_EQ(times_of(run), std::vector{0.0});
  EXPECT_EQ(run.report().steps, 0);
}

// Velocities that violate the joint are projected. v̇ and λ are then those of the start: mg/4 at release (J1, closed
// form).
TEST(Simulate, StartsConsistently) {
  Pendulum p;
  p.x.v << 0.3, 0.0, 0.0;  // along the rod, prevented by the pin
  auto run = simulate(p.model, p.x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 0.1});
  EXPECT_LT(p.x.v.norm(), 1e-15);
  EXPECT_LT((p.x.a - Vec3(0.0, -0.75 * 9.81, -1.5 * 9.81)).norm(), 1e-13);
  EXPECT_LT((reaction(p.model, p.x, p.pin).f - Vec3(0.0, 0.25 * 9.81, 0.0)).norm(), 1e-13);
}

// The sum of 30000 steps of a third of a millisecond differs from 10 s by 1e-12. No additional step covers this
// difference.
TEST(Simulate, RoundingOfTheClockCostsNoStep) {
  FreeRod f;
  auto const& report = simulate(f.model, f.x, GeneralisedAlpha{}, {.end_time = 10.0, .step = 1e-3 / 3.0}).run();
  EXPECT_EQ(f.x.t, 10.0);
  EXPECT_EQ(report.steps, 30000);
}

// No object remains for a reference after `auto const& report = simulate(…).run();`.
TEST(Simulate, TheReportOfASimulationThatEndsWithItsStatementIsACopy) {
  FreeRod f;
  RunOptions const options{.end_time = 0.1, .step = 0.01};
  static_assert(!std::is_reference_v<decltype(simulate(f.model, f.x, GeneralisedAlpha{}, options).run())>);
  static_assert(!std::is_reference_v<decltype(simulate(f.model, f.x, GeneralisedAlpha{}, options).report())>);
  auto run = simulate(f.model, f.x, GeneralisedAlpha{}, options);
  EXPECT_EQ(&run.run(), &run.report());
  EXPECT_EQ(run.report().steps, 10);
}

// t = t₀ + k h: the sum of 1000 steps of 0.1 s would have an error of 1.4e-12 s.
TEST(Simulate, TheClockDoesNotAddUpRounding) {
  FreeRod f;
  std::vector<double> const t = times_of(simulate(f.model, f.x, GeneralisedAlpha{}, {.end_time = 100.0, .step = 0.1}));
  ASSERT_EQ(t.size(), 1001u);
  for (std::size_t k = 0; k < t.size(); ++k) EXPECT_EQ(t[k], double(k) * 0.1);
}
TEST(Simulate, TheClockCountsAnewFromAnEvent) {
  FreeRod f;
  f.x.t = -1.0 / 3.0;
  Event const event{.name = "early", .value = [](State const& x) { return x.t - 0.06; }};
  auto run = simulate(f.model, f.x, GeneralisedAlpha{}, {.end_time = 50.0, .step = 0.1, .events = {event}});
  std::vector<double> const t = times_of(run);
  ASSERT_EQ(run.report().events.size(), 1u);
  double const met = run.report().events[0].time;
  std::size_t const at = std::size_t(std::find(t.begin(), t.end(), met) - t.begin());
  ASSERT_EQ(at, 4u);
  for (std::size_t k = 0; k < at; ++k) EXPECT_EQ(t[k], -1.0 / 3.0 + double(k) * 0.1);
  for (std::size_t k = at; k + 1 < t.size(); ++k) EXPECT_EQ(t[k], met + double(k - at) * 0.1);
}
TEST(Simulate, AResumedRunKeepsTheClock) {
  FreeRod full, parted;
  RunOptions const options{.end_time = 20.0, .step = 0.1};
  std::vector<double> const t = times_of(simulate(full.model, full.x, GeneralisedAlpha{}, options));
  auto first = simulate(parted.model, parted.x, GeneralisedAlpha{}, options);
  for (int k = 0; k < 77; ++k) first.advance();
  State x;
  std::vector<double> const rest = times_of(resume(parted.model, x, GeneralisedAlpha{}, options, first.snapshot()));
  EXPECT_EQ(rest, std::vector<double>(t.begin() + 77, t.end()));
}

// 0.77 − 0.76 is not 0.01. A last step of that length would change the results compared with an uninterrupted run.
TEST(Simulate, ARunThatGoesOnLaterHasTheBitsOfOneThatWentThrough) {
  Pendulum full, parted;
  auto through = simulate(full.model, full.x, GeneralisedAlpha{}, {.end_time = 2.0, .step = 0.01});
  for (int k = 0; k < 77; ++k) through.advance();
  (void)through.snapshot();
  through.run();
  auto first = simulate(parted.model, parted.x, GeneralisedAlpha{}, {.end_time = 0.77, .step = 0.01});
  first.run();
  State x;
  resume(parted.model, x, GeneralisedAlpha{}, {.end_time = 2.0, .step = 0.01}, first.snapshot()).run();
  expect_same(x, full.x);
}

// In a very short remainder step h the constraint equations would determine accelerations and reactions from
// round-off divided by h².
TEST(Simulate, LeavesNoCrumbAtTheEnd) {
  double const step = (1.0 - 1e-7) / 1000.0;
  Pendulum p;
  std::vector<double> const t = times_of(simulate(p.model, p.x, GeneralisedAlpha{}, {.end_time = 1.0, .step = step}));
  EXPECT_EQ(t.back(), 1.0);
  for (std::size_t i = 1; i < t.size(); ++i) EXPECT_NEAR(t[i] - t[i - 1], step, 0.011 * step);
  // t = 1: R = (0.1804260137, 2.4539749449) (J1, independent computation); measured 9.4e-5, the method's own error of
  // second order
  EXPECT_LT((reaction(p.model, p.x, p.pin).f - Vec3(0.1804260137, 2.4539749449, 0.0)).norm(), 3e-4);
}

// --- breakpoints ----------------------------------------------------------------------------------------------

// Steps end exactly at the breakpoints of loads and of the user.
TEST(Simulate, HitsEveryCornerExactly) {
  FreeRod f;
  f.push({8.0, 0.0, 0.0}, {.from = 0.05, .to = 0.35});
  std::vector<double> const t = times_of(simulate(
      f.model, f.x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 0.1, .breakpoints = {0.777, -1.0, 0.35, 5.0}}));
  for (double const corner : {0.05, 0.35, 0.777, 1.0}) EXPECT_EQ(std::count(t.begin(), t.end(), corner), 1) << corner;
  EXPECT_EQ(t.size(), 13u);  // 0, .05 | .15, .25, .35 | .45, .55, .65, .75, .777 | .877, .977, 1
}

// A force over 0.05 ≤ t < 0.35 gives the momentum 8 · 0.3 and the distance 8 · 0.3²/2 + 2.4 · 0.65, exactly (closed
// form).
template <class I>
void expect_exact_impulse(I const& integrator) {
  FreeRod f;
  f.push({8.0, 0.0, 0.0}, {.from = 0.05, .to = 0.35});
  simulate(f.model, f.x, integrator, {.end_time = 1.0, .step = 0.1}).run();
  EXPECT_NEAR(f.x.v[0], 2.4, 1e-14);
  EXPECT_NEAR(f.x.q[0] - 0.5, 0.36 + 2.4 * 0.65, 1e-14);
}
TEST(Simulate, GivesTheImpulseOfALoadThatJumps) { expect_exact_impulse(GeneralisedAlpha{}); }
TEST(Simulate, GivesTheImpulseOfALoadThatJumpsToAnExplicitMethod) { expect_exact_impulse(Adaptive{}); }

// 0.3 and 0.1 + 0.2 differ in the last bit. There is no step between them, nor between a breakpoint and the end.
TEST(Simulate, CornersThatOnlyRoundingSetsApartAreOne) {
  for (double const end_time : {0.3, 0.1 + 0.2, 0.4}) {
    FreeRod f;
    f.push({8.0, 0.0, 0.0}, {.from = 0.0, .to = 0.3});
    f.push({0.0, 3.0, 0.0}, {.from = 0.0, .to = 0.1 + 0.2});
    auto run = simulate(f.model, f.x, GeneralisedAlpha{}, {.end_time = end_time, .step = 0.1});
    run.run();
    EXPECT_EQ(f.x.t, end_time);
    EXPECT_EQ(run.report().steps, std::lround(end_time / 0.1));
    EXPECT_LT((f.x.v - Vec3(2.4, 0.9, 0.0)).norm(), 1e-14) << end_time;
  }
}

TEST(Simulate, ACornerThatIsTheStartUpToRoundingIsLeftBehind) {
  FreeRod f;
  f.x.t = 0.3;
  f.push({8.0, 0.0, 0.0}, {.from = 0.1 + 0.2, .to = 1.0});
  simulate(f.model, f.x, GeneralisedAlpha{}, {.end_time = 0.8, .step = 0.1}).run();
  EXPECT_NEAR(f.x.v[0], 4.0, 1e-14);
}

// --- events ---------------------------------------------------------------------------------------------------

double time_of_first_crossing(auto const& integrator, double step) {
  Pendulum p;
  auto run = simulate(p.model, p.x, integrator, {.end_time = 2.0, .step = step, .events = {p.crossing(true)}});
  run.run();
  EXPECT_TRUE(run.report().stopped);
  EXPECT_EQ(run.report().events.size(), 1u);
  EXPECT_EQ(run.report().events[0].time, p.x.t);
  EXPECT_LT(std::abs(p.tip(p.x)[0]), 1e-9);  // speed 5.4 m/s, tolerance 1e-10 s
  EXPECT_LT((reaction(p.model, p.x, p.pin).f - Vec3(0.0, 2.5 * 9.81, 0.0)).norm(), 1e-2);  // 5mg/2 (J1, closed form)
  return p.x.t;
}

// The pendulum passes the vertical after a quarter of the period.
TEST(Simulate, EndsTheStepWhereAnEventHappens) {
  EXPECT_NEAR(time_of_first_crossing(Adaptive{}, 1e-2), quarter_period, 1e-9);
  double const coarse = time_of_first_crossing(GeneralisedAlpha{.rho_inf = 1.0}, 4e-3) - quarter_period;
  double const fine = time_of_first_crossing(GeneralisedAlpha{.rho_inf = 1.0}, 2e-3) - quarter_period;
  EXPECT_LT(std::abs(fine), 1e-5);       // measured 6.5e-6
  EXPECT_NEAR(coarse / fine, 4.0, 0.2);  // the remaining error is that of the method, of second order
}

// It passes the vertical at every odd quarter. The run continues after each event.
TEST(Simulate, MeetsAnEventAsOftenAsItHappens) {
  Pendulum p;
  auto run = simulate(p.model, p.x, Adaptive{}, {.end_time = 10.0, .step = 1e-2, .events = {p.crossing()}});
  run.run();
  EXPECT_EQ(p.x.t, 10.0);
  EXPECT_FALSE(run.report().stopped);
  auto const& met = run.report().events;
  ASSERT_EQ(met.size(), std::size_t((10.0 / quarter_period + 1.0) / 2.0));
  for (std::size_t i = 0; i < met.size(); ++i) {
    EXPECT_EQ(met[i].name, "vertical");
    EXPECT_NEAR(met[i].time, double(2 * i + 1) * quarter_period, 1e-7);
  }
}

// The time of an event function of time alone is found to the event's tolerance, for any order of the events.
TEST(Simulate, FindsTheFirstOfSeveralEventsInAStep) {
  auto const at = [](char const* name, double time, bool stops = false) {
    return Event{.name = name, .value = [time](State const& x) { return x.t - time; }, .terminal = stops};
  };
  Pendulum p;
  auto run = simulate(p.model, p.x, GeneralisedAlpha{},
                      {.end_time = 1.0,
                       .step = 0.1,
                       .events = {at("third", 0.77, true), at("second", 0.28), at("first", 0.22), at("never", 0.8)}});
  run.run();
  auto const& met = run.report().events;
  ASSERT_EQ(met.size(), 3u);
  EXPECT_EQ(met[0].name + met[1].name + met[2].name, "firstsecondthird");
  EXPECT_NEAR(met[0].time, 0.22, 1e-10);
  EXPECT_NEAR(met[1].time, 0.28, 1e-10);
  EXPECT_NEAR(met[2].time, 0.77, 1e-10);
  EXPECT_EQ(p.x.t, met[2].time);
  EXPECT_TRUE(run.done());
}

TEST(Simulate, MeetsEventsThatHappenTogether) {
  Pendulum p;
  Event other = p.crossing(true);
  other.name = "the same";
  auto run =
      simulate(p.model, p.x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 0.01, .events = {p.crossing(), other}});
  run.run();
  ASSERT_EQ(run.report().events.size(), 2u);
  EXPECT_EQ(run.report().events[0].time, run.report().events[1].time);
  EXPECT_TRUE(run.report().stopped);  // one of them is terminal
}

// Event at the breakpoint, shortly before it, and shortly after it.
TEST(Simulate, AnEventMayFallOnACorner) {
  for (double const shift : {0.0, -3e-10, 3e-10}) {
    FreeRod f;
    f.push({8.0, 0.0, 0.0}, {.from = 0.05, .to = 0.35});
    Event const event{.name = "at the corner", .value = [=](State const& x) { return x.t - 0.35 - shift; }};
    auto run = simulate(f.model, f.x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 0.1, .events = {event}});
    std::vector<double> const t = times_of(run);
    EXPECT_EQ(std::count(t.begin(), t.end(), 0.35), 1) << shift;
    ASSERT_EQ(run.report().events.size(), 1u) << shift;
    EXPECT_NEAR(run.report().events[0].time, 0.35 + shift, 1.1e-10);
    EXPECT_NEAR(f.x.v[0], 2.4, 1e-13) << shift;
  }
}

// An event shortly after the start of a step, or before its end, leaves a very short remainder step. The reactions
// remain accurate. R = (0.1804260137, 2.4539749449) at t = 1 (J1, independent computation).
TEST(Simulate, AnEventNextToAStepEndDoesNoHarm) {
  for (double const time : {0.5 + 2e-9, 1.0 - 2e-9}) {
    Pendulum p;
    Event const event{.name = "next to it", .value = [=](State const& x) { return x.t - time; }};
    auto run = simulate(p.model, p.x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 1e-3, .events = {event}});
    double largest = 0.0;
    for (State const& now : run) {
      largest = std::max(largest, reaction(p.model, now, p.pin).f.norm());
      ASSERT_LT(largest_violation(run.system(), now).velocity,
                2e-5);  // error of the method; 8e-6 measured, of second order
    }
    EXPECT_EQ(run.report().events.size(), 1u);
    EXPECT_LT(largest, 2.5 * 9.81 + 0.01);  // the maximum is at the bottom
    EXPECT_LT((reaction(p.model, p.x, p.pin).f - Vec3(0.1804260137, 2.4539749449, 0.0)).norm(), 3e-4);
  }
}

TEST(Simulate, RefusesAnEventThatIsNotANumber) {
  Pendulum p;
  Event const event{.name = "root", .value = [](State const& x) { return std::sqrt(0.5 - x.t); }};
  auto run = simulate(p.model, p.x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 0.1, .events = {event}});
  try {
    run.run();
    FAIL() << "a NaN was taken for an event";
  } catch (NonFiniteValue const& e) {
    EXPECT_TRUE(has(e.what(), "\"root\""));
  }
  EXPECT_LE(p.x.t, 0.5 + 1e-15);
}

// --- failures -------------------------------------------------------------------------------------------------

// Runs until it throws E. The state must be that of the last accepted step.
template <class E>
std::string failure(Pendulum& p, auto const& integrator, RunOptions const& options, double latest) {
  auto run = simulate(p.model, p.x, integrator, options);
  State last = p.x;
  std::string message;
  try {
    while (!run.done()) {
      run.advance();
      last = p.x;
    }
    ADD_FAILURE() << "the run went through";
  } catch (E const& e) {
    message = e.what();
  }
  EXPECT_GT(last.t, 0.0);
  EXPECT_LE(last.t, latest);
  expect_same(p.x, last);
  return message;
}

TEST(Simulate, AFailingStepLeavesTheStateUntouched) {
  Pendulum p;
  p.model.apply(poison(0.45), p.rod.at(1.0), "poison");
  RunOptions const options{.end_time = 1.0, .step = 0.1};
  std::string const message = failure<NonFiniteValue>(p, GeneralisedAlpha{}, options, 0.45);
  EXPECT_TRUE(has(message, "\"rod\""));
  EXPECT_TRUE(has(message, "0.5"));
}
TEST(Simulate, AFailingStepOfAnExplicitMethodLeavesTheStateUntouched) {
  Pendulum p;
  p.model.apply(poison(0.45), p.rod.at(1.0), "poison");
  EXPECT_TRUE(has(failure<NonFiniteValue>(p, Adaptive{}, {.end_time = 1.0, .step = 0.1}, 0.45), "\"rod\""));
}

// The step to the breakpoint succeeds, but no step can start from there.
TEST(Simulate, AFailureAtACornerLeavesTheStateUntouched) {
  Pendulum p;
  p.model.apply(poison(0.45), p.rod.at(1.0), "poison");
  RunOptions const options{.end_time = 1.0, .step = 0.1, .breakpoints = {0.45}};
  EXPECT_TRUE(has(failure<NonFiniteValue>(p, GeneralisedAlpha{}, options, 0.4 + 1e-15), "0.45"));
}

TEST(Simulate, AFailureAtAnEventLeavesTheStateUntouched) {
  Pendulum p;
  Event const event{.name = "throws", .value = [](State const& x) {
                      if (x.t > 0.42) throw NonFiniteValue("the user's own");
                      return -1.0;
                    }};
  RunOptions const options{.end_time = 1.0, .step = 0.1, .events = {event}};
  EXPECT_EQ(failure<NonFiniteValue>(p, GeneralisedAlpha{}, options, 0.42), "the user's own");
}

TEST(Simulate, NothingIsAcceptedUnconverged) {
  Pendulum p;
  GeneralisedAlpha impatient{.rho_inf = 0.8};
  auto run = simulate(p.model, p.x, impatient, {.end_time = 0.1, .step = 0.05});
  run.run();
  State const before = p.x;
  impatient.newton.max_iterations = 1;
  auto hasty = simulate(p.model, p.x, impatient, {.end_time = 1.0, .step = 0.3, .max_step_halvings = 0});
  State const start = p.x;
  EXPECT_THROW(hasty.advance(), NewtonConvergenceFailure);
  expect_same(p.x, start);
  EXPECT_EQ(p.x.q, before.q);
}

TEST(Simulate, AFailingStartLeavesTheStateUntouched) {
  Pendulum p;
  p.x.v << 0.3, 0.0, 0.0;  // would be projected otherwise
  p.model.apply(poison(0.0), p.rod.at(1.0), "poison");
  State const before = p.x;
  EXPECT_THROW((void)simulate(p.model, p.x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 0.1}), NonFiniteValue);
  expect_same(p.x, before);
}

// --- options --------------------------------------------------------------------------------------------------

TEST(Simulate, BadOptionsAreRefusedAndTheStateStays) {
  Pendulum p;
  p.x.t = 0.5;
  State const before = p.x;
  auto const told = [&](RunOptions const& options, GeneralisedAlpha const& method = {}) {
    std::string const message = refusal([&] { (void)simulate(p.model, p.x, method, options); });
    expect_same(p.x, before);
    return message;
  };
  for (double const step : {0.0, -0.1, nan, infinity}) EXPECT_TRUE(has(told({.end_time = 1.0, .step = step}), "step"));
  for (double const end_time : {0.4, nan, infinity, -infinity})
    EXPECT_TRUE(has(told({.end_time = end_time, .step = 0.1}), "end")) << end_time;
  EXPECT_TRUE(has(told({.end_time = 1.0, .step = 0.1, .max_step = 0.0}), "largest step"));
  Event const silent{.name = "silent", .value = {}};
  EXPECT_TRUE(has(told({.end_time = 1.0, .step = 0.1, .events = {silent}}), "\"silent\""));
  Event sharp = p.crossing();
  sharp.tolerance = 0.0;
  EXPECT_TRUE(has(told({.end_time = 1.0, .step = 0.1, .events = {sharp}}), "tolerance"));
  EXPECT_TRUE(has(told({.end_time = 1.0, .step = 0.1}, {.rho_inf = 1.1}), "rho_inf"));
}

TEST(Simulate, AStateOfAnotherSizeIsRefused) {
  Pendulum p;
  FreeRod f;
  RunOptions const options{.end_time = 1.0, .step = 0.1};
  auto const told = [&](State x) { return refusal([&] { (void)simulate(p.model, x, GeneralisedAlpha{}, options); }); };
  EXPECT_TRUE(has(told(f.x), "does not fit"));  // without multipliers
  EXPECT_TRUE(has(told(State{}), "does not fit"));
  State early = p.x;
  p.model.add(uniform_rod(), "a later one");
  EXPECT_TRUE(has(told(early), "does not fit"));
}

TEST(Simulate, AStateThatIsNotFiniteIsRefused) {
  Pendulum p;
  p.x.q[1] = nan;
  EXPECT_TRUE(has(refusal([&] { (void)simulate(p.model, p.x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 0.1}); }),
                  "coordinates"));
}

TEST(Simulate, AnOpenJointIsRefusedByName) {
  Pendulum p;
  p.x.q[0] += 1e-3;
  try {
    (void)simulate(p.model, p.x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 0.1});
    FAIL() << "an open joint was accepted";
  } catch (InconsistentInitialConditions const& e) {
    EXPECT_TRUE(has(e.what(), "\"pin\""));
  }
  EXPECT_NO_THROW(
      (void)simulate(p.model, p.x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 0.1, .assembly_tolerance = 2e-3}));
}

TEST(Simulate, StepControlKeepsToTheLargestStep) {
  Pendulum free, held;
  auto const longest = [](Pendulum& p, std::optional<double> largest) {
    std::vector<double> const t =
        times_of(simulate(p.model, p.x, Adaptive{.relative_tolerance = 1e-5, .absolute_tolerance = 1e-5},
                          {.end_time = 2.0, .step = 0.02, .max_step = largest}));
    double h = 0.0;
    for (std::size_t i = 1; i < t.size(); ++i) h = std::max(h, t[i] - t[i - 1]);
    return h;
  };
  EXPECT_GT(longest(free, {}), 0.03);
  EXPECT_LT(longest(held, 0.01), 0.0102);  // the last step may be longer by a hundredth
}

}  // namespace simulate_test
}  // namespace polybody
