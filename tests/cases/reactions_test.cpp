// X15: reactions that contain every force. A ladder leans on a wall. Its contact is 0.15 m from its
// mid-plane (after drake#13888 and #12123). A motor drives a link on a base, which feels the motor's torque once
// (bullet3#2966, #4451).

#include <gtest/gtest.h>

#include <numbers>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/contact.hpp>
#include <polybody/forces/motors.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/policies/penalty.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/applied_wrenches.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/statics/equilibrium.hpp>

#include "support/held.hpp"

namespace polybody {
namespace reactions_test {

// Compliant policies: springs of 1e9 N/m and N m/rad for the ladder, of 1e8 for the link.
template <int rows>
PenaltyPerEquation<rows> per_equation(double k, double c) {
  return {.stiffness = Vec<double, rows>::Constant(k), .damping = Vec<double, rows>::Constant(c)};
}
Bushing bushing(double k, double c) {
  Vec3 const all = Vec3::Ones();
  return {.stiffness = Bushing::diagonal(k * all, k * all), .damping = Bushing::diagonal(c * all, c * all)};
}
auto laws(double k, double c) {
  LinearLaw const law{.stiffness = k, .damping = c};
  return NonlinearBushing{law, law, law, law, law, law};
}

/// Ladder of 4 m and 7 kg at 60°, of two halves with a weld, on a pin about z. The wall is at x = 2.01 m, the radius of
/// the contact point beyond the top. \tparam P, Q policies of pin and weld
template <class P, class Q>
void expect_ladder(char const* policy, P const& of_pin, Q const& of_weld, double tolerance) {
  using Pin = Joint<Revolute, P>;
  using Fixed = Joint<Weld, Q>;
  using Wall = Contact<SphereOnPlane>;
  double const angle = std::numbers::pi / 3, weight = 7.0 * 9.81, wall_force = 0.5 * weight / std::tan(angle);
  Model<Bodies<Rigid<>>, Joints<Pin, Fixed>, Forces<Wall>> model{Gravity{0, -9.81, 0}};
  auto const half = [&](double s, char const* name) {
    return model.add(Rigid<>(3.5, Mat3(Vec3(0.01, 3.5 * 4 / 12, 3.5 * 4 / 12).asDiagonal()),
                             Placement::at({s * std::cos(angle), s * std::sin(angle), 0}, {0, 0, angle})),
                     name);
  };
  auto const lower = half(1.0, "lower half"), upper = half(3.0, "upper half");
  auto const pin = model.connect(Pin{Revolute{.axis = {0, 0, 1}}, of_pin}, model.ground().at({0, 0, 0}),
                                 lower.at(Vec3(-1, 0, 0)), "pin");
  auto const weld = model.connect(Fixed{Weld{}, of_weld}, lower.at(Vec3(1, 0, 0)), upper.at(Vec3(-1, 0, 0)), "weld");
  Placement face{.origin = {2.01, 0, 0}};  // its third axis points at the ladder
  face.axes << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  auto const wall = model.apply(Wall{.geometry = {.radius = 0.01}, .normal = {.stiffness = 1e9, .damping = 1e4}},
                                upper.at(Vec3(1, 0, 0.15)), model.ground().at(face), "wall");
  auto const compare = [&](State const& x, std::string const& formulation) {
    auto const each = [&](char const* what, char const* source, Vec3 const& value, Vec3 const& reference) {
      for (int i = 0; i < 3; ++i)
        held({"X15", what, By::closed_form, source, formulation}, value[i], reference[i], tolerance,
             {.at = std::string(1, "xyz"[i]), .scale = reference.norm()});
    };
    Wrench<double> const middle = reaction(model, x, weld);
    each("force of the wall on a ladder [N]", "m g/(2 tan ϑ)", applied_wrenches(model, x, wall)[0].f,
         {-wall_force, 0, 0});
    each("force of the pin on a ladder [N]", "equilibrium", reaction(model, x, pin).f, {wall_force, weight, 0});
    each("force of the weld of a ladder [N]", "equilibrium of a half", middle.f, {wall_force, 0.5 * weight, 0});
    each("moment of the weld of a ladder [N m]", "equilibrium of a half", middle.m,
         {0, 0.15 * wall_force, -0.5 * weight * std::cos(angle)});
  };
  State x = model.reference_state();
  equilibrium(model, x);
  compare(x, policy);
  simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.02, .step = 1e-3}).run();
  compare(x, std::string(policy) + ", GeneralisedAlpha");
}
TEST(Reactions, OfALadderContainTheContact) {
  EXPECT_NEAR(0.5 * 68.67 / std::tan(std::numbers::pi / 3), 19.823321, 5e-7);  // digits of case X15
  EXPECT_NEAR(0.15 * 19.823321, 2.973498, 5e-7);
  auto const same = [](char const* name, auto const& policy, double tolerance) {
    expect_ladder(name, policy, policy, tolerance);
  };
  same("Constraint", Constraint{}, 1e-6);
  same("JointCoordinates", JointCoordinates{}, 1e-6);
  same("ArticulatedBody", JointCoordinatesBy<joint_coordinates::ArticulatedBody>{}, 1e-6);
  // The ladder turns by up to 68.67/1e9 rad and m, which changes lever arms and forces by less than 1e-5.
  double const k = 1e9, c = 1e5, compliant = 1e-5;
  same("Penalty", Penalty{.stiffness = k, .damping = c}, compliant);
  expect_ladder("PenaltyPerEquation", per_equation<5>(k, c), per_equation<6>(k, c), compliant);
  same("Bushing", bushing(k, c), compliant);
  same("NonlinearBushing", laws(k, c), compliant);
}

