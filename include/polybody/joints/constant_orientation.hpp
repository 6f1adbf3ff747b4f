#pragma once
#include <polybody/joints/constraint_functions.hpp>

namespace polybody {

/// The axes of b stay parallel to the axes of a; translations are free. 3 constraint equations g = [a₁·b₂; a₂·b₃;
/// a₃·b₁].
struct ConstantOrientation {
  static constexpr char const* name = "ConstantOrientation";
  static constexpr World world = World::space;
  using Equations = EquationList<Perpendicular<0, 1>, Perpendicular<1, 2>, Perpendicular<2, 0>>;

  Mat3 triad() const { return identity(); }
};

}  // namespace polybody
