#pragma once
/// \file
/// M a and the force of a floating frame's body (ffr.hpp has the equations), from products that both share.
///
/// Not in polybody.hpp: it comes with bodies/ffr/ffr.hpp.

#include <span>

#include <polybody/bodies/ffr/ffr_options.hpp>
#include <polybody/bodies/ffr/ffr_products.hpp>
#include <polybody/bodies/shared/body.hpp>

namespace polybody {

template <class T>
struct FfrBalance {
  FfrIntegrals const& of;
  FfrTerms const& terms;
  FfrProducts<T> const& products;

  void inertia(std::span<T const> q, std::span<T const> a, VecXOf<T>& out) const {
    Mat<T, 3, 3> const A = rotation_matrix<T>(part<4>(q, 3));
    Vec<T, 3> const ar = part<3>(a, 0), alpha = part<3>(a, 3), along = A.transpose() * ar;
    T const *const x = q.data() + 7, *const xdd = a.data() + 6;
    Vec<T, 3> const center = terms.template first_moment<T>(of, x);
    Vec<T, 3> push = alpha.cross(center);
    Vec<T, 3> turn = center.cross(along) + moments_of_inertia(x) * alpha;
    for (Index k = 0; k < of.size(); ++k) {
      T sum = products.mass(k);
      if (terms.coupling) {
        Vec<T, 3> const c = of.template first_slope<T>(x, k);
        for (int i = 0; i < 3; ++i) {
          T const h = products.coupling(i, k);
          sum += along[i] * c[i] + alpha[i] * h;
          if (!terms.onto_frame) continue;
          push[i] += c[i] * xdd[k];
          turn[i] += h * xdd[k];
        }
      }
      out[6 + k] = sum;
    }
    out.template head<3>() = ar * T(of.mass) + A * push;
    out.template segment<3>(3) = turn;
  }
  void force(std::span<T const> q, std::span<T const> v, VecXOf<T>& out) const {
    Vec<T, 3> const omega = part<3>(v, 3);
    T const *const x = q.data() + 7, *const xd = v.data() + 6;
    Index const n = of.size();
    bool const pushes = terms.pushes_frame();
    Vec<T, 3> cd = Vec<T, 3>::Zero(), h = cd, cdd = cd, hd = cd;  // ċ, H q̇, Ċ q̇, H˙ q̇
    for (Index k = 0; k < n; ++k) {
      if (pushes) {
        cd += of.template first_slope<T>(x, k) * xd[k];
        for (int i = 0; i < 3; ++i) h[i] += products.coupling(i, k) * xd[k];
      }
      T f = -products.stiffness(k) - products.damping(k) - of.initial_force[k];
      for (int i = 0; i < 3 && terms.coriolis; ++i) f -= omega[i] * products.gyroscopic(i, k);
      out[6 + k] = f;
    }
    Mat<T, 3, 3> inertia, rate;  // J, J˙, entry by entry, and ½ (Ωᵀ J Ω)_q
    for (std::size_t p = 0; p < 6; ++p) {
      int const a = symmetric_row[p], b = symmetric_column[p];
      T const product = omega[a] * omega[b] * (a == b ? 0.5 : 1.0);
      T j(of.inertia(a, b)), jd(0.0);
      for (Index k = 0; k < n; ++k) {
        T const slope = products.inertia_slope(p, k);
        double const by = of.inertia_by[p][k];
        if (terms.deformed_inertia) j += (slope + by) * 0.5 * x[k];
        if (terms.changes_inertia()) jd += slope * xd[k];
        out[6 + k] += product * terms.centrifugal_slope(slope, by);
      }
      inertia(a, b) = inertia(b, a) = j;
      rate(a, b) = rate(b, a) = jd;
    }
    for (std::size_t i = 0; i < 3 && of.stiffens() && pushes; ++i) {
      cdd[Index(i)] = -detail::quadratic<T>(of.first_second[i], xd, xd);
      hd[Index(i)] = detail::quadratic<T>(of.coupling_by[i], xd, xd);
    }
    Mat<T, 3, 3> const A = rotation_matrix<T>(part<4>(q, 3));
    Vec<T, 3> const c = terms.template first_moment<T>(of, x);
    out.template head<3>() = -(A * (omega.cross(omega.cross(c)) + omega.cross(cd) * T(2.0) + cdd));
    out.template segment<3>(3) = -(rate * omega + omega.cross(inertia * omega + h) + hd);
  }
  /// J(q) as the terms say.
  Mat<T, 3, 3> moments_of_inertia(T const* x) const {
    Mat<T, 3, 3> J;
    for (std::size_t p = 0; p < 6; ++p) {
      int const a = symmetric_row[p], b = symmetric_column[p];
      T j(of.inertia(a, b));
      for (Index k = 0; k < of.size() && terms.deformed_inertia; ++k)
        j += (products.inertia_slope(p, k) + of.inertia_by[p][k]) * 0.5 * x[k];
      J(a, b) = J(b, a) = j;
    }
    return J;
  }
};

}  // namespace polybody
