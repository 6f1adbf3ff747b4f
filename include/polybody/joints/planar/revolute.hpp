#pragma once
#include <polybody/joints/constraint_functions.hpp>

namespace polybody::planar {

/// Revolute joint in the plane: two points coincide. 2 constraint equations.
struct Revolute {
  static constexpr char const* name = "planar::Revolute";
  static constexpr World world = World::plane;
  using Equations = EquationList<Coincident>;

  Mat3 triad() const { return identity(); }
};

}  // namespace polybody::planar
