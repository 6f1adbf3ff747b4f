// title: Inertia of a URDF link in turned axes
// thread: https://github.com/google-deepmind/mujoco/issues/3559
// wanted: The inertial frame of a URDF link is turned by rpy. Readers omitted the rotation, applied it from one side
//     only, or transposed it.
// inputs: First link: diag(1, 2, 2.5) kg m² in axes turned by 90° about z. Second link: 2.5 kg, centre (0.05, −0.12,
//     0.20) m, rpy (0.3, −0.4, 0.5) rad, ixx 0.10, ixy 0.01, ixz −0.02, iyy 0.16, iyz 0.015, izz 0.21 kg m². It
//     swings on a hinge along x through its origin.
// right: J = R J_u Rᵀ, then parallel axes. Small swings: √(m g d/I_xx), with the distance d of the centre from the
//     hinge.
#include <polybody/polybody.hpp>
#include <polybody/vibration.hpp>

#include <numbers>

#include "answer.hpp"
using namespace polybody;

int main() {
  using Hinge = Joint<Revolute, Constraint>;
  Mat3 const principal = Vec3(1.0, 2.0, 2.5).asDiagonal();
  Inertia const first =
      Inertia{.mass = 1.0, .tensor = principal}.placed({Vec3::Zero(), roll_pitch_yaw(0, 0, 0.5 * std::numbers::pi)});
  answer("torque for 1 rad/s² about x [N m]", 2.0, first.tensor(0, 0), 1e-12);
  Mat3 tensor;
  tensor << 0.10, 0.01, -0.02, 0.01, 0.16, 0.015, -0.02, 0.015, 0.21;
  Inertia const link =
      Inertia{.mass = 2.5, .tensor = tensor}.placed({Vec3(0.05, -0.12, 0.20), roll_pitch_yaw(0.3, -0.4, 0.5)});
  answer("J_xx about the centre of mass [kg m²]", 0.12254332, link.tensor(0, 0), 1e-8);
  answer("J_xy about the centre of mass [kg m²]", -0.00330207, link.tensor(0, 1), 1e-8);
  answer("J_xz about the centre of mass [kg m²]", -0.04791194, link.tensor(0, 2), 1e-8);
  Mat3 const about_origin = link.about({0, 0, 0});
  answer("I_xx about the origin [kg m²]", 0.25854332, about_origin(0, 0), 1e-8);
  answer("I_yy about the origin [kg m²]", 0.26849339, about_origin(1, 1), 1e-8);
  answer("I_zz about the origin [kg m²]", 0.22746329, about_origin(2, 2), 1e-8);
  Model<Bodies<Rigid<>>, Joints<Hinge>> model{Gravity{0, 0, -9.81}};
  double const hanging = -0.5 * std::numbers::pi - std::atan2(0.20, -0.12);
  auto const body = model.add(Rigid<>(link.body({Vec3::Zero(), roll_pitch_yaw(hanging, 0, 0)})), "link");
  model.connect(Hinge{Revolute{.axis = {1, 0, 0}}}, model.ground().at({0, 0, 0}), body.at(Vec3(-link.centre)));
  State x = model.reference_state();
  equilibrium(model, x);
  answer("frequency of small swings [rad/s]", 4.703678, modes(model, x, 1).frequency[0], 1e-6);
  return wrong_answers();
}