/// Link of 1 kg with its centre of mass at 0.4 m and J = 0.2 kg m² about the hinge, driven by 2 N m from rest. The base
/// is fixed to the ground. After 0.1 s the speed is 1 rad/s. \param tolerance of forces and moments [N], [N m]
template <class P, class I = Radau>
void expect_torque_once(char const* formulation, P const& policy, double tolerance, I const& integrator = {}) {
  using Pin = Joint<Revolute, P>;
  using Foot = Joint<Weld>;
  using Motor = OnAngle<TorqueSpeedCurve<>>;
  double const arm = 0.4, about_centre = 0.2 - arm * arm;
  Model<Bodies<Rigid<>>, Joints<Pin, Foot>, Forces<Motor>> model;
  auto const base = model.add(Rigid<>(5.0, Mat3(Mat3::Identity())), "base");
  auto const link = model.add(Rigid<>(1.0, Mat3(about_centre * Mat3::Identity()), Placement::at({arm, 0, 0})), "link");
  auto const foot = model.connect(Foot{}, model.ground().at({0, 0, 0}), base.centre(), "foot");
  auto const pin =
      model.connect(Pin{Revolute{.axis = {0, 0, 1}}, policy}, base.centre(), link.at(Vec3(-arm, 0, 0)), "pin");
  model.apply(Motor{{.torque = MonotoneTable({{0.0, 4.0}, {10.0, 4.0}}), .throttle = {0.5}}}, pin, "motor");
  State x = model.reference_state();
  auto const compare = [&](char const* what, char const* source, double value, double reference, double within,
                           double scale) {
    held({"X15", what, By::closed_form, source, formulation}, value, reference, within,
         {.at = equals("t", x.t), .scale = scale});
  };
  auto const torque_once = [&] {
    compare("acceleration of a link under 2 N m [rad/s²]", "M/J", angular_acceleration(model, x, link.centre()).z(),
            10.0, tolerance / 0.2, 10.0);
    compare("moment of the ground on the base of a motor [N m]", "M", reaction(model, x, foot).m.z(), 2.0, tolerance,
            2.0);
    compare("moment of a driven hinge about its axis [N m]", "0", reaction(model, x, pin).m.z(), 0.0, tolerance, 2.0);
  };
  if constexpr (std::is_same_v<P, Constraint>) {
    make_consistent(model, x);
    torque_once();
  }
  simulate(model, x, integrator, {.end_time = 0.1, .step = 1e-3}).run();
  torque_once();
  Vec3 const along = frame(model, x, link.centre()).A.col(0), force = reaction(model, x, pin).f;
  compare("centripetal force of a hinge [N]", "m r ω²", -force.dot(along), arm, tolerance, arm);
  compare("force of a hinge across the link [N]", "m r ω̇", force.dot(Vec3::UnitZ().cross(along)), 10.0 * arm, tolerance,
          10.0 * arm);
}
TEST(Reactions, OfADrivenLinkContainTheTorqueOnce) {
  expect_torque_once("Constraint, Radau", Constraint{}, 1e-6);
  expect_torque_once("JointCoordinates, Radau", JointCoordinates{}, 1e-6);
  expect_torque_once("ArticulatedBody, RungeKutta4", JointCoordinatesBy<joint_coordinates::ArticulatedBody>{}, 1e-6,
                     RungeKutta4<Projection>{});
  // Newton's method stops at corrections of about 1e-14 m, which change a force by 1e-6 N.
  double const k = 1e8, c = 1e4, compliant = 1e-5;
  expect_torque_once("Penalty, Radau", Penalty{.stiffness = k, .damping = c}, compliant);
  expect_torque_once("PenaltyPerEquation, Radau", per_equation<5>(k, c), compliant);
  expect_torque_once("Bushing, Radau", bushing(k, c), compliant);
  expect_torque_once("NonlinearBushing, Radau", laws(k, c), compliant);
}

}  // namespace reactions_test
}  // namespace polybody
