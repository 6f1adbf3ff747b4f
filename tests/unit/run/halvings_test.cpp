// Halving of steps that do not converge, if the run permits it.
#include <gtest/gtest.h>

#include <cstdlib>
#include <polybody/gradients/requirements.hpp>
#include <polybody/polybody.hpp>

#include "support/refusal.hpp"

using namespace polybody;

namespace halvings_test {

using OnFloor = Contact<SphereOnPlane>;
using Group = ContactGroup<OnFloor>;

// Mass that lands on a damper without smooth onset. Its force jumps to c ḋ at the contact, so some steps have no
// solution.
struct Landing {
  Model<Bodies<Rigid<>>, Joints<>, Forces<Group>> model{Gravity{0, 0, -9.81}};
  BodyHandle<Rigid<>> mass;
  State x;

  explicit Landing(double height)
      : mass(model.add(Rigid<>(18.0, Mat3::Identity(), Placement::at({0, 0, height})), "mass")) {
    auto const group = model.apply(Group{}, std::vector{mass.at(Vec3(0, 0, 0))});
    model.add_partner(group, OnFloor{{0.0}, {.stiffness = 2e6, .damping = 3e4}}, model.ground().at({0, 0, 0}));
    x = model.reference_state();
  }
  RunReport run(int max_step_halvings) {
    return simulate(model, x, GeneralisedAlpha{},
                    {.end_time = 0.15, .step = 2e-3, .max_step_halvings = max_step_halvings})
        .run();
  }
};

TEST(Halvings, LetLandingsThroughThatStall) {
  int stalled = 0, halved = 0;
  for (int i = 0; i < 100; ++i) {
    double const height = 0.02 + 2e-4 * i;
    Landing without(height), with(height);
    try {
      without.run(0);
    } catch (NewtonConvergenceFailure const&) {
      ++stalled;
      EXPECT_LT(without.x.t, 0.15);
      EXPECT_TRUE(without.x.q.allFinite());
    }
    RunReport const report = with.run(20);
    halved += report.rejected > 0;
    EXPECT_EQ(with.x.t, 0.15);
    // near the static position: the time constant after the landing is c/k = 15 ms, and the bound is the fall in that
    // time
    EXPECT_LT(std::abs(position(with.model, with.x, with.mass.at(Vec3(0, 0, 0))).z()), 0.01);
    EXPECT_EQ(report.steps, 75);
  }
  EXPECT_GT(stalled, 0);
  EXPECT_EQ(halved, stalled);
}

/// Message of the exception that f throws; empty if it throws none.
template <class F>
std::string failure_of(F&& f) {
  try {
    f();
  } catch (Error const& failure) {
    return failure.what();
  }
  return "";
}

/// Two rods on pins in space at 20 to 59 rad/s. The energy is constant.
struct TwoRods {
  using Pin = Joint<Revolute, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Pin>> model{Gravity{0, 0, -9.81}};
  State x;

  explicit TwoRods(int k) {
    Mat3 const inertia = Vec3(0.02, 0.09, 0.1).asDiagonal().toDenseMatrix();
    auto const a = model.add(Rigid<>(1.0, inertia, Placement::at({0.5, 0, 0})), "a"),
               b = model.add(Rigid<>(1.0, inertia, Placement::at({1.5, 0, 0})), "b");
    Vec3 const axis(0, 0.8, 0.6);
    model.connect(Pin{Revolute{.axis = Vec3(0, 0, 1)}, {}}, model.ground().at({0, 0, 0}), a.at(Vec3(-0.5, 0, 0)));
    model.connect(Pin{Revolute{.axis = axis}, {}}, a.at(Vec3(0.5, 0, 0)), b.at(Vec3(-0.5, 0, 0)));
    x = model.reference_state();
    double const w = 20.0 + k, u = -15.0 - 1.5 * k;
    model.set_velocity(x, a, Vec3::Zero(), Vec3(0, 0, w));
    model.set_velocity(x, b, Vec3::Zero(), Vec3(0, 0, w) + u * axis);
    assemble(model, x);
  }
};

// Halved steps that change the energy by more than half are refused, or the report contains a warning.
TEST(Halvings, DoNotChangeTheEnergyWithoutAWord) {
  int finished = 0, silent = 0, warned = 0;
  for (double const h : {3e-3, 1e-2})
    for (int k = 0; k < 40; k += 4) {
      TwoRods rods(k);
      double const start = energy(rods.model, rods.x).total();
      try {
        auto const report =
            simulate(rods.model, rods.x, GeneralisedAlpha{}, {.end_time = 2.0, .step = h, .max_step_halvings = 8})
                .run();
        ++finished;
        warned += !report.warnings.empty();
        double const ratio = energy(rods.model, rods.x).total() / start;
        EXPECT_LT(ratio, 3.0);
        if (report.warnings.empty() && !(ratio > 0.9 && ratio < 1.1)) ++silent;
        if (!report.warnings.empty()) {
          EXPECT_TRUE(has(report.warnings.back(), " halved. Repeat the run"));
        }
      } catch (Error const&) {
      }
    }
  EXPECT_EQ(silent, 0);
  EXPECT_GT(finished, 0);
  EXPECT_GT(warned, 0);
}

/// Ball of 1 kg and 0.1 m, dropped from 1 m onto an elastic floor of 1e5 N/m. The contact lasts 10 ms.
struct Bounce {
  Model<Bodies<Rigid<>>, Joints<>, Forces<OnFloor>> model{Gravity{0, 0, -9.81}};
  State x;

