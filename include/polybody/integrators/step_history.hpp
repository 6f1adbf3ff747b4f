#pragma once
#include <algorithm>
#include <array>

#include <polybody/math/vectors.hpp>
#include <polybody/system/state.hpp>

namespace polybody {

/// The last points of a run: what extrapolation and differences in time need. Of v̇ and λ at t₋₁ > t₋₂ > …, the ends
/// of earlier steps, it keeps scaled divided differences
///   Dⱼ = f[t₋₁, …, t₋₁₋ⱼ] Πᵢ (t₋₁ − t₋ᵢ), i = 2 … j + 1:
/// the error with which the j points before t₋₁ predict f(t₋₁). At a further point t₀ they are [Krogh 1974; Hairer,
/// Nørsett & Wanner 1993, §III.5]
///   D′₀ = f(t₀),  D′ⱼ₊₁ = D′ⱼ − βⱼ Dⱼ,  β₀ = 1,  βⱼ₊₁ = βⱼ (t₀ − t₋ⱼ₋₁)/(t₋₁ − t₋ⱼ₋₂).
/// It stands in history, so a copy of a state carries it along:
///   [the method's own nv entries | D₀ … D₄ of v̇ | those of λ | h₋₅ … h₋₁ | length for which the state is shifted].
class StepHistory {
  static constexpr int kept = 5;
  static Index size(Index nv, Index rows) { return (kept + 1) * nv + kept * rows + kept + 1; }
  double* a() const { return memory_.data() + nv_; }
  double* lambda() const { return memory_.data() + (kept + 1) * nv_; }
  static void copy(double const* from, Index n, double* to) { std::copy(from, from + n, to); }
  double& length(int back) const { return memory_[memory_.size() - 1 - back]; }

  Index nv_, rows_;
  VecX& memory_;

 public:
  static constexpr int lengths = kept + 1;  ///< entries at the end of the memory that are lengths of steps

  /// The history of a state after `reset`. \throws InvalidInput for a state without one.
  explicit StepHistory(State& x) : nv_(x.a.size()), rows_(x.lambda.size()), memory_(x.history) {
    if (memory_.size() != size(nv_, rows_))
      throw InvalidInput("state.no_history",
                         {"The state has no integrator history. Call method.start(system, x, h, w) before step()."});
  }

  /// Nothing before x; the method's own entries are v̇.
  static void reset(State& x) {
    Index const nv = x.a.size();
    x.history.setZero(size(nv, x.lambda.size()));
    copy(x.a.data(), nv, x.history.data());
  }

  /// The method's own entries into `out` (nv).
  void own(VecX& out) const { copy(memory_.data(), nv_, out.data()); }
  /// Length of step for which the method's own entries stand off those of the solution [s]; 0 after a start.
  double shifted() const { return memory_[memory_.size() - 1]; }

  /// As if a step h had ended at x and v̇ had changed at the rate `jerk` in it.
  void pretend(State const& x, VecX const& jerk, double h) {
    for (Index i = 0; i < nv_; ++i) a()[i] = x.a[i] - h * jerk[i];
    copy(x.lambda.data(), rows_, lambda());
    length(1) = h;
  }

  /// Makes x, from which a step h was taken, the last one; `own` are the method's entries after it.
  void push(State const& x, double h, VecX const& own) {
    copy(own.data(), nv_, memory_.data());
    Past const past(*this);
    past.push(x.a.data(), nv_, a());
    past.push(x.lambda.data(), rows_, lambda());
    for (int back = kept; back > 1; --back) length(back) = length(back - 1);
    length(1) = h;
    memory_[memory_.size() - 1] = h;
  }

  /// v̇ and λ at x.t + h, to `vd` and l, each by the polynomial through as many of the last points as would have
  /// predicted its present value best: many where the motion is smooth, few where what Newton left over would be blown
  /// up.
  void extrapolate(State const& x, double h, VecX& vd, VecX& l) const {
    Past past(*this);
    if (h > 2.0 * length(1)) past.known = 1;  // what was learnt over short steps does not reach that far
    past.extrapolate(h, x.a.data(), a(), vd);
    past.extrapolate(h, x.lambda.data(), lambda(), l);
  }

  /// v̈ at x, of second order where two steps are known. False where none is.
  bool jerk(State const& x, VecX& out) const {
    double const h1 = length(1), h2 = length(2);
    if (h1 == 0.0) return false;
    double const *last = a(), *change = last + nv_;
    for (Index i = 0; i < nv_; ++i) {
      double const rate = (x.a[i] - last[i]) / h1;
      out[i] = h2 > 0.0 ? rate + h1 / (h1 + h2) * (rate - change[i] / h2) : rate;
    }
    return true;
  }

 private:
  /// The points at x and before, as factors.
  struct Past {
    int known = 1;                       ///< points, with that at x
    std::array<double, kept + 1> age{};  ///< t₀ − t₋ⱼ
    std::array<double, kept> beta{};

    explicit Past(StepHistory const& history) {
      for (; known <= kept && history.length(known) > 0.0; ++known) {
        std::size_t const j = std::size_t(known);
        age[j] = age[j - 1] + history.length(known);
        beta[j - 1] = j == 1 ? 1.0 : beta[j - 2] * age[j - 1] / (age[j] - age[1]);
      }
    }

    /// The differences `d` (n each) at x, where f (n) is `now`.
    void push(double const* now, Index n, double* d) const {
      for_each_simd_block(n, [=, last = std::min(known, kept) - 1, b = beta](auto at) {
        auto next = at(now);
        for (int j = 0; j < last; ++j) {
          auto const before = at(d + j * n);
          at.set(d + j * n, next);
          next -= b[std::size_t(j)] * before;
        }
        at.set(d + last * n, next);
      });
    }

    /// How many points, whose differences are d (n each), would have predicted `now` (n) best.
    int best_order(double const* now, double const* d, Index n) const {
      std::array<SimdSum, kept> errors;
      for_each_simd_block(n, [&](auto at) {
        auto error = at(now);
        for (int j = 0; j + 1 < known; ++j) {
          error -= beta[std::size_t(j)] * at(d + j * n);
          errors[std::size_t(j)].add(error * error);
        }
      });
      int best = 1;
      for (int j = 2; j < known; ++j)
        if (errors[std::size_t(j - 1)].total() < errors[std::size_t(best - 1)].total()) best = j;
      return best;
    }

    /// f(t₀ + h) = Σ γⱼ D′ⱼ, γ₀ = 1, γⱼ₊₁ = γⱼ (h + t₀ − t₋ⱼ)/(t₀ − t₋ⱼ₋₁), by the best number of points; f is `now`, D
    /// are at d.
    void extrapolate(double h, double const* now, double const* d, VecX& out) const {
      Index const n = out.size();
      int const points = best_order(now, d, n);
      std::array<double, kept> gamma{1.0};
      for (std::size_t j = 1; j < std::size_t(points); ++j) gamma[j] = gamma[j - 1] * (h + age[j - 1]) / age[j];
      double* const to = out.data();
      for_each_simd_block(n, [=, b = beta](auto at) {
        auto difference = at(now), sum = difference;
        for (int j = 1; j < points; ++j) {
          difference -= b[std::size_t(j - 1)] * at(d + (j - 1) * n);
          sum += gamma[std::size_t(j)] * difference;
        }
        at.set(to, sum);
      });
    }
  };
};

}  // namespace polybody
