#include "pins_by.hpp"

chapter3::Pins chapter3::cable_pins() { return pins_by<AncfCable<>>("ancf", AncfLinear{}, 1e-6); }
