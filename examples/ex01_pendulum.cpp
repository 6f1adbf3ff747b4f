// First program: a rod on a pin. Prints time [s], energy drift [J] and constraint violation of the pin [m] at the end.
#include <iostream>
#include <polybody/polybody.hpp>
using namespace polybody;

int main() {
  using Rod = Rigid<>;                                            // body formulation
  auto hinge = Joint{Revolute{.axis = {0, 1, 0}}, Constraint{}};  // joint: geometry, policy
  auto stepper = GeneralisedAlpha{.rho_inf = 0.8};                // integrator

  Bar const bar{.length = 1.0, .section = Circle{.radius = 0.01}, .material = Material{.density = 7800, .young = 2e11}};
  Model<Bodies<Rod>, Joints<decltype(hinge)>> model{Gravity{0, 0, -9.81}};
  auto const rod = model.add(Rod::from(bar), "rod");
  auto const pin = model.connect(hinge, model.ground().at({0, 0, 0}), rod.at(0.0), "pin");
  State x = model.reference_state();
  for (auto const& now : simulate(model, x, stepper, {.end_time = 2.0, .step = 1e-3}))
    if (now.t >= 2.0)
      std::cout << now.t << ' ' << now.energy().total() << ' ' << now.constraint_violation(pin).norm() << '\n';
  bool const good = std::abs(energy(model, x).total()) < 1e-3 && constraint_violation(model, x, pin).norm() < 1e-9;
  return good ? 0 : 1;
}
