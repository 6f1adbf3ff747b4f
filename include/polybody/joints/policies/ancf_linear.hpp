#pragma once
#include <polybody/joints/policies/policy.hpp>

namespace polybody {

/// Linear joint of ANCF bodies. Its equations contain positions and position gradients, which are linear in the
/// coordinates,
///   S_a e_a − S_b e_b = c,
/// with the nodal coordinates e of both bodies, constant matrices S of shape functions and their derivatives, and
/// constants c.
/// Dependent coordinates are eliminated before the run. The mass matrix stays constant, and a time step has no
/// multipliers. Reactions are computed afterwards from the balance of each element [thesis §3.5.4; Shabana, Hamed,
/// Mohamed, Jayakumar & Letherwood 2012]. Both markers belong to ANCF bodies or the ground.
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
