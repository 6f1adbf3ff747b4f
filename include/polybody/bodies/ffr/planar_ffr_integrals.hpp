#pragma once
/// \file
/// Inertia and stiffness of the body of a planar floating frame as functions of its deformation coordinates.
/// Theory: Eqs. 2.76 to 2.80.

#include <polybody/bodies/ffr/ffr_integrals.hpp>

namespace polybody::planar {

/// Integrals of the body of a planar floating frame with n deformation coordinates q, in the axes of the frame. The
/// points are u = u₀ + S q. Geometric stiffening adds axial foreshortening, which is quadratic in q, to u. With C =
/// ∂c/∂q and the unit normal e of the plane:
///   c = ∫ρ u = first + first_by q − ½ [qᵀ first_second_k q]_k,   J = inertia + inertia_by · q + qᵀ inertia_second q,
///   H = ∫ρ u × ∂u/∂q = coupling + qᵀ coupling_by,
///   T = ½ m ṙ² + ṙᵀA (θ̇ e × c + C q̇) + ½ J θ̇² + θ̇ H q̇ + ½ q̇ᵀ mass_matrix q̇.
struct FfrIntegrals {
  double mass = 0.0;                        ///< [kg]
  Vec2 first = Vec2::Zero();                ///< ∫ρ u₀ [kg m]
  Mat<double, 2, Eigen::Dynamic> first_by;  ///< (2×n) ∫ρ S
  std::array<MatX, 2> first_second;         ///< (n×n) symmetric; empty without geometric stiffening
  double inertia = 0.0;                     ///< about the origin of the frame, at q = 0 [kg m²]
  VecX inertia_by;                          ///< (n) 2 ∫ρ u₀ · S
  MatX inertia_second;                      ///< (n×n) symmetric; ∫ρ SᵀS without stiffening
  VecX coupling;                            ///< (n) ∫ρ u₀ × S
  MatX coupling_by;                      ///< (n×n) ∫ρ (S_xᵀ S_y − S_yᵀ S_x); with stiffening, a symmetric part is added
  MatX mass_matrix, stiffness, damping;  ///< (n×n)
  VecX initial_force;                    ///< (n) ∂U/∂q at q = 0

  Index size() const { return mass_matrix.rows(); }             ///< number n of coordinates of the deformation
  bool stiffens() const { return first_second[0].size() > 0; }  ///< true with geometric stiffening

  /// Integrals that are all zero, for n deformation coordinates.
  template <class = void>  // compiled only if used
  static FfrIntegrals zero(Index n) {
    return of(polybody::FfrIntegrals::zero(n));
  }
  /// Planar integrals of a body in space whose deformation remains in the plane of x and y.
  template <class = void>
  static FfrIntegrals of(polybody::FfrIntegrals const& s) {
    FfrIntegrals x{.mass = s.mass,
                   .first = s.first.head<2>(),
                   .first_by = s.first_by.topRows<2>(),
                   .first_second = {},
                   .inertia = s.inertia(2, 2),
                   .inertia_by = s.inertia_by[2],
                   .inertia_second = s.inertia_second[2],
                   .coupling = s.coupling.row(2).transpose(),
                   .coupling_by = s.coupling_by[2],
                   .mass_matrix = s.mass_matrix,
                   .stiffness = s.stiffness,
                   .damping = s.damping,
                   .initial_force = s.initial_force};
    if (s.stiffens()) x.first_second = {s.first_second[0], s.first_second[1]};
    return x;
  }
  /// Checks the integrals with `polybody::FfrIntegrals::check`, which tests sizes, mass, mass matrix and entries.
  /// \throws InvalidInput naming `what` for integrals that this check refuses, for a `coupling_by` that is not
  /// skew-symmetric without stiffening, and for a moment of inertia that is not positive.
  template <class = void>
  void check(std::string const& what) const {
    polybody::FfrIntegrals x = polybody::FfrIntegrals::zero(size());
    x.mass = mass;
    x.mass_matrix = mass_matrix;
    x.stiffness = stiffness;
    x.damping = damping;
    x.initial_force = initial_force;
    x.first.head<2>() = first;
    (x.first_by.setZero(3, first_by.cols())).topRows<2>() = first_by;
    (x.coupling.setZero(3, coupling.size())).row(2) = coupling.transpose();
    x.inertia_by[2] = inertia_by;
    x.inertia_second[2] = inertia_second;
    x.coupling_by[2] = coupling_by;
    for (std::size_t i = 0; i < 2; ++i) x.first_second[i] = first_second[i];
    x.check(what);
    double largest = 0.0, odd = 0.0;
    for (Index j = 0; j < size(); ++j)
      for (Index i = 0; i < size(); ++i) {
        largest = std::max(largest, std::abs(coupling_by(i, j)));
        odd = std::max(odd, std::abs(coupling_by(i, j) + coupling_by(j, i)));
      }
    if (!stiffens() && odd > 1e-9 * largest)
      throw InvalidInput("ffr.not_skew", {ErrorObject{what},
                                          ": coupling_by, ∫ρ (S_xᵀ S_y − S_yᵀ S_x), must be skew-symmetric without "
                                          "geometric stiffening, but the sum with its transpose has an entry of ",
                                          ErrorValue{odd}, "."});
    require_positive(inertia, what, ": the inertia about the frame's origin");
  }

  /// First moment of the deformed body about the origin of its frame [kg m], and its moment of inertia [kg m²].
  template <class T>
  struct Moments {
    T c[2], J;  ///< c (2) and J
  };
  /// Moments c(q) and J(q) at q = x (n).
  template <class T>
  void moments(T const* x, Moments<T>& out) const {
    out.J = T(inertia);
    for (Index k = 0; k < size(); ++k) out.J += (inertia_slope<T>(x, k) + inertia_by[k]) * 0.5 * x[k];
    for (int i = 0; i < 2; ++i) {
      out.c[i] = T(first[i]);
      for (Index k = 0; k < size(); ++k) out.c[i] += x[k] * first_by(i, k);
      if (stiffens()) out.c[i] -= detail::quadratic<T>(first_second[std::size_t(i)], x, x) * 0.5;
    }
  }
  /// Entry (i, k) of C = ∂c/∂q at q = x.
  template <class T>
  T first_slope(T const* x, int i, Index k) const {
    T sum(first_by(i, k));
    MatX const& m = first_second[std::size_t(i)];
    for (Index j = 0; j < m.rows(); ++j) sum -= x[j] * m(j, k);
    return sum;
  }
  /// Entry k of H at q = x.
  template <class T>
  T coupling_at(T const* x, Index k) const {
    T sum(coupling[k]);
    for (Index j = 0; j < size(); ++j) sum += x[j] * coupling_by(j, k);
    return sum;
  }
  /// Entry k of J_q = ∂J/∂q at q = x.
  template <class T>
  T inertia_slope(T const* x, Index k) const {
    T sum(0.0);
    for (Index j = 0; j < size(); ++j) sum += x[j] * inertia_second(j, k);
    return sum * 2.0 + inertia_by[k];
  }
};

}  // namespace polybody::planar
