#pragma once
/// \file
/// Anderson's acceleration of depth two [Anderson 1965; Walker & Ni 2011] of iterations x ← x + f(x) that contract,
///   x ← x + s,  s = f − c,  c = γ₁ u₁ + γ₂ u₂,  where γ₁ and γ₂ minimise ‖f − γ₁ d₁ − γ₂ d₂‖,
/// d₁ = f − f₋₁, u₁ = s₋₁ + d₁ = f − c₋₁, and d₂, u₂ are those of the iterate before. Were the map linear, u₁ would be
/// what the iteration leaves of the last step, J s₋₁, and the next correction would be J (f − γ₁ d₁ − γ₂ d₂).

#include <algorithm>
#include <cmath>

#include <polybody/math/vectors.hpp>

namespace polybody {

/// What Anderson's acceleration finds of a correction f.
struct AndersonFit {
  double contraction;  ///< ‖u₁‖/‖s₋₁‖, how the iteration alone shrinks the last step, a ratio
  double left;         ///< ‖f − γ₁ d₁ − γ₂ d₂‖/‖f‖, a ratio, at least 0.1, as no map is linear
};

/// The corrections of an iteration that the next one is combined with.
class AndersonAcceleration {
 public:
  /// Allocates all there is to be. \param n numbers of a correction  \param measured the first of them, whose norm is
  /// minimised
  AndersonAcceleration(Index n, Index measured)
      : measured_(measured), last_(VecX::Zero(n)), c_(last_), d_(last_), u_(last_) {}

  /// The next correction is the first one of its map.
  void forget() { known_ = 0; }
  /// The last step was a combination, so that its correction and the next one tell no rate of contraction.
  bool combined() const { return known_ > 1; }

  /// Fits the correction `f` by the ones before it, at least one.
  AndersonFit fit(VecX const& f) { return known_ > 1 ? fit_by_two(f) : fit_by_one(f); }

  /// f becomes the step, as it was fitted, and is kept for the next fit; the first one of a map stays as it is.
  void combine(VecX& f) {
    if (known_ == 0)
      last_ = f;
    else
      take(f);
    known_ = std::min(known_ + 1, 2);
  }

 private:
  static double share(double fitted, double ff) { return std::sqrt(std::max(0.01, 1.0 - fitted / ff)); }

  /// The last step was its correction: u₁ = f.
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
    bool const apart = det > 0.01 * dd * ee;  // else the two tell the same
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
  int known_ = 0;  // corrections of the map, up to two: so many minus one have a d and a u
  double gamma_ = 0.0, gamma_before_ = 0.0;
  VecX last_, c_, d_, u_;
};

}  // namespace polybody
