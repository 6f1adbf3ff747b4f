// Flexible robot arm whose hub is driven by a PD controller: the tip comes to rest at the wanted angle.
#include "mechanism.hpp"
using namespace polybody;

int main() {
  using Arm = planar::Lrvf;
  using Pin = Joint<planar::Revolute, Constraint>;
  using Clamp = Joint<planar::Weld, Constraint>;
  double const wanted = 1.0;  // [rad]
  auto const controller = user_force<1>([wanted](auto const& frames, double) {
    using std::atan2;
    Wrench<std::decay_t<decltype(frames[0].r[0])>> w;
    auto const angle = atan2(frames[0].A(1, 0), frames[0].A(0, 0));
    w.m[2] = (wanted - angle) * 40.0 - frames[0].w[2] * 8.0;
    return std::array{w};
  });
  Bar const bar{.length = 1.0, .section = Rectangle{.height = 4e-3, .width = 0.03}, .material = Material{.density = 2700, .young = 7e10}, .damping = Damping{.bending = 2e-3}};
  Model<Bodies<Arm, planar::Rigid>, Joints<Pin, Clamp>, Forces<std::decay_t<decltype(controller)>>> model;
  auto const hub = model.add(planar::Rigid(1.0, 0.05), "hub");
  auto const arm = model.add(Arm::from(bar, {.elements = 16}), "arm");
  model.connect(Pin{}, model.ground().at({0, 0, 0}), hub.centre(), "bearing");
  model.connect(Clamp{}, hub.centre(), arm.at(0.0), "clamp");
  model.apply(controller, hub.centre(), "controller");

  State x = model.reference_state();
  mechanism::Picture picture("Flexible arm with a PD controller", 0, 1);
  int step = 0;
  for (auto const& now : simulate(model, x, GeneralisedAlpha{}, {.end_time = 8.0, .step = 2e-3})) {
    if (step++ % 60 != 0 || now.t > 0.8) continue;
    std::vector<Vec3> shape;
    for (int i = 0; i <= 16; ++i) shape.push_back(now.position(arm.at(i / 16.0)));
    picture.line(shape, 0, now.t);
  }
  picture.write("flexible_robot");
  Vec3 const tip = position(model, x, arm.at(1.0));
  return mechanism::compare("final angle of the tip [rad]", std::atan2(tip[1], tip[0]), wanted, 1e-4);
}
