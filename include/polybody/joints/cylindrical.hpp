#pragma once
#include <polybody/joints/joint_axis.hpp>

namespace polybody {

/// Cylindrical joint: b rotates about the axis fixed in a and slides along it. 4 constraint equations
///   g = [a₁·d; a₂·d; a₁·b₃; a₂·b₃],  d = r_b − r_a      [Haug 1989, §9.4].
struct Cylindrical {
  static constexpr char const* name = "Cylindrical";
  static constexpr World world = World::space;
  using Equations = EquationList<NoTranslation<0>, NoTranslation<1>, Perpendicular<0, 2>, Perpendicular<1, 2>>;

  JointAxis axis = {};  ///< (3) unit vector of translation and rotation, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(axis, "Cylindrical: the axis");
  }
};

}  // namespace polybody
