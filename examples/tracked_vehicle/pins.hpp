#pragma once
// What the program asks of a formulation of the pins. Each formulation is compiled in a file of its own.
#include <functional>

#include "../tracked_vehicle.hpp"

namespace chapter3 {

struct Options : Settings {
  Options() { step = 0.0; }  // the integrator's own

  std::string track = "constraint", compare, figure, turn, integrator = "alpha";
  double penalty = m113::pin_stiffness;
  double tolerance = 0.0;  // of Newton's corrections, or of the error of a step; 0: the integrator's own
  bool halve = false;
};

inline constexpr double implicit_step = 5e-4;  // [s]

// A formulation of the pins: its run, and what the thesis counts of it, where the ground is a body, too.
struct Pins {
  std::string name;
  std::function<Runs(Options const&)> run;
  std::function<Census(Options const&)> count;
  std::string cannot_turn = {};  // why --turn is refused
};
Pins ideal_pins();
Pins penalty_pins(double stiffness);
Pins bushing_pins(double stiffness);
Pins cable_pins();
Pins joint_coordinates();

}  // namespace chapter3
