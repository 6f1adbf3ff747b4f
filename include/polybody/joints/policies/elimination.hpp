#pragma once
/// \file
/// Policies that eliminate unknowns of a step: joint coordinates, and linear joints of ANCF bodies and of
/// `planar::Lrvf`.
/// Theory: Eqs. 5.10 to 5.21.

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
/// is efficient only if they are few. The method supports rigid bodies only.
struct ArticulatedBody {};
}  // namespace joint_coordinates

/// Joint coordinates: the pose of body b is the pose of body a followed by the relative motion of the joint. The
/// unknowns of a time step are the coordinates of this motion alone. These coordinates satisfy the joint's constraint
/// equations exactly; multipliers and reactions are computed afterwards, as for `Constraint`. Joints form trees from
/// the ground, or from a free body; a joint that closes a loop needs another policy. The bodies must be rigid bodies or
/// floating frames (`Ffr`) [Shabana 2020, §3; thesis §3.3.2].
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

/// Linear joint of ANCF bodies and of `planar::Lrvf`. Its equations contain positions and position gradients, which are
/// linear in the coordinates,
///   S_a e_a − S_b e_b = c,
/// with the nodal coordinates e of both bodies, constant matrices S of shape functions and their derivatives, and
/// constants c.
/// Dependent coordinates are eliminated before the run. The mass matrix stays constant, and a time step has no
/// multipliers. Reactions are computed afterwards from the balance of each element [thesis §3.5.4; Shabana, Hamed,
/// Mohamed, Jayakumar & Letherwood 2012]. Both markers belong to these bodies or the ground.
///   Spherical (in the plane Revolute): equal positions r.
///   Revolute about n: equal r and equal gradients r_α, with the material line α along n. Six equations between bodies
///     with all gradients.
///     For a body with r′ alone (a cable), only the components of r′ along n are equal, n fixed in the world: four
///     equations.
///   Weld: equal r; all common gradients keep the relation that they have at the reference configuration.
struct AncfLinear {
  static constexpr char const* name = "AncfLinear";
  static constexpr bool adds_constraints = true;  ///< the multipliers are the reactions of the joint
  /// Constraint equations and dependent coordinates are eliminated together.
  static constexpr bool eliminates = true;
  static constexpr bool linear = true;
};

/// Policy whose constraint equations are linear in the coordinates of two bodies, instead of functions of two frames.
template <class P>
concept LinearPolicy = EliminatingPolicy<P> && requires { requires P::linear; };

/// Geometry that linear equations can express: coincident points, alone or with an equal axis or equal frames.
template <class G>
concept LinearGeometry =
    HasFreeDirections<G> && free_slides(free_directions<G>()) == 0 && free_turns(free_directions<G>()) != 2;

}  // namespace polybody
