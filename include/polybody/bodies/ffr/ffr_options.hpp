#pragma once
/// \file
/// Options of the body of a floating frame, in space and in the plane.
///
/// Not in polybody.hpp: bodies/ffr/ffr.hpp includes it.

#include <polybody/kinematics/frame.hpp>

namespace polybody {

/// Terms of the equations of a floating frame, for the simplifications of thesis §4.3.2 and §4.3.4. A switch that is
/// false omits all of its terms. The letters c, J, H and C are those of ffr.hpp. If only `onto_frame` is false, the
/// mass matrix is not symmetric. The linear solver must then read both triangles, as in `BlockSolver`; `BlockLdlt`
/// and `EigenLdlt` read one.
struct FfrTerms {
  bool coupling = true;  ///< m_rf: C, H in both rows of the mass matrix; and ċ, Ċ q̇, H q̇, H˙ q̇ in the rows of the frame
  bool onto_frame =
      true;  ///< the same terms in the rows of the frame only: if false, the deformation does not act on the frame
  bool deformed_inertia = true;  ///< c and J, J˙ of the deformed body instead of those at q = 0, in inertia and weight
  bool frame_velocities = true;  ///< quadratic-velocity forces 2 Ω × ċ, Ċ q̇, J˙ Ω, Ω × H q̇, H˙ q̇ on the frame; the
                                 ///< other ones are those of a rigid body
  bool coriolis = true;          ///< 2 S̃₁ q̇: Coriolis forces on the deformation
  bool centrifugal = true;       ///< S̃₂ q: centrifugal forces that are linear in the deformation, and their geometric
                                 ///< stiffening if it is selected
  bool spin = true;              ///< Ĩ_o ω̄: centrifugal forces on the undeformed body

  bool operator==(FfrTerms const&) const = default;  ///< compares all switches
  /// First moment c of the body deformed by x, or at q = 0, from the integrals `of` the body.
  template <class T, class Integrals>
  Vec<T, 3> first_moment(Integrals const& of, T const* x) const {
    return deformed_inertia ? of.template first_moment<T>(x) : Vec<T, 3>(of.first.template cast<T>());
  }

  /// Returns true if accelerations of the deformation act on the frame.
  bool couples_to_frame() const { return coupling && onto_frame; }
  /// Returns true if velocities of the deformation act on the frame.
  bool couples_frame_velocity() const { return couples_to_frame() && frame_velocities; }
  bool changes_inertia() const { return deformed_inertia && frame_velocities; }  ///< the mass depends on q
  /// Selected part of ½ (J_p)_q, from its full value `slope` and its value `by` at q = 0.
  template <class T>
  T centrifugal_slope(T const& slope, double by) const {
    return (centrifugal ? slope - by : T(0.0)) + (spin ? by : 0.0);
  }
};

/// Placement of a body, terms of its inertia, stiffening and damping.
struct FfrOptions {
  Placement placement = {};        ///< initial placement of the frame
  FfrTerms terms = {};             ///< selected terms of the inertia
  bool stiffening = false;         ///< geometric stiffening (beams only)
  double stiffness_damping = 0.0;  ///< adds this time [s] × K to the damping
};

}  // namespace polybody
