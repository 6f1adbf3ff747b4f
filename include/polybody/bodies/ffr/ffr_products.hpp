#pragma once
/// \file
/// Matrix products of the equations of a floating frame with coordinates, velocities and accelerations. The matrices
/// are stacked, so that each vector is read once.
///
/// Not in polybody.hpp: bodies/ffr/ffr.hpp includes it.

#include <polybody/bodies/ffr/ffr_integrals.hpp>

namespace polybody {

/// Transposed matrices of `FfrIntegrals`, stacked one below the other, for n deformation coordinates.
struct FfrStack {
  MatX of_coordinates;  ///< (10n×n) 2 inertia_second_p, coupling_by_i, stiffness
  MatX of_velocities;   ///< (4n×n) W_i (equations in ffr.hpp), damping
  MatX of_rates;        ///< (n×n) mass matrix

  /// Stack of the matrices of a body with the integrals `i`.
  template <class = void>  // compiled only if used
  static FfrStack of(FfrIntegrals const& i) {
    Index const n = i.size();
    FfrStack out{MatX(10 * n, n), MatX(4 * n, n), i.mass_matrix.transpose()};
    for (Index p = 0; p < 6; ++p)
      out.of_coordinates.middleRows(p * n, n) = 2.0 * i.inertia_second[std::size_t(p)].transpose();
    for (Index k = 0; k < 3; ++k) {
      MatX const& by = i.coupling_by[std::size_t(k)];
      out.of_coordinates.middleRows((6 + k) * n, n) = by.transpose();
      out.of_velocities.middleRows(k * n, n) = by.transpose() - by;
    }
    out.of_coordinates.bottomRows(n) = i.stiffness.transpose();
    out.of_velocities.bottomRows(n) = i.damping.transpose();
    return out;
  }
};

/// Products of the matrices in one state, stored in a workspace of 15 n numbers.
template <class T>
class FfrProducts {
 public:
  static Index workspace_size(Index n) { return 15 * n; }  ///< number of workspace entries for n coordinates
  /// Products in a `workspace` with workspace_size(n) entries. All three arguments must outlive this object.
  FfrProducts(FfrIntegrals const& integrals, FfrStack const& stack, T* workspace)
      : i_(integrals),
        stack_(stack),
        n_(integrals.size()),
        x_(workspace),
        xd_(workspace + 10 * n_),
        xdd_(workspace + 14 * n_) {}

  void at(T const* coordinates) {
    detail::times(stack_.of_coordinates, coordinates, x_);
  }  ///< products with the `coordinates` q (n)
  void at_velocities(T const* velocities) {
    detail::times(stack_.of_velocities, velocities, xd_);
  }  ///< products with the `velocities` q̇ (n)
  void at_rates(T const* rates) { detail::times(stack_.of_rates, rates, xdd_); }  ///< products with the `rates` q̈ (n)

  /// Derivative ∂J_p/∂q_k, for entry p of J in the order of `symmetric_row` and coordinate k.
  T inertia_slope(std::size_t p, Index k) const { return x_[Index(p) * n_ + k] + i_.inertia_by[p][k]; }
  /// Entry k of H_i for axis i.
  T coupling(Index i, Index k) const { return x_[(6 + i) * n_ + k] + i_.coupling(i, k); }
  T stiffness(Index k) const { return x_[9 * n_ + k]; }  ///< entry k of K q
  /// Entry k of W_i q̇ for axis i.
  T gyroscopic(Index i, Index k) const { return xd_[i * n_ + k]; }
  T damping(Index k) const { return xd_[3 * n_ + k]; }  ///< entry k of D q̇
  T mass(Index k) const { return xdd_[k]; }             ///< entry k of M q̈

 private:
  FfrIntegrals const& i_;
  FfrStack const& stack_;
  Index n_;
  T *x_, *xd_, *xdd_;
};

}  // namespace polybody
