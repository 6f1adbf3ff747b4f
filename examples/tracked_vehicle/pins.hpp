#pragma once
// Interface of a formulation of the pins. Each formulation is compiled in a separate file.
#include <functional>

#include "../tracked_vehicle.hpp"

namespace chapter3 {

struct Options : Settings {
  Options() { step = 0.0; }  // default step of the integrator

  std::string track = "constraint", compare, figure, turn, integrator = "alpha";
  double penalty = m113::pin_stiffness;
  fs::path viewer, film_file;
  double tolerance = 0.0;  // tolerance of Newton's method or of the error of a step; 0: default
  bool halve = false;
};

inline constexpr double implicit_step = 5e-4;  // [s]

// A formulation of the pins.
struct Pins {
  std::string name;
  MakeVehicle make;
  // Longest stable step of RungeKutta4 [s]: 2.8 divided by the fastest rate, which `track_times` prints.
  double bearable;
  std::string cannot_turn = {};  // reason for which --turn is refused; empty: the vehicle can turn

  Runs run(Options const& o) const;
  // Count of coordinates and constraints as in the thesis, in which the ground is a body.
  ProblemSize count(Options const& o) const;
};
Pins ideal_pins();
Pins penalty_pins(double stiffness);
Pins bushing_pins(double stiffness);
Pins cable_pins();
Pins joint_coordinate_pins();

}  // namespace chapter3
