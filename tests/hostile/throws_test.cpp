// An exception from a callback leaves the state and the report of the last step unchanged; the step can be repeated.
#include <gtest/gtest.h>

#include <cstdlib>
#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/polybody.hpp>

namespace polybody {
namespace throws_test {

/// Counts the calls of all callbacks; one of them throws.
struct Calls {
  long made = 0, bad = -1;
  void operator()() {
    if (++made == bad) throw std::runtime_error("a callback throws");
  }
};
Calls calls;

struct Law {
  Motion operator()(double t) const {
    calls();
    return {0.3 * std::sin(8.0 * t), 2.4 * std::cos(8.0 * t), -19.2 * std::sin(8.0 * t)};
  }
  std::vector<double> breakpoints() const { return {0.1, 0.21}; }
};
auto user_push() {
  return user_force<1>([](auto const& frames, double t) {
    using T = typename std::decay_t<decltype(frames[0].r)>::Scalar;
    calls();
    Wrench<T> w;
    w.f << T(10.0 * std::sin(50.0 * t)), T(3.0), T(0.0);
    return std::array{w};
  });
}

template <class Policy>
struct Crank {
  using Pin = Joint<planar::Revolute, Policy>;
  using Drive = Joint<PrescribedAngle<Law>, Constraint>;
  using Push = decltype(user_push());
  using M = Model<Bodies<planar::Rigid>, Joints<Pin, Drive>, Forces<Push>>;
  static M make() {
    M m{Gravity{0, -9.81, 0}};
    auto const a = m.add(planar::Rigid(1, 0.1, Placement::planar(0.5, 0)), "a"),
               b = m.add(planar::Rigid(1, 0.1, Placement::planar(1.5, 0)), "b");
    m.connect(Pin{}, m.ground().at({0, 0, 0}), a.at(Vec2(-0.5, 0)), "p");
    m.connect(Pin{}, a.at(Vec2(0.5, 0)), b.at(Vec2(-0.5, 0)), "q");
    m.connect(Drive{{.law = {}}}, m.ground().at({0, 0, 0}), a.at(Vec2(-0.5, 0)), "drive");
    m.apply(user_push(), b.at(Vec2(0.5, 0)), "f");
    return m;
  }
};
struct Beam {
  using Pin = Joint<planar::Revolute, Constraint>;
  using M = Model<Bodies<planar::Ffr>, Joints<Pin>, Forces<decltype(user_push())>>;
  static M make() {
    M m{Gravity{0, -9.81, 0}};
    Bar const bar{.length = 1,
                  .constants = BarConstants{.EA = 1e6, .EI = 10, .mass_per_length = 1, .rotary_inertia = 1e-4}};
    auto const a = m.add(planar::Ffr::from(bar, 4), "beam");
    m.connect(Pin{}, m.ground().at({0, 0, 0}), a.at(0.0), "p");
    m.apply(user_push(), a.at(1.0), "f");
    return m;
  }
};

bool same(VecX const& a, VecX const& b) { return a.size() == b.size() && a == b; }
bool same(State const& a, State const& b) {
  return a.t == b.t && same(a.q, b.q) && same(a.v, b.v) && same(a.a, b.a) && same(a.lambda, b.lambda) &&
         same(a.history, b.history);
}
bool same(RunReport const& a, RunReport const& b) {
  if (a.events.size() != b.events.size()) return false;
  for (std::size_t i = 0; i < a.events.size(); ++i)
    if (a.events[i].time != b.events[i].time) return false;
  return a.steps == b.steps && a.iterations == b.iterations && a.factorisations == b.factorisations &&
         a.evaluations == b.evaluations && a.rejected == b.rejected && a.halved == b.halved && a.left == b.left &&
         a.stopped == b.stopped && a.redundant == b.redundant && a.warnings == b.warnings;
}

/// Events with an event function, an event action and a terminal condition; all of them are callbacks.
RunOptions with_callbacks(RunOptions options, bool events) {
  options.progress = [](RunProgress const&) { calls(); };
  if (!events) return options;
  auto const at = [](char const* name, double t) {
    return Event{.name = name,
                 .value =
                     [t](State const& x) {
                       calls();
                       return t - x.t;
                     },
                 .tolerance = 1e-4};
  };
  options.events = {at("acts", 0.05), at("is met", 0.13), at("stops", options.end_time - 0.013)};
  options.events[0].action = [](State& x) {
    calls();
    x.v *= 0.5;
  };
  options.events[2].terminal = true;
  return options;
}

/// True if all call positions are tested, instead of about 40 of each step.
bool every_call() {
  char const* const asked = std::getenv("POLYBODY_HOSTILE");
  return asked && std::string(asked) == "all";
}

struct Tally {
  long threw = 0, damaged = 0;
};
/// Each step of a run is repeated until it succeeds, with an exception at the first call, then at the second, and so
/// on.
template <class Make, class I>
Tally throw_everywhere(Make const& make, I const& integrator, RunOptions const& options) {
  Tally tally;
  auto const model = make();
  State reference = model.reference_state();
  calls.bad = -1;
  auto plain = simulate(model, reference, integrator, options);
  RunReport const report = plain.run();
  State x = model.reference_state();
  auto run = simulate(model, x, integrator, options);
  while (!run.done()) {
    State const before = x;
    RunReport const report_before = run.report();
    for (long n = 1;; n += every_call() ? 1 : 1 + n / 12) {
      calls.bad = calls.made + n;
      try {
        run.advance();
        break;
      } catch (std::runtime_error const&) {
        ++tally.threw;
        if (same(x, before) && same(run.report(), report_before) && !run.done()) continue;
        ++tally.damaged;
        calls.bad = -1;
        return tally;
      }
    }
  }
  calls.bad = -1;
  // a repeated implicit step starts with the factors of the failed one, so Newton's iterates differ
  EXPECT_EQ(x.t, reference.t) << I::name;
  EXPECT_LT((x.q - reference.q).norm(), 1e-6 * (1.0 + reference.q.norm())) << I::name;
  EXPECT_LT((x.v - reference.v).norm(), 1e-4 * (1.0 + reference.v.norm())) << I::name;
  EXPECT_EQ(run.report().events.size(), report.events.size()) << I::name;
  EXPECT_EQ(run.report().steps, report.steps) << I::name;
  EXPECT_EQ(run.report().warnings.size(), report.warnings.size()) << I::name;
  EXPECT_EQ(run.report().redundant, report.redundant) << I::name;
  return tally;
}

long total = 0;
template <class Make, class I>
void expect_kept(Make const& make, I const& integrator, RunOptions const& options) {
  for (bool const events : {false, true}) {
    Tally const tally = throw_everywhere(make, integrator, with_callbacks(options, events));
    total += tally.threw;
    EXPECT_GT(tally.threw, 10) << I::name;
    EXPECT_EQ(tally.damaged, 0) << I::name << (events ? " with events" : "");
  }
}

TEST(ThrowingCallbacks, LeaveStateAndReportUnderEveryIntegrator) {
  auto const crank = [] { return Crank<Constraint>::make(); };
  RunOptions const options{.end_time = 0.3, .step = 0.02};
  expect_kept(crank, GeneralisedAlpha{}, options);
  expect_kept(crank, HhtAlpha{}, options);
  expect_kept(crank, Newmark{}, options);
  expect_kept(crank, Trapezoidal{}, options);
  expect_kept(crank, EnergyMomentum{}, options);
  expect_kept(crank, EnergyDecaying{}, options);
  expect_kept(crank, Radau{}, {.end_time = 0.16, .step = 0.02});
  expect_kept(crank, RungeKutta4<Projection>{}, options);
  expect_kept(crank, CentralDifference<Projection>{}, options);
  expect_kept(crank, DormandPrince<Projection>{}, {.end_time = 0.16, .step = 0.02});
  expect_kept(crank, AdamsBashforthMoulton<Projection>{}, {.end_time = 0.08, .step = 0.02});
  std::cout << total << " throws\n";
}
TEST(ThrowingCallbacks, LeaveStateAndReportWithEveryQuestion) {
  RunOptions const options{.end_time = 0.2, .step = 0.01};
  expect_kept([] { return Crank<Constraint>::make(); }, GeneralisedAlpha{},
              {.end_time = 0.2, .step = 0.02, .minimum_norm = true});
  expect_kept([] { return Crank<JointCoordinates>::make(); }, GeneralisedAlpha{}, options);
  expect_kept([] { return Crank<JointCoordinates>::make(); }, RungeKutta4<Projection>{}, options);
  expect_kept([] { return Beam::make(); }, GeneralisedAlpha{}, {.end_time = 0.2, .step = 0.005});
  std::cout << total << " throws\n";
}

}  // namespace throws_test
}  // namespace polybody
