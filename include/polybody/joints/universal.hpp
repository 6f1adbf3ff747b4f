#pragma once
#include <polybody/joints/joint_axis.hpp>
#include <polybody/joints/joint_motion.hpp>

namespace polybody {

/// Universal joint (Cardan joint): two points coincide, and the first axis, fixed in a, stays perpendicular to the
/// second axis, fixed in b. The axes are the arms of the cross. 4 constraint equations
///   g = [r_b − r_a; a₁·b₃]      [Haug 1989, §9.4].
struct Universal {
  static constexpr char const* name = "Universal";
  static constexpr World world = World::space;
  using Equations = EquationList<Coincident, Perpendicular<0, 2>>;

  JointAxis first = {};   ///< (3) unit vector a₁, world axes at the reference configuration
  JointAxis second = {};  ///< (3) unit vector b₃, perpendicular to `first`

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_of(first.required("Universal: the first axis"),
                                                    second.required("Universal: the second axis"), "Universal");
  }
  /// Rotation about a₁, then about b₃.
  JointMotions motions() const {
    return {.list = {JointMotion{JointMotion::Kind::turn, 0}, JointMotion{JointMotion::Kind::turn, 2}}, .count = 2};
  }
};

}  // namespace polybody
