#pragma once
#include <polybody/joints/constraint_functions.hpp>

namespace polybody::planar {

/// Rigid connection in the plane: points coincide without relative rotation. 3 constraint equations
///   g = [r_b − r_a; a₂·b₁].
struct Weld {
  static constexpr char const* name = "planar::Weld";
  static constexpr World world = World::plane;
  using Equations = EquationList<Coincident, Perpendicular<1, 0>>;

  Mat3 triad() const { return identity(); }
};

}  // namespace polybody::planar
