// title: Box that slides along a floor
// thread: https://github.com/Genesis-Embodied-AI/genesis-world/issues/3115
// words: sliding box, Coulomb friction, tipping, box on plane contact, stopping distance
// wanted: A box on a floor is launched along it. It lifted off by 0.3 m and tumbled.
// inputs: Cube of 0.1 m and 1 kg, μ = 0.5, 6 m/s. The feet are 0.045 m before and behind the centre, 1e5 N/m and
//     30 N s/m each. Regularised friction with a slip speed of 1e-3 m/s.
// right: Uniform deceleration μ g: time v/(μ g), distance v²/(2 μ g). Moments about the centre: a front foot has
//     the load m g/4 (1 + μ h/b) and a rear foot m g/4 (1 − μ h/b), with h = 0.05 m and b = 0.045 m, so no foot
//     lifts off.
#include <polybody/parts.hpp>
#include <polybody/polybody.hpp>

#include "answer.hpp"
using namespace polybody;

int main() {
  using Box = Contact<BoxOnPlane>;
  Model<Bodies<Rigid<>>, Joints<>, Forces<Box>> model{Gravity{0, 0, -9.81}};
  double const side = 0.1, b = 0.045, stiffness = 1e5, mu = 0.5, v = 6.0, weight = 9.81;
  auto const box = model.add(
      Rigid<>(1.0, side * side / 6.0 * Mat3::Identity(), Placement::at({0, 0, 0.5 * side - 0.25 * weight / stiffness})),
      "box");
  auto const floor = model.apply(Box{.geometry = {.size = {side, side, side}, .rounding = 0.5 * side - b},
                                     .normal = {.stiffness = stiffness, .damping = 30.0},
                                     .friction = {.coefficient = mu, .slip_speed = 1e-3}},
                                 box.centre(), model.ground().at({0, 0, 0}), "floor");
  State x = model.reference_state();
  model.set_velocity(x, box, {v, 0, 0}, {0, 0, 0});
  double front = 0.0, rear = 0.0, stop = 0.0, fewest = 4.0;
  for (auto const& now : simulate(model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 1.4, .step = 5e-4})) {
    double const at = now.position(box.centre())[0];
    if (stop == 0.0 && now.frame(box.centre()).v[0] < 2e-3) stop = now.t;
    if (now.t < 0.5 || now.t > 1.0) continue;
    double feet = 0.0;
    front = rear = 0.0;
    now.for_each_contact(floor, [&](TouchingPoint const& p) {
      feet += 1.0;
      (p.place[0] > at ? front : rear) += 0.5 * p.force[2];
    });
    fewest = std::min(fewest, feet);
  }
  double const share = mu * 0.5 * side / b;
  answer("distance [m]", v * v / (2 * mu * 9.81), position(model, x, box.centre())[0], 1e-3);
  answer("time to the stop [s]", v / (mu * 9.81), stop, 2e-3);
  answer("load of a front foot [N]", 0.25 * weight * (1 + share), front, 0.005);
  answer("load of a rear foot [N]", 0.25 * weight * (1 - share), rear, 0.005);
  answer("smallest number of feet on the floor [1]", 4.0, fewest, 0.0);
  return wrong_answers();
}
