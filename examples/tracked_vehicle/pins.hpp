#pragma once
// Interface of a formulation of the pins. Each formulation is compiled in a separate file.
#include <functional>

#include "../tracked_vehicle.hpp"

namespace chapter3 {

struct Options : Settings {
  Options() { step = 0.0; }  // the integrator's own

  std::string track = "constraint", compare, figure, turn, integrator = "alpha";
  double penalty = m113::pin_stiffness;
  fs::path viewer, film_file;
  double tolerance = 0.0;  // of Newton's corrections, or of the error of a step; 0: the integrator's own
  bool halve = false;
};

inline constexpr double implicit_step = 5e-4;  // [s]

// A formulation of the pins.
struct Pins {
  std::string name;
  MakeVehicle make;
  double bearable;  // longest step of explicit methods: RungeKutta4's end at 2.8 over the fastest rate, which
                    // `track_times` prints [s]
  std::string cannot_turn = {};  // why --turn is refused

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
