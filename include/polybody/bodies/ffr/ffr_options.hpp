#pragma once
/// \file
/// Options of the body of a floating frame, in space and in the plane.

#include <optional>

#include <polybody/kinematics/frame.hpp>

namespace polybody {

/// Terms of the equations of a floating frame, for the simplifications of thesis §4.3.2 and §4.3.4. A switch that is
/// false omits all of its terms. The letters c, J, H and C are those of ffr.hpp. If only `onto_frame` is false, the
/// mass matrix is not symmetric. The linear solver must then read both triangles. `BlockSolver` reads both triangles,
/// `BlockLdlt` and `EigenLdlt` only one.
struct FfrTerms {
  bool coupling = true;  ///< m_rf: C and H in the mass matrix; ċ, Ċ q̇, H q̇ and H˙ q̇ in the rows of the frame
  bool onto_frame =
      true;  ///< the terms of `coupling` in the rows of the frame; if false, q acts on the frame only by c, J and J˙
  bool deformed_inertia = true;  ///< c and J, J˙ of the deformed body instead of those at q = 0, in inertia and weight
  bool frame_velocities = true;  ///< quadratic-velocity forces 2 Ω × ċ, Ċ q̇, J˙ Ω, Ω × H q̇, H˙ q̇ on the frame; if
                                 ///< false, only those of a rigid body remain
  bool coriolis = true;          ///< 2 S̃₁ q̇: Coriolis forces on the deformation
  bool centrifugal = true;       ///< S̃₂ q: centrifugal forces that are linear in the deformation, and their geometric
                                 ///< stiffening if it is selected
  bool spin = true;              ///< centrifugal forces on the undeformed body, Ĩ_o ω̄ of the thesis

  bool operator==(FfrTerms const&) const = default;  ///< compares all switches
  /// First moment c of the body with the integrals `of`: at q = x if `deformed_inertia`, otherwise at q = 0.
  template <class T, class Integrals>
  Vec<T, 3> first_moment(Integrals const& of, T const* x) const {
    return deformed_inertia ? of.template first_moment<T>(x) : Vec<T, 3>(of.first.template cast<T>());
  }

  /// Returns true if accelerations of the deformation act on the frame.
  bool couples_to_frame() const { return coupling && onto_frame; }
  /// Returns true if ċ, Ċ q̇, H q̇ and H˙ q̇ act on the frame.
  bool couples_frame_velocity() const { return couples_to_frame() && frame_velocities; }
  bool changes_inertia() const { return deformed_inertia && frame_velocities; }  ///< true if J˙ acts on the frame
  /// Selected part of a derivative ∂J_p/∂q_k, from its value `slope` at q and its value `by` at q = 0.
  template <class T>
  T centrifugal_slope(T const& slope, double by) const {
    return (centrifugal ? slope - by : T(0.0)) + (spin ? by : 0.0);
  }
};

/// Frames to which the deformation of a body refers. Each frame follows one rigid motion of the structure, and the
/// deformation is relative to this motion [Shabana 2020, ch. 5; Agrawal & Shabana 1986]. The undeformed body has the
/// same placement in all frames.
enum class FfrFrame {
  mean_axes,         ///< mean motion: momentum and angular momentum of q̇ relative to the frame vanish at q = 0
  clamped,           ///< motion of the first node, whose displacement and rotation vanish
  simply_supported,  ///< origin at the first node, x axis through the last; for a bar along x
};

/// Placement of a body, terms of its inertia, frame, stiffening and damping.
struct FfrOptions {
  Placement placement = {};  ///< initial placement of the frame; a body from a bar has the placement of the bar
  FfrTerms terms = {};       ///< selected terms of the inertia
  /// Frame of the deformation. Default for a body from a bar: `mean_axes`. Default for a body from a structure: the
  /// frame in which its shapes are given; the shapes remain unchanged.
  std::optional<FfrFrame> frame = {};
  /// Geometric stiffening, for beams only. Default: on for a body from a bar, off for a body from a structure.
  std::optional<bool> stiffening = {};
  /// Number of modes of a bar with fixed ends, for a body from a bar only. These modes and the static shapes of the
  /// second end relative to the first (6, in the plane 3) replace the nodal coordinates [Craig & Bampton 1968]. The
  /// resulting basis is suitable for joints at the ends.
  std::optional<Index> modes = {};
  double stiffness_damping = 0.0;  ///< damping time τ [s]; adds τ K to the damping matrix

  /// Completes the options of a body from a bar: sets the placement, and the frame and the stiffening if they have no
  /// value.
  void complete_for(Placement const& bar) {
    placement = bar;
    if (!frame) frame = FfrFrame::mean_axes;
    if (!stiffening) stiffening = true;
  }
};

}  // namespace polybody
