#include "pins_by.hpp"

chapter3::Pins chapter3::bushing_pins(double k) { return pins_by<Rigid<>>("bushing", m113::bushing_pin(k), 2.5e-5); }
