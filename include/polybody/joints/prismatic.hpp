#pragma once
#include <polybody/joints/joint_axis.hpp>

namespace polybody {

/// Prismatic joint in space: b slides along the axis fixed in a without rotation. 5 constraint equations
///   g = [a₁·d; a₂·d; a₁·b₂; a₂·b₃; a₃·b₁],  d = r_b − r_a.
struct Prismatic {
  static constexpr char const* name = "Prismatic";
  static constexpr World world = World::space;
  using Equations =
      EquationList<NoTranslation<0>, NoTranslation<1>, Perpendicular<0, 1>, Perpendicular<1, 2>, Perpendicular<2, 0>>;

  JointAxis axis = {};  ///< (3) unit vector of the translation, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(axis, "Prismatic: the axis");
  }
};

}  // namespace polybody
