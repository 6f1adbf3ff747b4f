#pragma once
/// \file
/// What a correction by factors of a matrix near the derivative of a step leaves, found without another pass through
/// the equations.
///
/// With factors F near the derivative K, a correction c leaves E c with E = 1 − F⁻¹K. A probe z = w ∘ ξ, with weights w
/// and independent ξ of variance 1/3, goes through the equations beside the directions, and F⁻¹K z gives E z. The mean
/// of |E z|² is Σ E_ij² w_j²/3 [Hutchinson, Commun. Statist. Simul. 18, 1989]. Where |c_j| ≤ κ w_j for all n unknowns,
/// Cauchy's inequality gives |E c| ≤ κ √(3 n mean |E z|²). One probe stands for the mean. Weights are what unknowns
/// have been of late, so that a probe leaves alone what directions leave alone: a motion in a plane stays in it.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <cmath>
#include <cstdint>

#include <polybody/math/types.hpp>

namespace polybody {

/// What corrections of the changes of a₁ (nv) and λ₁ (rows) leave. Directions are scaled to the size of their
/// parameters.
class CorrectionErrorEstimate {
 public:
  /// Norms of a change.
  struct Parts {
    double a = 0.0;       ///< of accelerations [m/s²], [rad/s²]
    double lambda = 0.0;  ///< of multipliers [N], [N m]
  };

  /// For so many unknowns. \param nv speeds; \param rows of which there are multipliers
  explicit CorrectionErrorEstimate(Index nv = 0, Index rows = 0)
      : nv_(nv), weights_(VecX::Zero(nv + rows)), drawn_(weights_) {}

  /// Another step begins: weights fade.
  void fade() {
    forget();
    weights_ *= 0.9;
  }
  /// Other factors: nothing is known of them.
  void forget() { known_ = false; }
  /// What corrections leave is known.
  bool known() const { return known_; }
  /// A direction has had y (nv + rows) as its changes; `scale` is that of its parameter.
  void add(VecX const& y, double scale) { weights_ = weights_.cwiseMax(scale * y.cwiseAbs()); }
  /// Makes z (nv + rows). Returns false before there are weights.
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
  /// After the pass. \param left (nv + rows) E z
  void measure(VecX const& left) {
    double const by = std::sqrt(3.0 * double(left.size()));
    leaves_ = {by * left.head(nv_).norm(), by * left.tail(left.size() - nv_).norm()};
    known_ = std::isfinite(leaves_.a + leaves_.lambda);
  }
  /// Norms that a correction (nv + rows) leaves at most.
  Parts bound(VecX const& correction) const {
    double const kappa = (correction.array().abs() / drawn_.array()).maxCoeff();
    return {kappa * leaves_.a, kappa * leaves_.lambda};
  }

 private:
  Index nv_ = 0;
  VecX weights_, drawn_;  // as they are, and as they were for z
  Parts leaves_;
  bool known_ = false;
  std::uint64_t random_ = 0;
};

}  // namespace polybody
