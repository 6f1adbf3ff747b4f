#pragma once
#include <polybody/joints/joint_axis.hpp>

namespace polybody {

/// Planar joint in space: a plane of b slides and rotates on a plane of a. 3 constraint equations
///   g = [a₃·d; a₁·b₃; a₂·b₃],  d = r_b − r_a      [Haug 1989, §9.4].
/// The name is not `Planar`, because namespace `planar` contains the bodies and joints in the plane.
struct PlanarJoint {
  static constexpr char const* name = "PlanarJoint";
  static constexpr World world = World::space;
  using Equations = EquationList<NoTranslation<2>, Perpendicular<0, 2>, Perpendicular<1, 2>>;

  JointAxis normal = {};  ///< (3) unit vector, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(normal, "PlanarJoint: the normal");
  }
};

}  // namespace polybody