  Bounce() {
    Mat3 const inertia = 0.004 * Mat3::Identity();
    auto const ball = model.add(Rigid<>(1.0, inertia, Placement::at({0, 0, 1.1})), "ball");
    model.apply(OnFloor{{0.1}, {.stiffness = 1e5}}, ball.at(Vec3(0, 0, 0)), model.ground().at({0, 0, 0}), "floor");
    x = model.reference_state();
  }
};
template <class I>
void expect_a_word(I const& integrator, double h) {
  Bounce bounce;
  double highest = 0.0;
  bool hit = false;
  std::vector<std::string> warnings;
  try {
    auto run = simulate(bounce.model, bounce.x, integrator, {.end_time = 1.5, .step = h, .max_step_halvings = 6});
    for (State const& now : run) {
      hit = hit || now.q[2] < 0.1;
      if (hit) highest = std::max(highest, now.q[2] - 0.1);
    }
    warnings = run.report().warnings;
  } catch (Error const&) {
    EXPECT_LT(highest, 4.0) << I::name << ' ' << h;
    return;
  }
  EXPECT_LT(highest, 3.1) << I::name << ' ' << h;
  if (std::abs(energy(bounce.model, bounce.x).total() - 1.1 * 9.81) > 0.1 * 9.81)
    EXPECT_FALSE(warnings.empty()) << I::name << ' ' << h;
}
TEST(Halvings, AnElasticBallThatGainsEnergyIsRefusedOrWarnedOf) {
  for (double const h : {0.05, 0.02, 0.01, 1e-3}) {
    expect_a_word(GeneralisedAlpha{}, h);
    expect_a_word(HhtAlpha{}, h);
    expect_a_word(RungeKutta4<Projection>{}, h);
    expect_a_word(Radau{}, h);
  }
}

// 100 m/s: in a step of 0.02 s the first ball of 0.05 m would pass the second.
TEST(Halvings, AnImpactThatAStepJumpsOverIsFound) {
  using Balls = Contact<SphereOnSphere>;
  for (int const max_step_halvings : {0, 8}) {
    Model<Bodies<Rigid<>>, Joints<>, Forces<Balls>> model;
    Mat3 const inertia = 0.004 * Mat3::Identity();
    auto const a = model.add(Rigid<>(1.0, inertia, Placement::at({-1.03, 0, 0})), "a"),
               b = model.add(Rigid<>(1.0, inertia), "b");
    model.apply(Balls{{.radius_a = 0.05, .radius_b = 0.05}, {.stiffness = 1e6}}, a.at(Vec3(0, 0, 0)),
                b.at(Vec3(0, 0, 0)), "balls");
    State x = model.reference_state();
    x.v[0] = 100.0;
    auto const run = [&] {
      return simulate(model, x, GeneralisedAlpha{},
                      {.end_time = 0.1, .step = 0.02, .max_step_halvings = max_step_halvings})
          .run();
    };
    if (max_step_halvings == 0) {
      std::string const message = message_of<NewtonConvergenceFailure>([&] { run(); });
      EXPECT_TRUE(has(message, "jumps over the contact \"balls\"")) << message;
      EXPECT_EQ(x.q[0], -1.03);
    } else {
      RunReport const report = run();
      EXPECT_GT(report.rejected, 0);
      EXPECT_GT(x.v[6], 1.0);  // the impact occurs, although the steps do not resolve it
      EXPECT_EQ(report.warnings.size(), 1u);
    }
  }
}

/// Rod of 1 m and 1 kg on a pin, released from the horizontal. It exchanges 4.905 J with gravity in 1.6 s.
struct Pendulum {
  using Pin = Joint<Revolute, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Pin>> model{Gravity{0, 0, -9.81}};
  State x;

