#pragma once
/// \file
/// Linear elastic section of a geometrically exact beam: stiffness, damping and pretension.
/// Theory: Eqs. 2.56, 2.57, 2.62, 2.108, 2.121 to 2.124.

#include <polybody/bodies/shared/bar.hpp>
#include <polybody/bodies/shared/node_chain.hpp>
#include <polybody/math/se3.hpp>

namespace polybody {

namespace detail {
/// Product of small matrices.
template <class S, class T, int l, int m, int n>
Mat<T, l, n> small_product(Mat<S, l, m> const& a, Mat<T, m, n> const& b) {
  Mat<T, l, n> out;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < l; ++i) {
      out(i, j) = T(0.0);
      for (int k = 0; k < m; ++k) out(i, j) += a(i, k) * b(k, j);
    }
  return out;
}
}  // namespace detail

/// Stiffness, damping and pretension of a section with the strains (Γ, K) of the line of the centres of mass.
class RodSection {
 public:
  /// `section` for elements of arc length `l` [m]. `pretension` acts in the axis of the bar [N].
  template <class T = double>  // compiled only if used
  RodSection(detail::CentredSection const& section, T l, double pretension)
      : l_(l), pretension_(pretension), centre_(section.centre), matrix_(section.stiffness), damper_(section.damping) {
    coupled_ = centre_[1] != 0.0 || centre_[2] != 0.0;
    for (int i = 0; i < 6; ++i) {
      stiffness_[i] = matrix_(i, i);
      time_[i] = damper_(i, i) / stiffness_[i];
      damped_ = damped_ || time_[i] != 0.0;
      for (int j = 0; j < 6; ++j) coupled_ = coupled_ || (i != j && matrix_(i, j) != 0.0);
    }
  }

  double length() const { return l_; }       ///< arc length of an element [m]
  bool damped() const { return damped_; }    ///< true if a damping time is not zero
  bool coupled() const { return coupled_; }  ///< true if the stiffness matrix is not diagonal, or for an offset

  /// Sets the section forces `n` [N] and `m` [N m] for coupled `strains` and their `rates`, with the pretension.
  template <class T>
  void stress(ScrewVector<T> const& strains, ScrewVector<T> const& rates, Vec<T, 3>& n, Vec<T, 3>& m) const {
    for (int r = 0; r < 6; ++r) {
      T sum = T(preload(r));
      for (int i = 0; i < 3; ++i)
        sum += matrix_(r, i) * strains.translation[i] + matrix_(r, 3 + i) * strains.rotation[i] +
               damper_(r, i) * rates.translation[i] + damper_(r, 3 + i) * rates.rotation[i];
      (r < 3 ? n[r] : m[r - 3]) = sum;
    }
  }
  /// Section forces (N, M) about the axis of the bar for the strains (Γ, K), without damping [N], [N m].
  template <class T = double>  // compiled only if used
  Vec<T, 6> forces(Vec<T, 6> const& strains) const {
    Vec<T, 6> n = strains;
    if (coupled_) {
      n = detail::small_product(matrix_, strains);
      for (int i = 0; i < 6; ++i) n[i] += preload(i);
      return moved<T>(n, 3, 0);
    }
    for (int i = 0; i < 6; ++i) n[i] *= stiffness_[i];
    n[0] += pretension_;
    return n;
  }
  /// Strains Γ + c × K, K of the axis of the bar for `strains` (6) of the line of the centres of mass c.
  template <class T = double>  // compiled only if used
  Vec<T, 6> axis_strains(Vec<T, 6> const& strains) const {
    return coupled_ ? moved<T>(strains, 0, 3) : strains;
  }
  /// Section forces of an energy-conserving step with the secants `strains`, without those of the axis of the bar.
  template <class S>
  Vec6 mean_forces(Vec<S, 6> const& strains, DiscreteDerivative const& means) const {
    Vec6 n;
    for (int i = 0; i < 6; ++i) {
      S const& own = strains[i];
      n[i] = stiffness_[i] * (own.mean() + (means.decay + time_[i] * means.rate) * own.change());
      if (coupled_) n[i] = 0.0;
      for (int j = 0; coupled_ && j < 6; ++j)
        n[i] += matrix_(i, j) * (strains[j].mean() + means.decay * strains[j].change()) +
                damper_(i, j) * means.rate * strains[j].change();
      n[i] += coupled_ ? preload(i) : i == 0 ? pretension_ : 0.0;
    }
    return n;
  }
  /// Strain energy per length for the strains (Γ, K) [J/m].
  template <class T = double>  // compiled only if used
  T energy(Vec<T, 6> const& strains) const {
    T sum = 0.0;
    if (coupled_) {
      Vec<T, 6> const n = detail::small_product(matrix_, strains);
      for (int i = 0; i < 6; ++i) sum += (0.5 * n[i] + preload(i)) * strains[i];
      return sum;
    }
    for (int i = 0; i < 6; ++i) sum += strains[i] * stiffness_[i] * strains[i];
    return 0.5 * sum + pretension_ * strains[0];
  }

 protected:
  /// Sum of the stiffness matrix with the factor `a` and the damping matrix with the factor `b`.
  Mat<double, 6, 6> matrix_sum(double a, double b) const {
    Mat<double, 6, 6> out;
    for (int i = 0; i < 36; ++i) out.data()[i] = a * matrix_.data()[i] + b * damper_.data()[i];
    return out;
  }

  double l_;                           ///< arc length of an element [m]
  double pretension_;                  ///< axial force in the reference configuration [N]
  Vec6 stiffness_;                     ///< EA, GA, GA_z, GJ, EI_y, EI
  Vec6 time_;                          ///< damping times [s]
  Vec3 centre_;                        ///< centre of mass in the section [m]
  Mat<double, 6, 6> matrix_, damper_;  ///< stiffness, and stiffness times damping times
  bool damped_ = false;                ///< true if a damping time is not zero
  bool coupled_ = false;               ///< true if the matrices are used

 private:
  /// Component i of the section forces in the reference configuration, (P, 0, 0) and −c × (P, 0, 0).
  double preload(int i) const {
    return pretension_ * (i == 0 ? 1.0 : i == 4 ? -centre_[2] : i == 5 ? centre_[1] : 0.0);
  }
  /// x with c × (part of x from entry `of`) added to the part from entry `to`.
  template <class T>
  Vec<T, 6> moved(Vec<T, 6> x, int to, int of) const {
    T const a = x[of], b = x[of + 1], c = x[of + 2];
    x[to] += centre_[1] * c - centre_[2] * b;
    x[to + 1] += centre_[2] * a;
    x[to + 2] -= centre_[1] * a;
    return x;
  }
};

}  // namespace polybody
