#pragma once
#include <polybody/joints/joint_motion.hpp>
#include <polybody/joints/policies/policy.hpp>

namespace polybody {

/// Ways to solve the equations of joint coordinates, v = T u, v̇ = T u̇ + Ṫ u, that all give the same motion.
namespace joint_coordinates {
/// The sparse augmented system [M, Gᵀ; G, 0] of all bodies, whose solution is projected on the joints: T u̇ = v̇ − Ṫu
/// [thesis Eq. 3.5]. Linear in the number of bodies with a sparse solver, for trees and loops alike.
struct Augmented {};
/// The dense reduced system TᵀM T u̇ = Tᵀ(f − M Ṫ u) [thesis Eq. 3.4]: for some dozen joints.
struct DenseMatrix {};
/// TᵀM T u̇ = … by elimination body by body from the tips to the roots [Featherstone 1983]: linear in the number of
/// bodies of a tree. Rows beside the tree are added one by one, so few of them.
struct ArticulatedBody {};
}  // namespace joint_coordinates

/// Joint coordinates: body b is carried by body a, its pose is a's pose followed by the motion that the joint leaves
/// free, and the unknowns of a time step are the coordinates of this motion alone. The joint's rows hold by
/// construction; their multipliers and reactions are computed afterwards, as for `Constraint`. Joints form trees from
/// the ground, or from a free body; a joint that closes a loop takes another policy. For rigid bodies [Shabana 2020,
/// §3; thesis §3.3.2].
template <class Path>
struct JointCoordinatesBy {
  static constexpr char const* name = "JointCoordinates";
  static constexpr bool adds_constraints = true;  ///< the joint has rows, whose multipliers are its reactions
  static constexpr bool eliminates = true;        ///< the rows leave the equations: joint coordinates take their place
  using Solution = Path;  ///< a type of namespace `recursive`: how the equations of joint coordinates are solved
};

/// Joint coordinates whose equations are solved in the sparse augmented form, the default.
using JointCoordinates = JointCoordinatesBy<joint_coordinates::Augmented>;

/// A policy that makes joint coordinates.
template <class P>
concept JointCoordinatePolicy = EliminatingPolicy<P> && requires { typename P::Solution; };

}  // namespace polybody
