// Differential of an axle: a wheel is held, so the other one turns twice as fast as the carrier.
#include <polybody/parts.hpp>

#include "mechanism.hpp"
using namespace polybody;

int main() {
  using Pin = Joint<Revolute, Constraint>;
  using Motor = Joint<PrescribedRate<SmoothRamp>, Constraint>;
  using Clamp = Joint<Weld, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Pin, Motor, Clamp>, Forces<Differential>> model;
  auto const ground = model.ground().at({0, 0, 0});
  auto const part = [&](char const* name) { return model.add(Rigid<>(1.0, 0.1 * Mat3::Identity()), name); };
  auto const carrier = part("carrier"), left = part("left wheel"), right = part("right wheel");
  Pin const about_z{{.axis = {0, 0, 1}}};
  model.connect(about_z, ground, carrier.centre(), "bearing of the carrier");
  Motor const motor{{.law = {{.target = 10.0, .duration = 0.5}}, .axis = {0, 0, 1}}};
  model.connect(motor, ground, carrier.centre(), "motor");
  model.connect(Clamp{}, ground, left.centre(), "brake");
  auto const wheel = model.connect(about_z, ground, right.centre(), "bearing of the right wheel");
  Differential const gears{.stiffness = 2e4, .damping = 20.0};
  model.apply(gears, std::tuple(carrier.centre(), left.centre(), right.centre()), "differential");

  State x = model.reference_state();
  Figure figure{
      .title = "Speed of the right wheel", .x_label = "t [s]", .y_label = "angular velocity [rad/s]", .legend = false};
  figure.curves.push_back({});
  for (auto const& now : simulate(model, x, Radau{}, {.end_time = 2.0, .step = 5e-3}))
    figure.curves[0].x.push_back(now.t), figure.curves[0].y.push_back(now.joint_angle_rate(wheel));
  std::filesystem::create_directories("out/mechanisms");
  write_figure(figure, "out/mechanisms/differential");
  return mechanism::compare("speed of the right wheel [rad/s]", joint_angle_rate(model, x, wheel), 20.0, 1e-3);
}
