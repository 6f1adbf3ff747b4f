// title: Double Cardan joint, once and twice
// thread: https://github.com/OpenModelica/OpenModelica/issues/8365
// wanted: Two Cardan joints and a sliding middle shaft transmit a constant speed. One branch runs. A second, equal
//     branch between the same shafts did not.
// inputs: 20 rad/s, load 9 N m, no gravity. Shafts at 0°, 30° and 60°, Cardan joints at 0 and at 0.5 m along the
//     middle shaft. The middle shaft has two halves of 5e-4 kg m² each. The values are those at π/80 s.
// right: ω_m = 20 cos β/(1 − sin²β sin² 20t) with β = 30°. Power: the driving torque is 9 + n 1e-3 ω_m ω̇_m/20 with n
//     branches, and with minimum-norm multipliers each branch transmits an equal part. Two branches have 36 constraint
//     equations of rank 35.
#include <polybody/polybody.hpp>

#include <numbers>

#include "answer.hpp"
using namespace polybody;

void turn(int branches, std::string const& name, double right_torque) {
  using Pin = Joint<Revolute, Constraint>;
  using Cardan = Joint<Universal, Constraint>;
  using Slide = Joint<Prismatic, Constraint>;
  using Drive = Joint<PrescribedRate<Constant>, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Pin, Cardan, Slide, Drive>, Forces<PointMoment<>>> model;
  auto const axis = [](double degrees) { return Vec3(roll_pitch_yaw(0, 0, degrees * std::numbers::pi / 180).col(0)); };
  Vec3 const e1 = axis(0), em = axis(30), e2 = axis(60), z(0, 0, 1), across = z.cross(em), far = 0.5 * em;
  auto const shaft = [&](Vec3 const& at) {
    return model.add(Rigid<>(1.0, Mat3(5e-4 * Mat3::Identity()), Placement::at(at)));
  };
  auto const in = shaft({0, 0, 0}), out = shaft(far);
  auto const ground = model.ground().at({0, 0, 0});
  model.connect(Pin{Revolute{.axis = e1}}, ground, in.centre());
  model.connect(Pin{Revolute{.axis = e2}}, model.ground().at(far), out.centre());
  auto const drive = model.connect(Drive{{.law = {{.value = 20.0}}, .axis = e1}}, ground, in.centre());
  model.apply(PointMoment<>{.moment = -9.0 * e2}, out.centre());
  BodyHandle<Rigid<>> middle;
  ElementHandle<Cardan> first;
  for (int b = 0; b < branches; ++b) {
    auto const other = shaft(far);
    middle = shaft({0, 0, 0});
    first = model.connect(Cardan{{.first = z, .second = across}}, in.centre(), middle.centre());
    model.connect(Slide{{.axis = em}}, middle.centre(), other.at(Vec3(-far)));
    model.connect(Cardan{{.first = across, .second = z}}, other.centre(), out.centre());
  }
  State x = model.reference_state();
  assemble(model, x);  // computes the velocities
  double const t = std::numbers::pi / 80;
  simulate(model, x, Radau{}, {.end_time = t, .step = t / 79, .minimum_norm = true}).run();
  auto const compare = [&](char const* what, double right, double ours, double tolerance) {
    answer((name + ": " + what).c_str(), right, ours, tolerance);
  };
  compare("redundant constraint equations", branches - 1, double(redundancy(model, x).rows - redundancy(model, x).rank),
          0.0);
  compare("output speed [rad/s]", 20.0, frame(model, x, out.centre()).w.dot(e2), 1e-6);
  compare("speed of the middle shaft [rad/s]", 19.794866, frame(model, x, middle.centre()).w.dot(em), 1e-6);
  compare("driving torque [N m]", right_torque, reaction(model, x, drive).m[0], 1e-3);
  compare("torque of each branch [N m]", right_torque / branches, reaction(model, x, first).m[0], 1e-3);
}

int main() {
  turn(1, "one branch", 9.111953);
  turn(2, "two branches", 9.223907);
  return wrong_answers();
}
