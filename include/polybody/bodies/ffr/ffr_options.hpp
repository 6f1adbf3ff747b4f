#pragma once
/// \file
/// Choices of a floating frame's body, in space and in the plane.
///
/// Not in polybody.hpp: it comes with bodies/ffr/ffr.hpp.

#include <polybody/kinematics/frame.hpp>

namespace polybody {

/// The simplifications of thesis §4.3.2 and §4.3.4 one by one: each switch that is false leaves out all of its terms.
/// With c, J, H and C as in ffr.hpp. Without `onto_frame` alone the mass matrix is not symmetric: take a linear solver
/// that reads both halves (`BlockSolver` does, `BlockLdlt` and `EigenLdlt` do not).
struct FfrTerms {
  bool coupling = true;  ///< m_rf: C, H in both rows of the mass matrix; and ċ, Ċ q̇, H q̇, H˙ q̇ as of the frame's rows
  bool onto_frame =
      true;  ///< the same in the rows of the frame alone: false lets the frame move the deformation one way
  bool deformed_inertia = true;  ///< c and J, J˙ of the deformed body, not those of q = 0, in inertia and weight
  bool frame_velocities = true;  ///< of the frame's quadratic-velocity forces 2 Ω × ċ, Ċ q̇, J˙ Ω, Ω × H q̇, H˙ q̇; the
                                 ///< rest are those of a rigid body
  bool coriolis = true;          ///< 2 S̃₁ q̇: Coriolis forces on the deformation
  bool centrifugal = true;       ///< S̃₂ q: centrifugal forces that grow with the deformation; and its stiffening, where
                                 ///< asked for
  bool spin = true;              ///< Ĩ_o ω̄: centrifugal forces on the body as it is without deformation

  bool operator==(FfrTerms const&) const = default;  ///< whether all switches agree
  /// c of the body deformed by x, or at q = 0, from the integrals `of` it.
  template <class T, class Integrals>
  Vec<T, 3> first_moment(Integrals const& of, T const* x) const {
    return deformed_inertia ? of.template first_moment<T>(x) : Vec<T, 3>(of.first.template cast<T>());
  }

  /// What the deformation's mass does to the frame.
  bool pulls_frame() const { return coupling && onto_frame; }
  /// What its speed does to the frame.
  bool pushes_frame() const { return pulls_frame() && frame_velocities; }
  bool changes_inertia() const { return deformed_inertia && frame_velocities; }  ///< the mass depends on q
  /// What is left of ½ (J_p)_q: `slope` as it is, `by` at q = 0.
  template <class T>
  T centrifugal_slope(T const& slope, double by) const {
    return (centrifugal ? slope - by : T(0.0)) + (spin ? by : 0.0);
  }
};

/// How a body is placed and what it accounts for.
struct FfrOptions {
  Placement placement = {};        ///< of the frame at the start
  FfrTerms terms = {};             ///< which terms of the inertia count
  bool stiffening = false;         ///< geometric stiffening (beams only)
  double stiffness_damping = 0.0;  ///< adds this time [s] × K to the damping
};

}  // namespace polybody
