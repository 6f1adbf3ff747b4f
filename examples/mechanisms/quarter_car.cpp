// Quarter car with bump stops: the frequencies of body and wheel, and a drop onto the stops.
#include <polybody/parts.hpp>
#include <polybody/vibration.hpp>

#include "mechanism.hpp"
using namespace polybody;

int main() {
  using Guide = Joint<planar::Prismatic, Constraint>;
  using Spring = SpringDamper;
  using Stop = EndStop;
  double const body_mass = 300.0, wheel_mass = 40.0, suspension = 2e4, tyre = 1.8e5;
  Model<Bodies<planar::Rigid>, Joints<Guide>, Forces<Spring, Stop>> model;
  auto const ground = model.ground();
  auto const wheel = model.add(planar::Rigid(wheel_mass, 1.0, Placement::planar(0, 0.3)), "wheel");
  auto const body = model.add(planar::Rigid(body_mass, 10.0, Placement::planar(0, 0.8)), "body");
  model.connect(Guide{{.axis = {0, 1, 0}}}, ground.at({0, 0, 0}), wheel.centre(), "guide of the wheel");
  model.connect(Guide{{.axis = {0, 1, 0}}}, ground.at({0, 0, 0}), body.centre(), "guide of the body");
  model.apply(Spring{.stiffness = tyre, .free_length = 0.3}, ground.at({0, 0, 0}), wheel.centre(), "tyre");
  model.apply(Spring{.stiffness = suspension, .free_length = 0.5}, wheel.centre(), body.centre(), "suspension");
  model.apply(Stop{{.lower = 0.42, .upper = 0.58, .stiffness = 2e5, .damping = 2e3, .onset = 0.01}}, wheel.centre(),
              body.centre(), "stops");

  State x = model.reference_state();
  Modes const found = modes(model, x, 2);
  model.set_velocity(x, body, {0, -1.0, 0}, {0, 0, 0});
  Figure figure{.title = "Distance of body and wheel", .x_label = "t [s]", .y_label = "distance [m]", .legend = false};
  figure.curves.push_back({});
  for (auto const& now : simulate(model, x, GeneralisedAlpha{}, {.end_time = 2.0, .step = 1e-3}))
    figure.curves[0].x.push_back(now.t),
        figure.curves[0].y.push_back((now.position(body.centre()) - now.position(wheel.centre()))[1]);
  std::filesystem::create_directories("out/mechanisms");
  write_figure(figure, "out/mechanisms/quarter_car");
  // ω⁴ − (k_s/m_b + (k_s + k_t)/m_w) ω² + k_s k_t/(m_b m_w) = 0.
  double const sum = suspension / body_mass + (suspension + tyre) / wheel_mass,
               product = suspension * tyre / (body_mass * wheel_mass);
  double const slow = std::sqrt(0.5 * (sum - std::sqrt(sum * sum - 4.0 * product)));
  return mechanism::compare("frequency of the body [rad/s]", found.frequency[0], slow, 1e-6);
}
