#pragma once
/// \file
/// Inertia force M a and the other forces of the body of a floating frame (equations in ffr.hpp).
/// Theory: Eqs. 2.85 to 2.88.

#include <span>

#include <polybody/bodies/ffr/ffr_integrals.hpp>
#include <polybody/bodies/ffr/ffr_options.hpp>
#include <polybody/bodies/shared/body.hpp>

namespace polybody {

// Products of matrices with coordinates, velocities and accelerations in the equations of a floating frame. The
// matrices are stacked, so that each vector is read once.

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

/// Products of the matrices of `FfrStack` with q, q̇ and q̈, stored in a workspace of 15 n numbers.
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

/// Inertia and forces of the body of a floating frame in one state.
template <class T>
class FfrBalance {
 public:
  /// Balance with `products` evaluated at q. All arguments must outlive this object.
  FfrBalance(FfrIntegrals const& integrals, FfrTerms const& terms, FfrProducts<T> const& products, std::span<T const> q)
      : of_(integrals),
        terms_(terms),
        products_(products),
        x_(q.data() + 7),
        A_(rotation_matrix<T>(part<4>(q, 3))),
        c_(terms.template first_moment<T>(integrals, x_)) {
    for (std::size_t p = 0; p < 6; ++p) {
      int const a = symmetric_row[p], b = symmetric_column[p];
      T j(of_.inertia(a, b));
      for (Index k = 0; k < of_.size() && terms_.deformed_inertia; ++k)
        j += (products_.inertia_slope(p, k) + of_.inertia_by[p][k]) * 0.5 * x_[k];
      J_(a, b) = J_(b, a) = j;
    }
  }

  void inertia(std::span<T const> a, VecXOf<T>& out) const {
    Vec<T, 3> const ar = part<3>(a, 0), alpha = part<3>(a, 3), along = A_.transpose() * ar;
    T const* const xdd = a.data() + 6;
    Vec<T, 3> push = alpha.cross(c_);
    Vec<T, 3> turn = c_.cross(along) + J_ * alpha;
    for (Index k = 0; k < of_.size(); ++k) {
      T sum = products_.mass(k);
      if (terms_.coupling) {
        Vec<T, 3> const c = of_.template first_slope<T>(x_, k);
        for (int i = 0; i < 3; ++i) {
          T const h = products_.coupling(i, k);
          sum += along[i] * c[i] + alpha[i] * h;
          if (!terms_.onto_frame) continue;
          push[i] += c[i] * xdd[k];
          turn[i] += h * xdd[k];
        }
      }
      out[6 + k] = sum;
    }
    out.template head<3>() = ar * T(of_.mass) + A_ * push;
    out.template segment<3>(3) = turn;
  }
  void force(std::span<T const> v, VecXOf<T>& out) const {
    Vec<T, 3> const omega = part<3>(v, 3);
    T const* const xd = v.data() + 6;
    Index const n = of_.size();
    bool const pushes = terms_.couples_frame_velocity();
    Vec<T, 3> cd = Vec<T, 3>::Zero(), h = cd, cdd = cd, hd = cd;  // ċ, H q̇, Ċ q̇, H˙ q̇
    for (Index k = 0; k < n; ++k) {
      if (pushes) {
        cd += of_.template first_slope<T>(x_, k) * xd[k];
        for (int i = 0; i < 3; ++i) h[i] += products_.coupling(i, k) * xd[k];
      }
      T f = -products_.stiffness(k) - products_.damping(k) - of_.initial_force[k];
      for (int i = 0; i < 3 && terms_.coriolis; ++i) f -= omega[i] * products_.gyroscopic(i, k);
      out[6 + k] = f;
    }
    Mat<T, 3, 3> rate;  // J˙, entry by entry, and ½ (Ωᵀ J Ω)_q
    for (std::size_t p = 0; p < 6; ++p) {
      int const a = symmetric_row[p], b = symmetric_column[p];
      T const product = omega[a] * omega[b] * (a == b ? 0.5 : 1.0);
      T jd(0.0);
      for (Index k = 0; k < n; ++k) {
        T const slope = products_.inertia_slope(p, k);
        double const by = of_.inertia_by[p][k];
        if (terms_.changes_inertia()) jd += slope * xd[k];
        out[6 + k] += product * terms_.centrifugal_slope(slope, by);
      }
      rate(a, b) = rate(b, a) = jd;
    }
    for (std::size_t i = 0; i < 3 && of_.stiffens() && pushes; ++i) {
      cdd[Index(i)] = -detail::quadratic<T>(of_.first_second[i], xd, xd);
      hd[Index(i)] = detail::quadratic<T>(of_.coupling_by[i], xd, xd);
    }
    out.template head<3>() = -(A_ * (omega.cross(omega.cross(c_)) + omega.cross(cd) * T(2.0) + cdd));
    out.template segment<3>(3) = -(rate * omega + omega.cross(J_ * omega + h) + hd);
  }

 private:
  FfrIntegrals const& of_;
  FfrTerms const& terms_;
  FfrProducts<T> const& products_;
  T const* x_;  // coordinates of the deformation
  Mat<T, 3, 3> A_;
  Vec<T, 3> c_;  // first moment; `terms_` selects c and J of the deformed or the undeformed body
  Mat<T, 3, 3> J_;
};

}  // namespace polybody
