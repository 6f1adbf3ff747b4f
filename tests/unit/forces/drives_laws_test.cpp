// Law tests of servos, motors, belts and differentials, and their balance of forces and moments.
#include <polybody/parts.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/force_laws.hpp>

namespace polybody {
using namespace laws;
namespace drives_laws_test {

struct ServoOnAngle {
  static OnAngle<Servo<SmoothRamp>> force() {
    return {{.target = {.target = 2.0, .duration = 3.0}, .proportional_gain = 40.0, .derivative_gain = 5.0}};
  }
};
struct BoundedServoOnDistance {
  static OnDistance<Servo<>> force() {
    return {{.target = {0.5}, .proportional_gain = 40.0, .derivative_gain = 5.0, .most_speed = 0.2}};
  }
};
struct PidOnTranslation {
  static OnTranslation<PidServo<>> force() {
    return {{.target = {0.1},
             .proportional_gain = 40.0,
             .integral_gain = 30.0,
             .derivative_gain = 5.0,
             .tracking_time = 0.3,
             .most_force = 20.0}};
  }
};
struct SlowPidOnTurns {
  static OnTurns<RateLimited<PidServo<>>> force() {
    return {{.law = {.target = {0.1},
                     .proportional_gain = 4.0,
                     .integral_gain = 3.0,
                     .derivative_gain = 0.5,
                     .tracking_time = 0.3},
             .most_rate = 100.0,
             .lag = 0.2}};
  }
};
struct DcMotorOnAngle {
  static OnAngle<DcMotor<>> force() {
    return {{.voltage = {24.0}, .resistance = 0.5, .inductance = 2e-3, .constant = 0.07, .gear_ratio = 30.0}};
  }
};
struct CurveOnAngle {
  static OnAngle<TorqueSpeedCurve<>> force() {
    return {{.torque = MonotoneTable({{-2.0, 4.0}, {0.0, 3.0}, {0.5, 2.5}, {2.0, 0.0}}), .throttle = {0.7}}};
  }
};

/// Pulleys near their reference centres with small tilts, and random twists.
template <int N>
std::array<Frame<double>, N> pulleys(BeltAndPulley<N> const& belt, Numbers& number) {
  std::array<Frame<double>, N> all;
  for (std::size_t k = 0; k < N; ++k) {
    all[k] = number.frame();
    all[k].r = belt.centres[k] + number.template vec<3>(0.2);
    all[k].A = exp_so3<double>(number.template vec<3>(0.1));
  }
  return all;
}
struct CrossedBelt {
  static BeltAndPulley<2> force() {
    return {.radii = {0.5, 1.0},
            .centres = {Vec3(0, 0, 0), Vec3(9, 2, 0)},
            .axial_stiffness = 500.0,
            .damping = 20.0,
            .pretension = 120.0,
            .senses = {1, -1}};
  }
  static std::array<Frame<double>, 2> frames(Numbers& number) { return pulleys(force(), number); }
};
struct BeltWithIdler {
  static BeltAndPulley<3> force() {
    return {.radii = {0.5, 1.0, 0.3},
            .centres = {Vec3(0, 0, 0), Vec3(9, 2, 0), Vec3(4, 6, 0)},
            .axial_stiffness = 500.0,
            .damping = 20.0,
            .pretension = 120.0,
            .senses = {1, 1, -1}};
  }
  static std::array<Frame<double>, 3> frames(Numbers& number) { return pulleys(force(), number); }
};
struct DifferentialCase {
  static Differential force() { return {.stiffness = 300.0, .damping = 2.0}; }
  /// Shafts whose axes are parallel to that of the carrier.
  static std::array<Frame<double>, 3> frames(Numbers& number) {
    std::array<Frame<double>, 3> all = {number.frame(), number.frame(), number.frame()};
    for (std::size_t k = 1; k < 3; ++k) {
      all[k].A = all[0].A * exp_so3<double>(Vec3(0, 0, number(3.0)));
      all[k].w = all[0].w + all[0].A.col(2) * number();
    }
    return all;
  }
};

bool const drives_obey[] = {obeys<ServoOnAngle, ForceLaws>("ServoOnAngle"),
                            obeys<BoundedServoOnDistance, ForceLaws>("BoundedServoOnDistance"),
                            obeys<PidOnTranslation, ForceLaws>("PidOnTranslation"),
                            obeys<SlowPidOnTurns, ForceLaws>("SlowPidOnTurns"),
                            obeys<DcMotorOnAngle, ForceLaws>("DcMotorOnAngle"),
                            obeys<CurveOnAngle, ForceLaws>("CurveOnAngle"),
                            obeys<CrossedBelt, ForceLaws>("CrossedBelt"),
                            obeys<BeltWithIdler, ForceLaws>("BeltWithIdler"),
                            obeys<DifferentialCase, ForceLaws>("Differential")};

// Loads are excluded from the laws of action and reaction, so these tests apply them to drives.
template <class Case>
void expect_balance() {
  auto const force = Case::force();
  Numbers number;
  std::array<Frame<double>, 2> const f = {number.frame(), number.frame()};
  std::array<Wrench<double>, 2> w;
  if constexpr (states_of<decltype(Case::force())>() > 0)
    w = force.template wrenches<double>(f, {0.4}, 0.7);
  else
    w = force.template wrenches<double>(f, 0.7);
  double const size = w[1].f.norm() + w[1].m.norm();
  EXPECT_GT(size, 0.01);
  EXPECT_LT((w[0].f + w[1].f).norm(), 1e-13 * size);
  EXPECT_LT((w[0].m + w[1].m + f[0].r.cross(w[0].f) + f[1].r.cross(w[1].f)).norm(), 1e-12 * size);
}
TEST(Drives, ActOnBothBodiesOppositely) {
  expect_balance<ServoOnAngle>();
  expect_balance<BoundedServoOnDistance>();
  expect_balance<PidOnTranslation>();
  expect_balance<DcMotorOnAngle>();
  expect_balance<CurveOnAngle>();
}

/// Length of the belt on the three pulleys [m], less a constant, from the directions of the spans: the angle of d less
/// asin(D/|d|).
double length_on_pulleys(BeltAndPulley<3> const& belt, std::array<Vec3, 3> const& centres) {
  std::array<double, 3> direction;
  auto const signed_radius = [&](std::size_t k) { return belt.senses[k] * belt.radii[k]; };
  for (std::size_t k = 0; k < 3; ++k) {
    std::size_t const next = (k + 1) % 3;
    Vec3 const d = centres[next] - centres[k];
    direction[k] = std::atan2(d.y(), d.x()) - std::asin((signed_radius(next) - signed_radius(k)) / d.norm());
  }
  double length = 0.0;
  for (std::size_t k = 0; k < 3; ++k) length += signed_radius(k) * (direction[k] - direction[(k + 2) % 3]);
  return length;
}
// With equal strains ε of all spans, the belt that moving centres return from the pulleys is added to the spans,
// Σ z˙ = −(length on the pulleys)˙/(1 + ε). The rotation of the pulleys adds nothing.
TEST(Belt, MovingCentresReturnTheLengthOnThePulleys) {
  BeltAndPulley<3> const belt = BeltWithIdler::force();
  Numbers number;
  std::array<Frame<double>, 3> frames;
  for (std::size_t k = 0; k < 3; ++k) {
    frames[k].r = belt.centres[k];
    frames[k].v = Vec3(number(), number(), 0.0);
    frames[k].w = Vec3(0.0, 0.0, number());
  }
  double const rate = slope_at_zero([&](double h) {
    std::array<Vec3, 3> centres;
    for (std::size_t k = 0; k < 3; ++k) centres[k] = belt.centres[k] + frames[k].v * h;
    return length_on_pulleys(belt, centres);
  });
  auto const z = belt.rates<double>(frames, {0.0, 0.0, 0.0}, 0.0);
  double const strain = belt.pretension / belt.axial_stiffness;
  EXPECT_GT(std::abs(rate), 0.01);
  EXPECT_NEAR(z[0] + z[1] + z[2], -rate / (1.0 + strain), 1e-9);
}

}  // namespace drives_laws_test
}  // namespace polybody
