#pragma once
#include <polybody/joints/policies/policy.hpp>

namespace polybody {

/// Linear joint of ANCF bodies: the geometry is stated in positions and position gradients, which are linear in the
/// coordinates,
///   S_a e_a − S_b e_b = c,
/// so that dependent coordinates leave the equations before the run: the mass matrix stays constant and there is no
/// multiplier; reactions are computed afterwards from the balance of each element [thesis §3.5.4; Shabana,
/// Hamed, Mohamed, Jayakumar & Letherwood 2012]. Both markers belong to ANCF bodies or the ground.
///   Spherical (in the plane Revolute):  r equal.
///   Revolute about n:  r equal and r_α equal, α the material line along n: six equations between bodies with all
///   gradients. A body
///     with r′ alone (a cable) shares the component of its r′ along n instead, n fixed in the world: four equations.
///   Weld:  r and all gradients that both have equal, as they stand to one another in the reference.
struct AncfLinear {
  static constexpr char const* name = "AncfLinear";
  static constexpr bool adds_constraints = true;  ///< the joint has rows, whose multipliers are its reactions
  /// The rows leave the equations together with the coordinates that depend on others.
  static constexpr bool eliminates = true;
  static constexpr bool linear = true;
};

/// A policy whose rows are linear in the coordinates of the two bodies, and belong to them rather than to two frames.
template <class P>
concept LinearPolicy = EliminatingPolicy<P> && requires { requires P::linear; };

/// A geometry that such rows can state: points coincide, and axes or whole frames with them.
template <class G>
concept LinearGeometry = HasFreeDirections<G> && detail::free_slides(G::free) == 0 && detail::free_turns(G::free) != 2;

}  // namespace polybody
