#pragma once
/// \file
/// Error estimate of a correction with an approximate factorisation, without another evaluation of the equations.
///
/// With a factorisation F of a matrix close to the derivative K of a step, the error after a correction c is E c, with
/// E = 1 − F⁻¹K. A probe z = w ∘ ξ has weights w and independent ξ of variance 1/3. The probe is evaluated together
/// with the directions of differentiation, and E z = z − F⁻¹K z. The mean of |E z|² is Σ E_ij² w_j²/3 [Hutchinson,
/// Commun. Statist. Simul. 18, 1989]. If |c_j| ≤ κ w_j for all n unknowns, Cauchy's inequality gives |E c| ≤ κ √(3 n
/// mean |E z|²). The value of one probe replaces the mean. The weights are recent sizes of the unknowns, so that a
/// probe hardly changes unknowns that the directions do not change: a planar motion remains planar.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <cmath>
#include <cstdint>

#include <polybody/math/types.hpp>

namespace polybody {

/// Error estimate of corrections to the changes of a₁ (nv) and λ₁ (rows). Directions are scaled to the size of their
/// parameters.
class CorrectionErrorEstimate {
 public:
  /// Norms of the two parts of a change of the unknowns.
  struct Parts {
    double a = 0.0;       ///< norm of the change of accelerations [m/s²], [rad/s²]
    double lambda = 0.0;  ///< norm of the change of multipliers [N], [N m]
  };

  /// \param nv number of generalised velocities; \param rows number of constraint equations with multipliers
  explicit CorrectionErrorEstimate(Index nv = 0, Index rows = 0)
      : nv_(nv), weights_(VecX::Zero(nv + rows)), drawn_(weights_) {}

  /// Begins another step: discards the estimate and reduces the weights by 10 %.
  void fade() {
    forget();
    weights_ *= 0.9;
  }
  /// Discards the estimate after a new factorisation.
  void forget() { known_ = false; }
  /// Returns true if an estimate exists.
  bool known() const { return known_; }
  /// Increases the weights to at least `scale` |y|, with the changes y (nv + rows) in a direction and the size `scale`
  /// of its parameter.
  void add(VecX const& y, double scale) { weights_ = weights_.cwiseMax(scale * y.cwiseAbs()); }
  /// Draws a random probe z (nv + rows). Returns false if all weights are zero.
  bool draw(VecX& z) {
    double const least = 1e-14 * weights_.maxCoeff();
    if (!(least > 0.0)) return false;
    for (Index i = 0; i < z.size(); ++i) {
      random_ = random_ * 6364136223846793005u + 1442695040888963407u;  // [Knuth 1998, §3.3.4]
      drawn_[i] = std::max(weights_[i], least);
      z[i] = drawn_[i] * double(std::int64_t(random_)) * 0x1p-63;
    }
    return true;
  }
  /// Computes the estimate from a probe z. \param left (nv + rows) error E z
  void measure(VecX const& left) {
    double const by = std::sqrt(3.0 * double(left.size()));
    leaves_ = {by * left.head(nv_).norm(), by * left.tail(left.size() - nv_).norm()};
    known_ = std::isfinite(leaves_.a + leaves_.lambda);
  }
  /// Estimated upper bounds of the error norms after a `correction` (nv + rows).
  Parts bound(VecX const& correction) const {
    double const kappa = (correction.array().abs() / drawn_.array()).maxCoeff();
    return {kappa * leaves_.a, kappa * leaves_.lambda};
  }

 private:
  Index nv_ = 0;
  VecX weights_, drawn_;  // present weights, and weights of the last probe
  Parts leaves_;
  bool known_ = false;
  std::uint64_t random_ = 0;
};

}  // namespace polybody
