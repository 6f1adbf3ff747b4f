#pragma once
// Runs of the vehicle with the formulations of the pins that the thesis compares, and with any other combination.
#include "../vehicle_links/combinations.hpp"

namespace chapter3 {

struct Options : LinkSettings {
  std::string compare, figure, turn;
  fs::path viewer, film_file;
  bool halve = false;
  std::vector<double> penalties{1e6, 1e7, 1e8, 1e9, 1e10};  // stiffnesses of penalty pins of --compare cost [N/m]
};

// Links on pins with an integrator, as the runs of this program name them.
struct Pins {
  std::string name;
  Combination combination;
  double stiffness = m113::pin_stiffness;  // of pins as penalties or bushings [N/m]

  Runs run(Options const& o) const;
  // Count of coordinates and constraints as in the thesis, in which the ground is a body.
  ProblemSize count(Options const& o) const;
};
// A number as short text, such as "1e7".
std::string compact(double x);
// Rigid links, with the name of the policy of their pins.
Pins ideal_pins(Options const& o);
Pins penalty_pins(Options const& o, double stiffness);
Pins bushing_pins(Options const& o);
Pins joint_coordinate_pins(Options const& o);
// Cables, with their name.
Pins cable_pins(Options const& o);
// The selected combinations.
std::vector<Pins> selected_pins(Options const& o);

}  // namespace chapter3
