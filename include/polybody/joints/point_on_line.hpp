#pragma once
#include <polybody/joints/joint_axis.hpp>

namespace polybody {

/// The point of b stays on the line through the point of a along the axis fixed in a. 2 constraint equations
///   g = [a₁·d; a₂·d],  d = r_b − r_a      [Haug 1989, §9.4].
struct PointOnLine {
  static constexpr char const* name = "PointOnLine";
  static constexpr World world = World::space;
  using Equations = EquationList<NoTranslation<0>, NoTranslation<1>>;

  JointAxis axis = {};  ///< (3) unit vector of the line, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(axis, "PointOnLine: the axis");
  }
};

}  // namespace polybody
