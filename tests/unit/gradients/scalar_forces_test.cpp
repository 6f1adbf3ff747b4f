// Derivatives of runs with stops and with a spring that counts turns, and checkpoints that keep its state.
#include <gtest/gtest.h>
#include <unistd.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/limits.hpp>
#include <polybody/forces/spring_laws.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/io/checkpoint.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/energy_audit.hpp>
#include <polybody/run/joint_position.hpp>

#include "support/slopes_of_runs.hpp"

namespace polybody::scalar_forces_test {

template <class Policy>
using Pin = Joint<Revolute, Policy>;
template <class Policy>
using Arms = Model<Bodies<Rigid<>>, Joints<Pin<Policy>>, Forces<TorsionalSpringDamper, JointLimit>>;

/// Two arms. A spring winds the first arm up by more than a turn, and a stop limits the hinge between the arms.
template <class Policy>
struct Winder {
  Arms<Policy> model{Gravity{0, 0, -9.81}};
  BodyHandle<Rigid<>> first, second;
  ElementHandle<Pin<Policy>> shoulder, elbow;
  ElementHandle<TorsionalSpringDamper> spring;
  State start;

  Winder(double mass, double stiffness, Limit const& stop, double speed) {
    auto const arm = [](double m, double at) {
      return Rigid<>(m, Mat3(Vec3(0.01 * m, 0.08 * m, 0.08 * m).asDiagonal()), Placement::at({at, 0, 0}));
    };
    first = model.add(arm(2.0, 0.5), "first");
    second = model.add(arm(mass, 1.5), "second");
    Pin<Policy> const pin{Revolute{.axis = Vec3(0, 1, 0)}};
    shoulder = model.connect(pin, model.ground().at({0, 0, 0}), first.at(Vec3(-0.5, 0, 0)), "shoulder");
    elbow = model.connect(pin, first.at(Vec3(0.5, 0, 0)), second.at(Vec3(-0.5, 0, 0)), "elbow");
    spring =
        model.apply(TorsionalSpringDamper{{.stiffness = stiffness, .damping = 0.2, .free = 8.0}}, shoulder, "spring");
    model.apply(JointLimit{stop}, elbow, "stop");
    start = model.reference_state();
    model.set_velocity(start, first, Vec3::Zero(), Vec3(0, speed, 0));
    model.set_velocity(start, second, Vec3::Zero(), Vec3(0, speed, 0));
  }
};

/// Stop on both sides whose damping begins continuously.
Limit const buffer{.lower = -0.2, .upper = 0.3, .stiffness = 2e3, .damping = 20.0, .onset = 0.02};

/// The stop of the derivatives is soft and pressed in all states: the times at which a stop begins and ends to act are
/// not differentiable at the steps of a run.
std::vector<Parameter> const parameters{{"mass [kg]", 1.0},
                                        {"stiffness [N m/rad]", 12.0},
                                        {"limit [rad]", 0.5},
                                        {"damping [N m s/rad]", 1.5},
                                        {"speed [rad/s]", 2.0}};

template <class Policy>
auto winder() {
  return [](std::span<double const> p) {
    Winder<Policy> w(p[0], p[1], {.lower = p[2], .stiffness = 40.0, .damping = p[3]}, p[4]);
    auto const tip = w.second.at(Vec3(0.5, 0, 0));
    auto const end = [tip](auto const& m, auto const& x) { return position(m, x, tip)[0] + 0.1 * x.v[4]; };
    auto const way = [tip](auto const& m, auto const& x) { return position(m, x, tip)[2]; };
    Scenario<Arms<Policy>> scenario{
        std::move(w.model), w.start, {.end_time = 0.8, .step = 1e-3}, {{"end", end}, {"way", way}}};
    return with_objective(std::move(scenario), end, way);
  };
}

// Angles: Runge–Kutta method of a separate script, from Lagrange's equations of the two angles, steps of 20 µs.
TEST(ScalarForces, AreWoundByMoreThanATurnAndMeetTheirStop) {
  Winder<Constraint> w(1.0, 12.0, buffer, 2.0);
  State x = w.start;
  TurnCounter turns(w.model, w.shoulder);
  EnergyAudit audit(w.model);
  double most = 0.0, least = 0.0;
  for (State const& now : simulate(w.model, x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = 1.2, .step = 2e-5})) {
    turns.record(now);
    audit.record(now);
    most = std::max(most, joint_angle(w.model, now, w.elbow));
    least = std::min(least, joint_angle(w.model, now, w.elbow));
  }
  EXPECT_NEAR(turns.angle(), 14.390811, 1e-5);
  EXPECT_NEAR(joint_angle(w.model, x, w.elbow), 0.299381, 1e-5);
  EXPECT_NEAR(w.model.states(x, w.spring)[0], turns.angle(), 1e-6);
  EXPECT_GT(most, 0.3);
  EXPECT_LT(least, -0.2);
  EXPECT_LT(audit.relative(), 1e-6);
}

TEST(ScalarForces, StopOfTheDerivativesIsPressed) {
  Winder<Constraint> w(1.0, 12.0, {.lower = 0.5, .stiffness = 40.0, .damping = 1.5}, 2.0);
  State x = w.start;
  TurnCounter turns(w.model, w.shoulder);
  EnergyAudit audit(w.model);
  double least = 1e3;
  for (State const& now : simulate(w.model, x, GeneralisedAlpha{.rho_inf = 1.0}, {.end_time = 0.8, .step = 1e-4})) {
    turns.record(now);
    audit.record(now);
    least = std::min(least,
                     40.0 * (0.5 - joint_angle(w.model, now, w.elbow)) - 1.5 * joint_angle_rate(w.model, now, w.elbow));
  }
  EXPECT_NEAR(least, 12.3370, 1e-3);  // force of the stop: the same script
  EXPECT_NEAR(turns.angle(), 9.4437267, 1e-5);
  EXPECT_NEAR(joint_angle(w.model, x, w.elbow), 0.1684249, 1e-5);
  EXPECT_LT(audit.relative(), 1e-6);
}

TEST(ScalarForces, DerivativesAreThoseOfWholeRuns) {
  expect_derivatives_of_runs(winder<Constraint>(), parameters, GeneralisedAlpha{.rho_inf = 0.8}, 1e-5);
  expect_derivatives_of_runs(winder<JointCoordinates>(), parameters, Radau{}, 1e-5);
}

TEST(ScalarForces, AdjointGradientIsThatOfTheSensitivities) {
  expect_derivatives_backwards(winder<Constraint>(), parameters, GeneralisedAlpha{.rho_inf = 0.8}, 1e-9);
}

TEST(ScalarForces, CheckpointsKeepTheTurns) {
  Winder<Constraint> w(1.0, 12.0, buffer, 2.0);
  RunOptions const options{.end_time = 1.2, .step = 1e-3};
  auto const file = std::filesystem::path(testing::TempDir()) / ("polybody turns " + std::to_string(::getpid()));
  State x = w.start, y;
  auto run = simulate(w.model, x, GeneralisedAlpha{}, options);
  while (x.t < 1.0) run.advance();
  EXPECT_GT(w.model.states(x, w.spring)[0], std::numbers::pi);
  write_checkpoint(file, run.snapshot());
  run.run();
  resume(w.model, y, GeneralisedAlpha{}, options, read_checkpoint(file)).run();
  std::filesystem::remove(file);
  EXPECT_EQ(y.v, x.v);
  EXPECT_EQ(y.q, x.q);
}

}  // namespace polybody::scalar_forces_test
