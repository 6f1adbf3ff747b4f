#pragma once
/// \file
/// Anderson acceleration of depth two [Anderson 1965; Walker & Ni 2011] for contracting iterations x ← x + f(x):
///   x ← x + s,  s = f − c,  c = γ₁ u₁ + γ₂ u₂,  where γ₁ and γ₂ minimise ‖f − γ₁ d₁ − γ₂ d₂‖,
/// d₁ = f − f₋₁, u₁ = s₋₁ + d₁ = f − c₋₁, and d₂, u₂ are the d₁, u₁ of the previous iterate. For a linear map x + f(x)
/// with Jacobian J, u₁ is the image J s₋₁ of the last step, and the next correction is J (f − γ₁ d₁ − γ₂ d₂).
/// Theory: Eqs. 7.6, 7.7.

#include <algorithm>
#include <cmath>

#include <polybody/math/vectors.hpp>

namespace polybody {

/// Result of the least-squares fit of a correction f.
struct AndersonFit {
  double contraction;  ///< ‖u₁‖/‖s₋₁‖, contraction rate of the iteration without acceleration [1]
  double left;         ///< relative residual ‖f − γ₁ d₁ − γ₂ d₂‖/‖f‖ [1]; at least 0.1, as maps are not exactly linear
};

/// Stores the previous corrections of an iteration, and combines the next correction with them.
class AndersonAcceleration {
 public:
  /// Allocates all memory. \param n number of entries of a correction \param measured number of leading entries in the
  /// minimised norm
  AndersonAcceleration(Index n, Index measured)
      : measured_(measured), last_(VecX::Zero(n)), c_(last_), d_(last_), u_(last_) {}

  /// Discards the stored corrections: the next correction is the first one of a new map.
  void forget() { known_ = 0; }
  /// True if the last step combines several corrections. The ratio of the next correction to the last one is then not a
  /// contraction rate.
  bool combined() const { return known_ > 1; }

  /// Fits the correction `f` by the stored corrections. At least one must be stored.
  AndersonFit fit(VecX const& f) { return known_ > 1 ? fit_by_two(f) : fit_by_one(f); }

  /// Replaces f by the step with the coefficients of the last `fit`, and stores the original f for the next fit. The
  /// first correction of a map is unchanged.
  void combine(VecX& f) {
    if (known_ == 0)
      last_ = f;
    else
      take(f);
    known_ = std::min(known_ + 1, 2);
  }

 private:
  static double share(double fitted, double ff) { return std::sqrt(std::max(0.01, 1.0 - fitted / ff)); }

  /// Fit with one stored correction. The last step s₋₁ is that correction, so that c₋₁ = 0 and u₁ = f.
  AndersonFit fit_by_one(VecX const& f) {
    SimdSum ff, fd, dd, ss;
    for_each_simd_block(measured_, [&, now = f.data(), last = last_.data()](auto at) {
      auto const fi = at(now), s = at(last), d = fi - s;
      ff.add(fi * fi), fd.add(fi * d), dd.add(d * d), ss.add(s * s);
    });
    gamma_ = dd.total() > 0.0 ? fd.total() / dd.total() : 0.0;
    gamma_before_ = 0.0;
    return {std::sqrt(ff.total() / ss.total()), share(gamma_ * fd.total(), ff.total())};
  }
  AndersonFit fit_by_two(VecX const& f) {
    SimdSum sum_ff, sum_fd, sum_dd, sum_ss, sum_uu, sum_fe, sum_de, sum_ee;
    for_each_simd_block(
        measured_, [&, now = f.data(), last = last_.data(), c = c_.data(), before = d_.data()](auto at) {
          auto const fi = at(now), l = at(last), ci = at(c), e = at(before), d = fi - l, s = l - ci, u = fi - ci;
          sum_ff.add(fi * fi), sum_fd.add(fi * d), sum_dd.add(d * d), sum_ss.add(s * s), sum_uu.add(u * u);
          sum_fe.add(fi * e), sum_de.add(d * e), sum_ee.add(e * e);
        });
    double const fd = sum_fd.total(), dd = sum_dd.total(), fe = sum_fe.total(), de = sum_de.total(),
                 ee = sum_ee.total(), det = dd * ee - de * de;
    bool const apart = det > 0.01 * dd * ee;  // false if d₁ and d₂ are nearly parallel
    gamma_ = apart ? (fd * ee - fe * de) / det : dd > 0.0 ? fd / dd : 0.0;
    gamma_before_ = apart ? (fe * dd - fd * de) / det : 0.0;
    return {std::sqrt(sum_uu.total() / sum_ss.total()), share(gamma_ * fd + gamma_before_ * fe, sum_ff.total())};
  }
  void take(VecX& f) {
    double *const now = f.data(), *const last = last_.data(), *const c = c_.data(), *const d = d_.data(),
                  *const u = u_.data();
    double const g = gamma_, before = gamma_before_;
    if (known_ == 1)
      for_each_simd_block(f.size(), [=](auto at) {
        auto const fi = at(now), ci = g * fi;
        at.set(d, fi - at(last)), at.set(u, fi), at.set(c, ci), at.set(last, fi), at.set(now, fi - ci);
      });
    else
      for_each_simd_block(f.size(), [=](auto at) {
        auto const fi = at(now), ui = fi - at(c), ci = g * ui + before * at(u);
        at.set(d, fi - at(last)), at.set(u, ui), at.set(c, ci), at.set(last, fi), at.set(now, fi - ci);
      });
  }

  Index measured_;
  int known_ = 0;  // number of stored corrections, at most two; the first one has no d₁ and u₁
  double gamma_ = 0.0, gamma_before_ = 0.0;
  VecX last_, c_, d_, u_;
};

}  // namespace polybody
