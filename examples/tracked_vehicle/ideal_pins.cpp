#include "pins_by.hpp"

chapter3::Pins chapter3::ideal_pins() { return pins_by<Rigid<>>("constraint", Constraint{}, 1e-4); }
