#include "pins_by.hpp"

chapter3::Pins chapter3::joint_coordinate_pins() { return pins_by<Rigid<>>("recursive", JointCoordinates{}, 1e-4); }