  Pendulum() {
    Mat3 const inertia = Vec3(0.01, 0.083, 0.083).asDiagonal().toDenseMatrix();
    auto const rod = model.add(Rigid<>(1.0, inertia, Placement::at({0.5, 0, 0})), "rod");
    model.connect(Pin{Revolute{.axis = Vec3(0, 1, 0)}, {}}, model.ground().at({0, 0, 0}), rod.at(Vec3(-0.5, 0, 0)));
    x = model.reference_state();
  }
};

// Steps of 0.6 periods gain 210 J, and the run is refused. A run with halves gains no more than half of the limit.
TEST(Halvings, APendulumAtAStepOfASecondIsHalvedOrRefused) {
  Pendulum strict, halved;
  EXPECT_FALSE(message_of<Diverged>([&] {
                 simulate(strict.model, strict.x, GeneralisedAlpha{},
                          {.end_time = 10.0, .step = 1.0, .max_step_halvings = 0})
                     .run();
               }).empty());
  auto run = simulate(halved.model, halved.x, GeneralisedAlpha{}, {.end_time = 10.0, .step = 1.0});
  double const start = energy(halved.model, halved.x).total();
  for (State const& now : run) EXPECT_LT(energy(halved.model, now).total() - start, 0.5 * 4.905) << now.t;
  EXPECT_EQ(halved.x.t, 10.0);
  EXPECT_EQ(run.report().steps, 10);
  EXPECT_GT(run.report().halved, 0);
  ASSERT_EQ(run.report().warnings.size(), 1u);
  EXPECT_TRUE(has(run.report().warnings[0], "that no work explains")) << run.report().warnings[0];
}

// The attempts that fail at the landing are part of the costs of the step. Their number is that of the message of a run
// without halvings.
TEST(Halvings, CountsTheCostOfFailedAttempts) {
  int compared = 0;
  for (int i = 0; i < 100; ++i) {
    double const height = 0.02 + 2e-4 * i;
    Landing refused(height), halved(height);
    std::string const message = failure_of([&] { refused.run(0); });
    if (message.empty()) continue;
    int const after = std::stoi(message.substr(message.find(" after ") + 7));
    auto run = simulate(halved.model, halved.x, GeneralisedAlpha{}, {.end_time = 0.15, .step = 2e-3});
    RunCounts sum;
    long steps_with_halves = 0;
    while (!run.done()) {
      run.advance();
      StepReport const& last = run.report().last;
      sum.iterations += last.iterations;
      sum.factorisations += last.factorisations;
      sum.evaluations += last.evaluations;
      sum.halved += last.halved;
      steps_with_halves += last.halved > 0;
      // three Newton solves at least: one or more failed ones, and those of the halves
      if (last.halved > 0) {
        EXPECT_GE(last.iterations, after + 2 * (last.halved + 1)) << height;
      }
      EXPECT_EQ(last.halved, last.rejected);
    }
    RunReport const& report = run.report();
    EXPECT_EQ(report.iterations, sum.iterations);
    EXPECT_EQ(report.factorisations, sum.factorisations);
    EXPECT_EQ(report.evaluations, sum.evaluations);
    EXPECT_EQ(report.halved, sum.halved);
    EXPECT_GT(steps_with_halves, 0);
    ++compared;
  }
  EXPECT_GT(compared, 0);
}

/// Links of 0.1 m and 1 kg on pins, released from the horizontal.
struct Links {
  using Pin = Joint<Revolute, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Pin>> model{Gravity{0, 0, -9.81}};
  State x;

