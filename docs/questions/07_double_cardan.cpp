// title: Double Cardan joint, once and twice
// thread: https://github.com/OpenModelica/OpenModelica/issues/8365
// wanted: Two Cardan joints and a sliding middle shaft transmit a constant speed. One branch runs. A second, equal
//     branch between the same shafts did not.
// inputs: 20 rad/s, load 9 N m, no gravity. Shafts at 0°, 30° and 60°, Cardan joints at 0 and at 0.5 m along the
//     middle shaft. The middle shaft has two halves of 5e-4 kg m² each.
// right: ω_m = 20 cos β/(1 − sin²β sin² 20t) with β = 30°. Power: the driving torque is 9 + n 1e-3 ω_m ω̇_m/20 with n
//     branches. Two branches have 36 constraint equations, one of them redundant, and a drive.
#include <polybody/polybody.hpp>

#include <numbers>

#include "answer.hpp"
using namespace polybody;

void turn(int branches, double right_torque) {
  using Pin = Joint<Revolute, Constraint>;
  using Cardan = Joint<Universal, Constraint>;
  using Slide = Joint<Prismatic, Constraint>;
  using Drive = Joint<PrescribedRate<Constant>, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Pin, Cardan, Slide, Drive>, Forces<PointMoment<>>> model;
  auto const axis = [](double degrees) { return Vec3(roll_pitch_yaw(0, 0, degrees * std::numbers::pi / 180).col(0)); };
  Vec3 const e1 = axis(0), em = axis(30), e2 = axis(60), z(0, 0, 1), across = z.cross(em), far = 0.5 * em;
  auto const shaft = [&](Vec3 const& place) {
    return model.add(Rigid<>(1.0, Mat3(5e-4 * Mat3::Identity()), Placement::at(place)));
  };
  auto const in = shaft({0, 0, 0}), out = shaft(far);
  model.connect(Pin{Revolute{.axis = e1}}, model.ground().at({0, 0, 0}), in.centre(), "input bearing");
  model.connect(Pin{Revolute{.axis = e2}}, model.ground().at(far), out.centre(), "output bearing");
  auto const drive =
      model.connect(Drive{{.law = {{.value = 20.0}}, .axis = e1}}, model.ground().at({0, 0, 0}), in.centre(), "drive");
  std::vector<ElementHandle<Cardan>> first;
  BodyHandle<Rigid<>> middle;
  for (int b = 0; b < branches; ++b) {
    auto const other = shaft(far);
    middle = shaft({0, 0, 0});
    first.push_back(model.connect(Cardan{{.first = z, .second = across}}, in.centre(), middle.centre()));
    model.connect(Slide{{.axis = em}}, middle.centre(), other.at(Vec3(-far)));
    model.connect(Cardan{{.first = across, .second = z}}, other.centre(), out.centre());
  }
  model.apply(PointMoment<>{.moment = -9.0 * e2}, out.centre(), "load");
  State x = model.reference_state();
  if (branches == 2) answer("rank of 37 constraint equations", 36, double(redundancy(model, x).rank), 0.0);
  assemble(model, x);  // computes the velocities
  double const t = std::numbers::pi / 80;
  simulate(model, x, Radau{}, {.end_time = t, .step = t / 79, .minimum_norm = true}).run();
  std::string const n = branches == 1 ? "one branch: " : "two branches: ";
  auto const speed = [&](auto const& body, Vec3 const& e) { return frame(model, x, body.centre()).w.dot(e); };
  answer((n + "output speed at π/80 s [rad/s]").c_str(), 20.0, speed(out, e2), 1e-6);
  answer((n + "speed of the middle shaft at π/80 s [rad/s]").c_str(), 19.794866, speed(middle, em), 1e-6);
  answer((n + "driving torque at π/80 s [N m]").c_str(), right_torque, reaction(model, x, drive).m[0], 1e-3);
  for (auto const& joint : first)
    if (branches == 2)
      answer("torque of one of two branches [N m]", 0.5 * right_torque, reaction(model, x, joint).m[0], 1e-3);
}

int main() {
  turn(1, 9.111953);
  turn(2, 9.223907);
  return wrong_answers();
}
