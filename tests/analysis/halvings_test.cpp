// Halving of steps that do not converge, if the run permits it.
#include <gtest/gtest.h>

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
        if (!report.warnings.empty()) EXPECT_TRUE(has(report.warnings.back(), "steps were halved"));
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

// Steps of 0.6 periods would end with an energy of 283 J, compared with a scale of 4.9 J.
TEST(Halvings, APendulumAtAStepOfASecondIsRefused) {
  using Pin = Joint<Revolute, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Pin>> model{Gravity{0, 0, -9.81}};
  Mat3 const inertia = Vec3(0.01, 0.083, 0.083).asDiagonal().toDenseMatrix();
  auto const rod = model.add(Rigid<>(1.0, inertia, Placement::at({0.5, 0, 0})), "rod");
  model.connect(Pin{Revolute{.axis = Vec3(0, 1, 0)}, {}}, model.ground().at({0, 0, 0}), rod.at(Vec3(-0.5, 0, 0)));
  State x = model.reference_state();
  EXPECT_FALSE(message_of<Diverged>([&] {
                 simulate(model, x, GeneralisedAlpha{}, {.end_time = 10.0, .step = 1.0}).run();
               }).empty());
}

TEST(Halvings, RefusesNumbersThatCannotBeMeant) {
  Landing landing(0.1);
  EXPECT_TRUE(has(refusal([&] { landing.run(-1); }), "a step can be halved 0 to 30 times, but -1 is asked for"));
  EXPECT_TRUE(has(refusal([&] { landing.run(31); }), "but 31 is asked for"));
}

}  // namespace halvings_test
