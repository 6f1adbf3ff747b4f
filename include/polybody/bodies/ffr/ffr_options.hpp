#pragma once
/// \file
/// Choices of a floating frame's body, in space and in the plane.
///
/// Not in polybody.hpp: it comes with bodies/ffr/ffr.hpp.

#include <polybody/kinematics/frame.hpp>

namespace polybody {

/// Parts of the coupling between frame and deformation; leave one out to see what it does.
struct FfrTerms {
  bool coupling = true;  ///< m_rf: the mass between frame and deformation
  bool coriolis = true;  ///< S̃₁: Coriolis forces on the deformation
  bool centrifugal =
      true;  ///< S̃₂: centrifugal forces that grow with the deformation; and its stiffening, where asked for
};

/// How a body is placed and what it accounts for.
struct FfrOptions {
  Placement placement = {};  ///< of the frame at the start
  FfrTerms terms = {};
  bool stiffening = false;         ///< geometric stiffening (beams only)
  double stiffness_damping = 0.0;  ///< adds this time [s] × K to the damping
};

}  // namespace polybody
