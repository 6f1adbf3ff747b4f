#pragma once
/// \file
/// Joint coordinates: policy for which the relative motion in a joint is the unknown.

#include <polybody/joints/joint_motion.hpp>
#include <polybody/joints/policies/policy.hpp>

namespace polybody {

/// Solution methods for the equations of joint coordinates, v = T u, v̇ = T u̇ + Ṫ u. All methods give the same motion.
namespace joint_coordinates {
/// Sparse augmented system [M, Gᵀ; G, 0] of all bodies. Its solution is projected onto the joint coordinates: T u̇ = v̇
/// − Ṫu [thesis Eq. 3.5]. With a sparse solver the cost is linear in the number of bodies, for trees and loops.
struct Augmented {};
/// Solution of TᵀM T u̇ = … by elimination, body by body from the tips to the root [Featherstone 1983]. The cost is
/// linear in the number of bodies of a tree. Constraint equations outside the tree are added one by one, so the method
/// is efficient only if they are few.
struct ArticulatedBody {};
}  // namespace joint_coordinates

/// Joint coordinates: the pose of body b is the pose of body a followed by the relative motion of the joint. The
/// unknowns of a time step are the coordinates of this motion alone. These coordinates satisfy the joint's constraint
/// equations exactly; multipliers and reactions are computed afterwards, as for `Constraint`. Joints form trees from
/// the ground, or from a free body; a joint that closes a loop needs another policy. The bodies must be rigid [Shabana
/// 2020, §3; thesis §3.3.2].
template <class Path>
struct JointCoordinatesBy {
  static constexpr char const* name = "JointCoordinates";
  static constexpr bool adds_constraints = true;  ///< the multipliers are the reactions of the joint
  static constexpr bool eliminates = true;        ///< joint coordinates replace the constraint equations
  using Solution = Path;                          ///< a type of namespace `joint_coordinates`: the solution method
};

/// Joint coordinates with the sparse augmented system, the default.
using JointCoordinates = JointCoordinatesBy<joint_coordinates::Augmented>;

/// Policy with joint coordinates.
template <class P>
concept JointCoordinatePolicy = EliminatingPolicy<P> && requires { typename P::Solution; };

}  // namespace polybody
