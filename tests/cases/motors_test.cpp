// Motors on a hinge, compared with closed forms.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <polybody/forces/motors.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/joints/gears.hpp>
#include <polybody/run/energy_audit.hpp>
#include <polybody/vibration/modes.hpp>
#include <unsupported/Eigen/MatrixFunctions>

#include "support/hinge.hpp"

namespace polybody {
namespace motors_test {

/// y˙ = A (y − y₀) of current and speed of a motor with the torque constant nK on an inertia.
Mat<double, 2, 2> motor_matrix(DcMotor<> const& m, double inertia) {
  double const k = m.constant * m.gear_ratio;
  Mat<double, 2, 2> a;
  a << -m.resistance / m.inductance, -k / m.inductance, k / inertia, 0.0;
  return a;
}
DcMotor<> const motor{.voltage = {24.0}, .resistance = 2.0, .inductance = 0.02, .constant = 0.05, .gear_ratio = 4.0};

template <class H>
void expect_motor_step(H& arm, ElementHandle<OnAngle<DcMotor<>>> const& drive, double ratio, Mat<double, 2, 2> const& a,
                       char const* formulation) {
  Vec2 const rest(0.0, motor.voltage.value / (motor.constant * motor.gear_ratio));
  State x = arm.model.reference_state();
  EnergyAudit audit(arm.model);
  double supplied = 0.0, heat = 0.0, current = 0.0, h = 1e-3;
  for (State const& now : simulate(arm.model, x, Radau{}, {.end_time = 0.4, .step = h})) {
    audit.record(now);
    double const i = arm.model.states(now, drive)[0], before = current;
    supplied += 0.5 * h * motor.voltage.value * (i + before) * (now.t > 0.0);
    heat += 0.5 * h * motor.resistance * (i * i + before * before) * (now.t > 0.0);
    current = i;
    if (std::abs(std::remainder(now.t, 0.05)) > 1e-6) continue;
    Mat<double, 2, 2> const propagator = (a * now.t).exp();
    Vec2 const y = rest - propagator * rest;
    Instance const at{equals("t", now.t), 10.0};
    held(by_formula("current of a motor [A]", "exp At of two unknowns", formulation), i, y[0], 1e-6, at);
    held(by_formula("speed of its hinge [rad/s]", "exp At of two unknowns", formulation),
         joint_angle_rate(arm.model, now, arm.pin), y[1] * ratio, 1e-5, at);
  }
  EXPECT_LT(audit.relative(), 1e-4) << audit;
  double const magnetic = 0.5 * motor.inductance * current * current;
  EXPECT_NEAR(supplied, heat + magnetic + audit.work_of_loads(), 1e-4 * supplied);
}
TEST(Motors, DcMotorHasTheEigenvaluesAndTheStepOfItsMatrix) {
  double const inertia = 0.01;
  Mat<double, 2, 2> const a = motor_matrix(motor, inertia);
  Hinge<Constraint, OnAngle<DcMotor<>>> arm(inertia);
  auto const drive = arm.model.apply(OnAngle<DcMotor<>>{motor}, arm.pin, "motor");
  expect_motor_step(arm, drive, 1.0, a, "DcMotor, Radau IIA");

  DampedModes const found = damped_modes(arm.model, arm.model.reference_state());
  Eigen::EigenSolver<Mat<double, 2, 2>> const expected(a);
  ASSERT_EQ(found.eigenvalue.size(), 3);  // the first one is the free rotation
  for (int i = 0; i < 2; ++i) {
    std::complex<double> const s = found.eigenvalue[i + 1];
    double const near = std::min(std::abs(s - expected.eigenvalues()[0]), std::abs(s - expected.eigenvalues()[1]));
    held_within(by_formula("eigenvalues of a motor on a hinge [1/s]", "s² + (R/L) s + K²/(L J) = 0", "damped modes"),
                near, 1e-6 * std::abs(s), {equals("mode", i + 1.0), std::abs(s)});
  }
}

// A geared rotor is a body on its own hinge, which a ring gear connects with the arm: it adds n² J to the arm.
TEST(Motors, GearedRotorAddsItsInertiaTimesTheSquareOfTheRatio) {
  using Pin = Joint<Revolute>;
  using Gears = Joint<Gear>;
  struct Geared {
    Model<Bodies<Rigid<>>, Joints<Pin, Gears>, Forces<OnAngle<DcMotor<>>>> model;
    ElementHandle<Pin> pin;
  } arm;
  double const of_arm = 0.008, of_rotor = 1.25e-4;  // 0.008 + 4² · 1.25e-4 = 0.01
  Vec3 const beside(0.1, 0, 0);
  auto const body = arm.model.add(Rigid<>(1.0, Mat3(Mat3::Identity() * of_arm)), "arm");
  auto const rotor = arm.model.add(Rigid<>(0.2, Mat3(Mat3::Identity() * of_rotor), Placement::at(beside)), "rotor");
  Pin const about_z{Revolute{.axis = Vec3::UnitZ()}};
  arm.pin = arm.model.connect(about_z, arm.model.ground().at({0, 0, 0}), body.at({0, 0, 0}), "hinge");
  auto const bearing = arm.model.connect(about_z, arm.model.ground().at(beside), rotor.at({0, 0, 0}), "bearing");
  arm.model.connect(Gears{Gear{.teeth_a = 20, .teeth_b = -80, .axis = Vec3::UnitZ(), .centres = -Vec3::UnitX()}},
                    rotor.at({0, 0, 0}), body.at({0, 0, 0}), "gear");
  DcMotor<> direct = motor;
  direct.gear_ratio = 1.0;
  auto const drive = arm.model.apply(OnAngle<DcMotor<>>{direct}, bearing, "motor");
  expect_motor_step(arm, drive, 1.0, motor_matrix(motor, 0.01), "rotor with Gear, Radau IIA");
}

// A fan: J ω̇ = u(t) (M₀ − b ω) by a straight table, so ω = (M₀/b)(1 − exp(−b U/J)) with U = ∫u dt.
TEST(Motors, TorqueSpeedCurveRunsUpAlongItsTable) {
  using Motor = OnAngle<TorqueSpeedCurve<SmoothRamp>>;
  SmoothRamp const throttle{.target = 0.8, .duration = 0.5, .start = 0.1};
  Hinge<Constraint, Motor> fan(0.02);
  fan.model.apply(Motor{{.torque = MonotoneTable({{0.0, 3.0}, {40.0, 1.0}, {60.0, 0.0}}), .throttle = throttle}},
                  fan.pin, "motor");
  State const x = fan.after(1.0, Radau{}, 5e-3);
  held(by_formula("speed of a motor with a straight torque curve [rad/s]", "(M₀/b)(1 − exp(−b ∫u/J))",
                  "TorqueSpeedCurve, Radau IIA"),
       joint_angle_rate(fan.model, x, fan.pin), 60.0 * (1.0 - std::exp(-0.05 * throttle.integral(1.0) / 0.02)), 1e-6);
}

}  // namespace motors_test
}  // namespace polybody
