#pragma once
#include <array>

#include <polybody/math/quadrature.hpp>
#include <polybody/system/state.hpp>

namespace polybody {

/// Divided differences D_j = f[t₀, t₋₁, …, t₋ⱼ] of y˙ = f(t, y) over the last points, for y of n entries. They are
/// stored in the history of a state, so a copy of the state includes them:
///   [D₀ … D₁₂ | lengths of the last 12 steps, the last one first | known points | order | 1 while the order rises].
class AdamsHistory {
 public:
  static constexpr int highest = 12;  ///< highest order

  /// Resets `memory` to order 1 and a single point, the present one, with y˙ = f.
  static void reset(VecX& memory, VecX const& f) {
    memory.setZero((highest + 1) * f.size() + highest + 3);
    memory.head(f.size()) = f;
    memory.tail<3>().setOnes();
  }

  /// Access to the history in the `memory` of a state for y of n entries. `reset` must have been called for `memory`.
  /// \throws InvalidInput if `memory` has another size.
  AdamsHistory(VecX& memory, Index n) : memory_(memory), n_(n) {
    if (memory.size() != (highest + 1) * n + highest + 3)
      throw InvalidInput("state.no_history",
                         {"The state has no integrator history. Call method.start(system, x, h, w) before step()."});
  }

  /// D_j (n entries), j ≤ 12.
  double* difference(int j) const { return memory_.data() + j * n_; }
  /// Number of known points including the present one, 1 to 13, stored as a floating-point number.
  double& known() const { return memory_[memory_.size() - 3]; }
  /// Order k of the next step.
  double& order() const { return memory_[memory_.size() - 2]; }
  /// 1 while the order rises after a start, otherwise 0.
  double& rising() const { return memory_[memory_.size() - 1]; }

  /// t₀ − t₋ⱼ [s] for j < `known`, otherwise 0.
  std::array<double, highest + 2> ages() const {
    std::array<double, highest + 2> age{};
    for (int j = 1; j < int(known()); ++j) age[std::size_t(j)] = age[std::size_t(j - 1)] + length(j - 1);
    return age;
  }

  /// Advances by a step h to a point with y˙ = f: D′₀ = f, D′ⱼ₊₁ = (D′ⱼ − Dⱼ)/(h + t₀ − t₋ⱼ).
  void push(double h, VecX const& f) {
    auto const age = ages();
    int const points = int(known());
    for (Index c = 0; c < n_; ++c) {
      double carry = f[c];
      for (int j = 0; j <= std::min(points, highest); ++j) {
        double& d = difference(j)[c];
        double const next = j < points ? (carry - d) / (h + age[std::size_t(j)]) : 0.0;
        d = carry;
        carry = next;
      }
    }
    for (int j = highest - 1; j > 0; --j) length(j) = length(j - 1);
    length(0) = h;
    known() = std::min(points, highest) + 1;
  }

  /// Weights c_j = ∫₀ʰ Π_{i<j} (τ + t₀ − t₋ᵢ) dτ for j ≤ 13, with t₀ − t₋ᵢ from `age` [s]. The seven-point Gauss rule
  /// is exact for degree 13, and all its terms are positive.
  static std::array<double, highest + 2> weights(double h, std::array<double, highest + 2> const& age) {
    std::array<double, highest + 2> c{};
    for (GaussPoint const& p : gauss<7>) {
      double term = p.weight * h;
      for (std::size_t j = 0; j < c.size(); ++j) {
        c[j] += term;
        term *= p.xi * h + age[j];
      }
    }
    return c;
  }

 private:
  double& length(int j) const { return memory_[(highest + 1) * n_ + j]; }

  VecX& memory_;
  Index n_;
};

}  // namespace polybody
