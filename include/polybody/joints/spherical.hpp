#pragma once
#include <polybody/joints/constraint_functions.hpp>

namespace polybody {

/// Spherical joint in space: two points coincide. 3 constraint equations in world axes.
struct Spherical {
  static constexpr char const* name = "Spherical";
  static constexpr World world = World::space;
  using Equations = EquationList<Coincident>;

  Mat3 triad() const { return identity(); }
};

}  // namespace polybody
