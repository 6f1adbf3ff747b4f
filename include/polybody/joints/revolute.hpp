#pragma once
#include <polybody/joints/joint_axis.hpp>

namespace polybody {

/// Revolute joint in space: two points coincide and the axis stays parallel. 5 constraint equations
///   g = [r_b − r_a; a₁·b₃; a₂·b₃]   [thesis §3.5.1, the special case of the spherical joint].
/// The second marker needs only an axis. A cable, whose markers have only a tangent, can be the second body if the
/// joint axis is along the tangent (a clamp).
struct Revolute {
  static constexpr char const* name = "Revolute";
  static constexpr World world = World::space;
  using Equations = EquationList<Coincident, Perpendicular<0, 2>, Perpendicular<1, 2>>;

  JointAxis axis = {};  ///< (3) unit vector of the joint axis, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(axis, "Revolute: the axis");
  }
};

}  // namespace polybody
