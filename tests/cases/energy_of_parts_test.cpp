// The energy audit of drives, springs, stops and joint friction closes within 1e-6 of the turnover, and the unaccounted
// energy falls with the step. Other tests of this bound: belt_test, differential_test, servo_test (PID, bounded rate),
// servo_on_a_stop_test, spring_laws_test (rope, winch, spring), limits_test.
#include <gtest/gtest.h>

#include <polybody/joints/standard_joints.hpp>
#include <polybody/parts.hpp>

#include "support/closed_audit.hpp"

namespace polybody {
namespace energy_of_parts_test {

using Pin = Joint<Revolute>;
using Slide = Joint<Prismatic>;
using Ball = Joint<Spherical>;
auto cubic() {
  return [](auto const& x, auto const& rate) { return x * 30.0 + x * x * x * 200.0 + rate * 2.0; };
}
/// Model of one body on a joint with one part.
using M =
    Model<Bodies<Rigid<>>, Joints<Pin, Slide, Ball>,
          Forces<OnAngle<Servo<SmoothRamp>>, OnTurns<DcMotor<>>, OnAngle<TorqueSpeedCurve<SmoothRamp>>,
                 OnAngle<TwoSlopeSpring>, OnAngle<TableSpring>, OnAngle<TableDamper>,
                 OnAngle<FunctionSpring<decltype(cubic())>>, OnAngle<Backlash>, OnAngle<BumpStop>, JointLimit,
                 OnAngle<DryFriction>, OnTranslation<LuGreFriction>, BearingFriction<Pin>, StickingBearingFriction<Pin>,
                 GuideFriction<Slide>, StickingGuideFriction<Slide>, SphericalFriction, SphericalBristleFriction>>;
using Case = AuditCase<M>;

/// Arm of 1.5 kg with J = 0.5 kg m² about its hinge, centre of mass at 0.5 m, that hangs and turns with `rate`.
template <class F>
auto on_hinge(F const& force, double rate) {
  return [=](M& m) {
    auto const arm = m.add(Rigid<>(1.5, Mat3(Mat3::Identity() * 0.125), Placement::at({0, -0.5, 0})), "arm");
    auto const pin = m.connect(Pin{Revolute{.axis = Vec3::UnitZ()}}, m.ground().at({0, 0, 0}), arm.at({0, 0.5, 0}));
    m.apply(force, pin, "part");
    State x = m.reference_state();
    m.set_velocity(x, arm, Vec3::Zero(), {0, 0, rate});
    return x;
  };
}
/// Block of 2 kg on a slide down a slope of ½.
template <class F>
auto on_slide(F const& force, double speed) {
  return [=](M& m) {
    auto const block = m.add(Rigid<>(2.0, Mat3(Mat3::Identity() * 0.1), Placement{}), "block");
    Vec3 const axis = Vec3(1.0, -0.5, 0.0).normalized();
    auto const slide = m.connect(Slide{Prismatic{.axis = axis}}, m.ground().at({0, 0, 0}), block.at({0, 0, 0}));
    m.apply(force, slide, "part");
    State x = m.reference_state();
    m.set_velocity(x, block, speed * axis, Vec3::Zero());
    return x;
  };
}
/// Rigid body of 1.5 kg that hangs on a spherical joint and rotates with `spin`.
template <class F>
auto on_ball(F const& force, Vec3 const& spin) {
  return [=](M& m) {
    auto const top = m.add(Rigid<>(1.5, Mat3(Vec3(0.1, 0.03, 0.12).asDiagonal()), Placement::at({0, -0.3, 0})), "top");
    auto const a = m.ground().at({0, 0, 0});
    auto const b = top.at({0, 0.3, 0});
    m.connect(Ball{}, a, b);
    m.apply(force, a, b, "part");
    State x = m.reference_state();
    m.set_velocity(x, top, Vec3::Zero(), spin);
    return x;
  };
}
FrictionCurve const stribeck{.sliding = 1.0, .break_away = 1.5, .stribeck_speed = 0.5, .viscous = 0.1};
MonotoneTable const table{{{-2.0, -9.0}, {-0.5, -2.0}, {0.0, 0.0}, {0.5, 3.0}, {2.0, 10.0}}};

std::vector<Case> drives() {
  MonotoneTable const speeds{{{0.0, 3.0}, {4.0, 2.0}, {6.0, 0.0}}};
  return {
      {"Servo without a bound", 1.0, 2e-3, 3,
       on_hinge(
           OnAngle<Servo<SmoothRamp>>{
               {.target = {.target = 1.0, .duration = 0.8}, .proportional_gain = 60.0, .derivative_gain = 9.0}},
           0.0)},
      {"Servo at its bound of force", 1.0, 1e-4, 2,
       on_hinge(OnAngle<Servo<SmoothRamp>>{{.target = {.target = 1.0, .duration = 0.3},
                                            .proportional_gain = 60.0,
                                            .derivative_gain = 9.0,
                                            .most_force = 9.0}},
                0.0)},
      {"DcMotor", 1.0, 2e-3, 3,
       on_hinge(
           OnTurns<DcMotor<>>{
               {.voltage = {24.0}, .resistance = 2.0, .inductance = 0.1, .constant = 0.3, .gear_ratio = 4.0}},
           0.0)},
      {"TorqueSpeedCurve", 1.0, 1e-3, 2,
       on_hinge(OnAngle<TorqueSpeedCurve<SmoothRamp>>{{.torque = speeds, .throttle = {.target = 0.8, .duration = 0.5}}},
                1.0)}};
}
std::vector<Case> springs() {
  return {
      {"TwoSlopeSpring", 1.0, 5e-4, 2,
       on_hinge(
           OnAngle<TwoSlopeSpring>{
               {.stiffness_above = 40.0, .stiffness_below = 90.0, .damping_rising = 0.4, .damping_falling = 0.9}},
           3.0)},
      {"TableSpring", 1.0, 1e-3, 2, on_hinge(OnAngle<TableSpring>{{.table = table, .damping = 0.5}}, 3.0)},
      {"TableDamper", 1.0, 1e-3, 2, on_hinge(OnAngle<TableDamper>{{.table = table}}, 3.0)},
      {"FunctionSpring", 1.0, 1e-3, 3, on_hinge(on_angle(FunctionSpring{cubic()}), 3.0)},
      {"Backlash", 1.0, 2e-4, 2,
       on_hinge(OnAngle<Backlash>{{.play = 0.2, .stiffness = 400.0, .damping = 4.0, .onset = 0.05}}, 2.0)},
      {"BumpStop", 1.0, 2e-4, 2, on_hinge(OnAngle<BumpStop>{{.upper = 0.3, .stiffness = 3e3, .damping = 0.4}}, 3.0)},
      {"Limit with an onset", 1.0, 2e-4, 2,
       on_hinge(JointLimit{{.lower = -0.1, .upper = 0.3, .stiffness = 400.0, .damping = 4.0, .onset = 0.05}}, 2.0)}};
}
std::vector<Case> friction() {
  return {{"DryFriction", 1.0, 5e-4, 3, on_hinge(OnAngle<DryFriction>{{stribeck, 0.3}}, 3.0)},
          {"LuGreFriction", 0.5, 2e-4, 2,
           on_slide(OnTranslation<LuGreFriction>{{.curve = {.sliding = 12.0, .break_away = 14.0, .stribeck_speed = 0.5},
                                                  .stiffness = 2e3,
                                                  .damping = 40.0,
                                                  .elastic_share = 0.5}},
                    1.0)},
          {"BearingFriction", 1.0, 1e-3, 3,
           on_hinge(BearingFriction<Pin>{.coefficient = 0.4, .radius = 0.05, .resistance = {.slip_speed = 0.5}}, 3.0)},
          {"StickingBearingFriction", 1.0, 2e-3, 2,
           on_hinge(
               StickingBearingFriction<Pin>{
                   .coefficient = 0.4, .radius = 0.05, .resistance = {.stiffness = 50.0, .damping = 2.0}},
               3.0)},
          {"GuideFriction", 1.0, 1e-3, 3,
           on_slide(GuideFriction<Slide>{.coefficient = 0.3, .resistance = {.slip_speed = 0.2}}, 1.0)},
          {"StickingGuideFriction", 1.0, 2e-4, 2,
           on_slide(StickingGuideFriction<Slide>{.coefficient = 0.7, .resistance = {.stiffness = 1e3, .damping = 20.0}},
                    1.0)},
          {"SphericalFriction", 1.0, 1e-3, 3, on_ball(SphericalFriction{stribeck, 0.3}, {2, 1, -2})},
          {"SphericalBristleFriction", 1.0, 2e-4, 2,
           on_ball(SphericalBristleFriction{.sliding = 1.0, .stiffness = 50.0, .damping = 2.0}, {2, 1, -2})}};
}
TEST(EnergyOfParts, OfDrivesCloses) { expect_closed(drives()); }
TEST(EnergyOfParts, OfSpringsAndStopsCloses) { expect_closed(springs()); }
TEST(EnergyOfParts, OfFrictionCloses) { expect_closed(friction()); }

}  // namespace energy_of_parts_test
}  // namespace polybody