  explicit Links(int n) {
    Pin const pin{Revolute{.axis = Vec3::UnitY()}, {}};
    Mat3 const inertia = Vec3(1e-4, 1e-3, 1e-3).asDiagonal();
    std::optional<BodyHandle<Rigid<>>> before;
    for (int i = 0; i < n; ++i) {
      auto const link = model.add(Rigid<>(1.0, inertia, Placement::at({0.1 * i + 0.05, 0, 0})));
      if (before)
        model.connect(pin, before->at(Vec3(0.05, 0, 0)), link.at(Vec3(-0.05, 0, 0)));
      else
        model.connect(pin, model.ground().at({0, 0, 0}), link.at(Vec3(-0.05, 0, 0)));
      before = link;
    }
    x = model.reference_state();
  }
};

TEST(Halvings, OfTheDefaultLetAChainOf64LinksFallFor10Seconds) {
  Links strict(64), links(64);
  EXPECT_FALSE(message_of<NewtonConvergenceFailure>([&] {
                 simulate(strict.model, strict.x, GeneralisedAlpha{},
                          {.end_time = 5.0, .step = 1e-3, .max_step_halvings = 0})
                     .run();
               }).empty());
  RunReport const report = simulate(links.model, links.x, GeneralisedAlpha{}, {.end_time = 10.0, .step = 1e-3}).run();
  EXPECT_EQ(links.x.t, 10.0);
  EXPECT_EQ(report.steps, 10000);
  EXPECT_GT(report.halved, 0);
  EXPECT_LT(report.halved, 100);
}

// 16 links whip at 0.79 s. Steps of 4 ms then gain more energy than the whole fall releases.
TEST(Halvings, RepeatStepsThatGainEnergy) {
  Links strict(16), links(16);
  EXPECT_TRUE(has(message_of<Diverged>([&] {
                    simulate(strict.model, strict.x, GeneralisedAlpha{},
                             {.end_time = 1.0, .step = 4e-3, .max_step_halvings = 0})
                        .run();
                  }),
                  "J more energy than the work"));
  double const start = energy(links.model, links.x).total();
  auto run = simulate(links.model, links.x, GeneralisedAlpha{}, {.end_time = 10.0, .step = 4e-3});
  double released = 0.0, most = -1e9;
  for (State const& now : run) {
    Energy const e = energy(links.model, now);
    released = std::max(released, -e.gravity);
    most = std::max(most, e.total() - start);
  }
  EXPECT_EQ(links.x.t, 10.0);
  EXPECT_LT(most, 0.75 * released);
  RunReport const& report = run.report();
  EXPECT_GT(report.halved, 0);
  EXPECT_EQ(report.rejected, report.halved);
  ASSERT_FALSE(report.warnings.empty());
  EXPECT_TRUE(has(report.warnings.back(), std::to_string(report.halved) + " steps were halved")) << report.warnings[0];
}

// The energy of 4 links at 4 ms oscillates by a third of the energy that moves, and returns.
TEST(Halvings, LeaveTheBitsOfAReversibleOscillation) {
  Links strict(4), links(4);
  simulate(strict.model, strict.x, GeneralisedAlpha{}, {.end_time = 10.0, .step = 4e-3, .max_step_halvings = 0}).run();
  RunReport const report = simulate(links.model, links.x, GeneralisedAlpha{}, {.end_time = 10.0, .step = 4e-3}).run();
  EXPECT_EQ(report.halved, 0);
  EXPECT_EQ(links.x.q, strict.x.q);
  EXPECT_EQ(links.x.v, strict.x.v);
}

TEST(Halvings, OfTheDefaultLeaveTheBitsOfARunWithoutFailures) {
  Links strict(16), links(16);
  simulate(strict.model, strict.x, GeneralisedAlpha{}, {.end_time = 2.0, .step = 1e-3, .max_step_halvings = 0}).run();
  RunReport const report = simulate(links.model, links.x, GeneralisedAlpha{}, {.end_time = 2.0, .step = 1e-3}).run();
  EXPECT_EQ(links.x.q, strict.x.q);
  EXPECT_EQ(links.x.v, strict.x.v);
  EXPECT_EQ(report.halved, 0);
}

// A snapshot restarts the energy balance in both runs, so that they halve the same steps.
TEST(Halvings, OfAResumedRunAreThoseOfTheRunItself) {
  Links whole(16), parted(16);
  RunOptions const options{.end_time = 3.0, .step = 4e-3};
  auto run = simulate(whole.model, whole.x, GeneralisedAlpha{}, options);
  while (whole.x.t < 1.2) run.advance();
  RunSnapshot const snapshot = run.snapshot();
  long const before = run.report().halved;
  run.run();
  EXPECT_GT(run.report().halved, before);
  RunReport const report = resume(parted.model, parted.x, GeneralisedAlpha{}, options, snapshot).run();
  EXPECT_EQ(parted.x.q, whole.x.q);
  EXPECT_EQ(parted.x.v, whole.x.v);
  EXPECT_EQ(report.halved, run.report().halved);
}

// 10 s of chains, or a refusal with a type. POLYBODY_HOSTILE=all: all lengths and steps.
TEST(Halvings, ChainsUnderDefaultOptionsPassOrEndInARefusal) {
  char const* const asked = std::getenv("POLYBODY_HOSTILE");
  bool const all = asked && std::string(asked) == "all";
  for (int const n : all ? std::vector{4, 8, 16, 32, 64, 128, 256} : std::vector{4, 16, 64})
    for (double const h : all ? std::vector{5e-4, 1e-3, 2e-3, 4e-3, 1e-2} : std::vector{2e-3, 1e-2}) {
      SCOPED_TRACE(std::to_string(n) + " links, step " + number(h));
      Links links(n);
      auto run = simulate(links.model, links.x, GeneralisedAlpha{}, {.end_time = 10.0, .step = h});
      try {
        run.run();
        EXPECT_EQ(links.x.t, 10.0);
      } catch (Diverged const& refused) {
        EXPECT_TRUE(has(refused.what(), "limits.energy")) << refused.what();
      } catch (NewtonConvergenceFailure const& refused) {
        EXPECT_TRUE(has(refused.what(), "was halved 6 times")) << refused.what();
      }
      EXPECT_TRUE(links.x.q.allFinite());
      EXPECT_TRUE((n > 64 && h > 1e-3) || links.x.t == 10.0) << links.x.t;
    }
}

// The halved steps, and a warning of the start.
TEST(Halvings, AndWarningsAreInTheMessageOfTheExceptionThatEndsTheRun) {
  Links links(16);
  Event const failing{.name = "failing", .value = [](State const& now) {
                        if (now.t > 1.0) throw InvalidInput("no value");
                        return 1.0;
                      }};
  auto run = simulate(links.model, links.x, GeneralisedAlpha{}, {.end_time = 2.0, .step = 4e-3, .events = {failing}});
  std::string const message = message_of<InvalidInput>([&] { run.run(); });
  EXPECT_GT(run.report().halved, 0);
  EXPECT_TRUE(has(message, "no value")) << message;
  EXPECT_TRUE(has(message, std::to_string(run.report().halved) + " step")) << message;

  using Soft = Joint<planar::Revolute, Penalty>;
  Model<Bodies<planar::Rigid>, Joints<Soft>> model{Gravity{0, -9.81, 0}};
  auto const rod = model.add(planar::Rigid(1.0, 0.1, Placement::planar(0.5, 0)), "rod");
  model.connect(Soft{{}, {.stiffness = 1e9, .damping = 0.0}}, model.ground().at({0, 0, 0}), rod.at(Vec2(-0.5, 0)),
                "pin");
  State x = model.reference_state();
  auto long_steps = simulate(model, x, RungeKutta4<>{}, {.end_time = 1.0, .step = 1e-2});
  ASSERT_EQ(long_steps.report().warnings.size(), 1u);
  std::string const warning = long_steps.report().warnings[0], said = failure_of([&] { long_steps.run(); });
  EXPECT_TRUE(has(said, "diverges")) << said;
  EXPECT_TRUE(has(said, "Warning of the run: " + warning)) << said;
  EXPECT_EQ(long_steps.report().warnings.size(), 1u);
}

TEST(Halvings, OfTheDefaultAreNotInheritedByRunsThatAreDifferentiated) {
  EXPECT_NO_THROW(detail::require_plain({.end_time = 1.0, .step = 0.1}, "gradient"));
  EXPECT_NO_THROW(detail::require_plain({.end_time = 1.0, .step = 0.1, .max_step_halvings = 0}, "gradient"));
  EXPECT_TRUE(
      has(refusal([] { detail::require_plain({.end_time = 1.0, .step = 0.1, .max_step_halvings = 6}, "gradient"); }),
          "gradient: a run with halved steps"));
}

TEST(Halvings, RefusesNumbersThatCannotBeMeant) {
  Landing landing(0.1);
  EXPECT_TRUE(has(refusal([&] { landing.run(-1); }), "max_step_halvings must lie in [0, 30], but is -1"));
  EXPECT_TRUE(has(refusal([&] { landing.run(31); }), "must lie in [0, 30], but is 31"));
}

}  // namespace halvings_test
