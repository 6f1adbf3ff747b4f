#pragma once
/// \file
/// Inertia force M a and applied force of the body of a floating frame (equations in ffr.hpp). Both use the products in
/// ffr_products.hpp.
///
/// Not in polybody.hpp: bodies/ffr/ffr.hpp includes it.

#include <span>

#include <polybody/bodies/ffr/ffr_options.hpp>
#include <polybody/bodies/ffr/ffr_products.hpp>
#include <polybody/bodies/shared/body.hpp>

namespace polybody {

/// Inertia and forces of the body of a floating frame in one state.
template <class T>
class FfrBalance {
 public:
  /// Balance with `products` evaluated at q.
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
