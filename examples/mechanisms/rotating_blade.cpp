// Rotating blade: its first flapwise frequency rises with the speed of rotation.
#include <polybody/vibration.hpp>

#include "mechanism.hpp"
using namespace polybody;

int main() {
  using Blade = Lrvf<>;
  using Pin = Joint<Revolute, Constraint>;
  using Drive = Joint<PrescribedAngle<Ramp>, Constraint>;
  using Root = Joint<Weld, Constraint>;
  // Unit length, bending stiffness and mass per length; the other stiffnesses are high.
  Bar const bar{.length = 1.0,
                .constants = BarConstants{
                    .EA = 1e8, .EI = 1.0, .mass_per_length = 1.0, .GA = 1e8, .GJ = 1.0, .rotary_inertia = 1e-8}};
  Figure figure{.title = "First flapwise frequency",
                .x_label = "speed of rotation [rad/s]",
                .y_label = "frequency [rad/s]",
                .legend = false};
  figure.curves.push_back({.width = 2.5});
  double last = 0.0;
  for (int k = 1; k <= 12; ++k) {
    double const speed = 0.5 * k;
    Model<Bodies<Rigid<>, Blade>, Joints<Pin, Drive, Root>> model;
    auto const ground = model.ground().at({0, 0, 0});
    auto const hub = model.add(Rigid<>(1.0, Mat3::Identity()), "hub");
    auto const blade = model.add(Blade::from(bar, {.elements = 24}), "blade");
    model.connect(Pin{{.axis = {0, 0, 1}}}, ground, hub.centre(), "shaft");
    model.connect(Drive{{.law = {.target = speed, .duration = 1.0}, .axis = {0, 0, 1}}}, ground, hub.centre(), "drive");
    model.connect(Root{}, hub.centre(), blade.at(0.0), "root");
    State x = model.reference_state();
    SteadyRotation const rotation{.angular_velocity = Vec3(0, 0, speed)};
    relative_equilibrium(model, x, rotation, {.tolerance = 1e-9});
    last = damped_modes(linearise(model, x, rotation), 2).frequency(1);
    figure.curves[0].x.push_back(speed), figure.curves[0].y.push_back(last);
  }
  std::filesystem::create_directories("out/mechanisms");
  write_figure(figure, "out/mechanisms/rotating_blade");
  // Wright, Smith, Thresher & Wang 1982: 7.3604 for a speed of 6, both in units of √(EI/(ρA l⁴)).
  return mechanism::compare("first flapwise frequency [rad/s]", last, 7.360373, 0.03);
}
