#pragma once
/// \file
/// Linear elastic section of a geometrically exact beam: stiffness, damping and pretension.
/// Theory: Eqs. 2.56, 2.57, 2.62, 2.108.

#include <polybody/bodies/shared/bar.hpp>

namespace polybody {

/// Stiffness, damping and pretension of a section with the strains (Γ, K).
class RodSection {
 public:
  /// Section for elements of arc length `l`, with the diagonals of the stiffness and of the damping of `section`.
  template <class T = double>  // compiled only if used
  RodSection(detail::CentredSection const& section, T l, double pretension) : l_(l), pretension_(pretension) {
    for (int i = 0; i < 6; ++i) {
      stiffness_[i] = section.stiffness(i, i);
      time_[i] = section.damping(i, i) / stiffness_[i];
      damped_ = damped_ || time_[i] != 0.0;
    }
  }

  bool damped() const { return damped_; }  ///< true if a damping time is not zero
  /// Section forces (N, M) for the strains (Γ, K), without damping [N], [N m].
  template <class T = double>  // compiled only if used
  Vec<T, 6> forces(Vec<T, 6> const& strains) const {
    Vec<T, 6> n = strains;
    for (int i = 0; i < 6; ++i) n[i] *= stiffness_[i];
    n[0] += pretension_;
    return n;
  }
  /// Strain energy per length for the strains (Γ, K) [J/m].
  template <class T = double>  // compiled only if used
  T energy(Vec<T, 6> const& strains) const {
    T sum = 0.0;
    for (int i = 0; i < 6; ++i) sum += strains[i] * stiffness_[i] * strains[i];
    return 0.5 * sum + pretension_ * strains[0];
  }

 protected:
  double l_;           ///< arc length of an element [m]
  double pretension_;  ///< axial force in the reference configuration [N]
  Vec6 stiffness_;     ///< EA, GA, GA_z, GJ, EI_y, EI
  Vec6 time_;          ///< damping times [s]
  bool damped_ = false;
};

}  // namespace polybody
