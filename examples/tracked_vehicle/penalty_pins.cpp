#include "pins_by.hpp"

chapter3::Pins chapter3::penalty_pins(double k) {
  std::string const name = k == m113::pin_stiffness        ? "penalty"
                           : k == m113::soft_pin_stiffness ? "penalty 1e7"
                                                           : "penalty " + number(k);
  return pins_by<Rigid<>>(name, m113::penalty_pin(k), 2.5e-5);
}
