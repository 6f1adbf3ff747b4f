#pragma once
// Pins of one formulation. Each file of a formulation compiles one such function.
#include "../any_vehicle.hpp"
#include "integrators.hpp"
#include "pins.hpp"

namespace chapter3 {

template <class Body, class Policy>
Pins pins_by(std::string const& name, Policy const& policy, double bearable) {
  return {name, [=](VehicleParts const& parts) { return any_vehicle(made_vehicle<Body>(policy, parts), by_each); },
          bearable};
}

}  // namespace chapter3
