// Servo that presses a hinge against its stop and then reverses (CASES3 14, after dartsim/dart#1583 and #2422), and a
// pendulum at rest on its backlash stop (jiminy#778).

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/limits.hpp>
#include <polybody/forces/user_force.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/energy_audit.hpp>
#include <polybody/run/joint_position.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"

namespace polybody {
namespace servo_on_a_stop_test {

/// Rate servo of the case: moment clamp(40 (ω_ref − ω), ±20) N m about the third axis, ω_ref = 1 rad/s before 2 s and
/// −1 rad/s afterwards.
auto servo() {
  return user_force<2>([]<class T>(std::array<Frame<T>, 2> const& f, double t) {
    Vec<T, 3> const axis = axis_of(f[0], 2), spin = f[1].w - f[0].w;
    T moment = ((t < 2.0 ? 1.0 : -1.0) - axis.dot(spin)) * 40.0;
    if (value_of(moment) > 20.0) moment = T(20.0);
    if (value_of(moment) < -20.0) moment = T(-20.0);
    std::array<Wrench<T>, 2> w;
    for (int i = 0; i < 3; ++i) {
      w[1].m[i] = axis[i] * moment;
      w[0].m[i] = -w[1].m[i];
    }
    return w;
  });
}

/// Arm of 1.5 kg on a hinge about −y, which hangs at zero, with its centre of mass at 0.5 m and J = 0.5 kg m² about
/// the hinge: 0.125 kg m² about the centre.
template <class Policy>
struct Arm {
  using Pin = Joint<Revolute, Policy>;
  using Servo = decltype(servo());
  Model<Bodies<Rigid<>>, Joints<Pin>, Forces<JointLimit, Servo>> model{Gravity{0, 0, -9.81}};
  BodyHandle<Rigid<>> arm =
      model.add(Rigid<>(1.5, Mat3(Vec3(0.125, 0.125, 0.01).asDiagonal()), Placement::at({0, 0, -0.5})), "arm");
  ElementHandle<Pin> hinge;
  ElementHandle<JointLimit> stop;
  explicit Arm(Policy const& policy = {})
      : hinge(model.connect(Pin{Revolute{.axis = Vec3(0, -1, 0)}, policy}, model.ground().at({0, 0, 0}),
                            arm.at(Vec3(0, 0, 0.5)), "hinge")),
        stop(model.apply(JointLimit{{.upper = 0.5, .stiffness = 1e4, .damping = 50.0}}, hinge, "stop")) {
    Placement along_hinge;  // third axis: that of the hinge
    along_hinge.axes << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    model.apply(servo(), model.ground().at(along_hinge), arm.at(Vec3(0, 0, 0.5)), "servo");
  }
};

struct Time {
  double t, angle;
};
/// Angles of CASES3, by Radau IIA of scipy with rtol 1e-11, from θ̈ = (servo + stop − 7.3575 sin θ)/0.5.
constexpr Time times[] = {{0.1, 0.08387673},  {0.3, 0.27768540}, {0.5, 0.46474471}, {1.9, 0.50164620},
                          {2.05, 0.46195710}, {2.1, 0.40825029}, {2.3, 0.19687401}, {2.5, -0.00704989}};

template <class Policy, class Integrator>
void follows(char const* formulation, Integrator const& method, Policy const& policy = {}) {
  Claim const angle{"X14", "angle of the hinge [rad]", By::independent, "Radau IIA (scipy), rtol 1e-11", formulation};
  Arm<Policy> arm(policy);
  State x = arm.model.reference_state();
  EnergyAudit audit(arm.model);
  audit.record(x);
  for (Time const& expected : times) {
    for (State const& now :
         simulate(arm.model, x, method, {.end_time = expected.t, .step = 2e-4, .breakpoints = {2.0}}))
      audit.record(now);
    held(angle, joint_angle(arm.model, x, arm.hinge), expected.angle, 1e-5,
         {.at = equals("t", expected.t), .scale = 0.5});
    if (expected.t == 1.9) {
      Claim const moment{"X14", "moment of the stop [N m]", By::closed_form, "20 − 7.3575 sin θ", formulation};
      held(moment, -applied_wrenches(arm.model, x, arm.stop)[1].m.dot(Vec3(0, -1, 0)), 16.462002, 1e-4);
    }
  }
  std::printf("audit %g\n", audit.relative());
  EXPECT_LT(audit.relative(), 1e-3);
}

TEST(ServoOnAStop, IsHeldAndReleased) {
  follows<Constraint>("Constraint, GeneralisedAlpha, h = 0.2 ms", GeneralisedAlpha{.rho_inf = 0.9});
  follows<JointCoordinates>("JointCoordinates, GeneralisedAlpha, h = 0.2 ms", GeneralisedAlpha{.rho_inf = 0.9});
  follows<Penalty>("Penalty, GeneralisedAlpha, h = 0.2 ms", GeneralisedAlpha{.rho_inf = 0.9},
                   {.stiffness = 1e8, .damping = 1e4});
  follows<Constraint>("Constraint, Radau, h = 0.2 ms", Radau{});
}

}  // namespace servo_on_a_stop_test
}  // namespace polybody
