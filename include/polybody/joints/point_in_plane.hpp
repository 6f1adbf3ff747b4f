#pragma once
#include <polybody/joints/joint_axis.hpp>

namespace polybody {

/// The point of b stays in the plane through the point of a whose normal is fixed in a. 1 constraint equation
///   g = a₃·d,  d = r_b − r_a      [Haug 1989, §9.4].
/// World::both: in the plane, the normal is a vector in the plane, and the point stays on the line perpendicular to it.
struct PointInPlane {
  static constexpr char const* name = "PointInPlane";
  static constexpr World world = World::both;
  using Equations = EquationList<NoTranslation<2>>;

  JointAxis normal = {};  ///< (3) unit vector, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(normal, "PointInPlane: the normal");
  }
};

}  // namespace polybody
