#pragma once
#include <polybody/joints/constraint_functions.hpp>

namespace polybody {

/// Rigid connection in space: points coincide and axes are parallel. 6 constraint equations
///   g = [r_b − r_a; a₁·b₂; a₂·b₃; a₃·b₁].
struct Weld {
  static constexpr char const* name = "Weld";
  static constexpr World world = World::space;
  using Equations = EquationList<Coincident, Perpendicular<0, 1>, Perpendicular<1, 2>, Perpendicular<2, 0>>;

  Mat3 triad() const { return identity(); }
};

}  // namespace polybody
