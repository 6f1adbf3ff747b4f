#pragma once
/// \file
/// Divided differences of the last steps of a run, stored in the history of a state.

#include <algorithm>
#include <array>

#include <polybody/math/vectors.hpp>
#include <polybody/system/state.hpp>

namespace polybody {

/// Last points of a run, for extrapolation and for differences in time. For v̇ and λ at the ends t₋₁ > t₋₂ > … of
/// earlier steps, the class stores scaled divided differences
///   Dⱼ = f[t₋₁, …, t₋₁₋ⱼ] Πᵢ (t₋₁ − t₋ᵢ), i = 2 … j + 1.
/// Dⱼ is the error of a prediction of f(t₋₁) from the j points before t₋₁. At a further point t₀ the differences are
/// [Krogh 1974; Hairer, Nørsett & Wanner 1993, §III.5]
///   D′₀ = f(t₀),  D′ⱼ₊₁ = D′ⱼ − βⱼ Dⱼ,  β₀ = 1,  βⱼ₊₁ = βⱼ (t₀ − t₋ⱼ₋₁)/(t₋₁ − t₋ⱼ₋₂).
/// The differences are stored in the history of a state, so a copy of the state includes them:
///   [a of the method (nv) | D₀ … D₄ of v̇ | D₀ … D₄ of λ | h₋₅ … h₋₁ | step length `shifted`].
/// Theory: Eqs. 6.11, 6.12.
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
  static constexpr int lengths = kept + 1;  ///< number of step lengths at the end of the memory
  static constexpr int of_velocities = kept + 1, of_multipliers = kept;  ///< numbers of arrays (nv), then (rows)

  /// Access to the history of a state after `reset`. \throws InvalidInput for a state without a history.
  explicit StepHistory(State& x) : nv_(x.a.size()), rows_(x.lambda.size()), memory_(x.history) {
    if (memory_.size() != size(nv_, rows_))
      throw InvalidInput("state.no_history",
                         {"The state has no integrator history. Call method.start(system, x, h, w) before step()."});
  }

  /// Starts a history without points before x. The accelerations a of the method are set to v̇.
  static void reset(State& x) {
    Index const nv = x.a.size();
    x.history.setZero(size(nv, x.lambda.size()));
    copy(x.a.data(), nv, x.history.data());
  }

  /// Copies the accelerations a of the method to `out` (nv).
  void own(VecX& out) const { copy(memory_.data(), nv_, out.data()); }
  /// Step length [s] on which the difference between the method's a and the accelerations of the solution depends; 0
  /// after a start.
  double shifted() const { return memory_[memory_.size() - 1]; }

  /// Replaces the accelerations a of the method by `own`, which are corrected for steps of h [s].
  void shift(VecX const& own, double h) {
    copy(own.data(), nv_, memory_.data());
    memory_[memory_.size() - 1] = h;
  }

  // Parts of the history of a state or of its derivative, which has the same parts.

  /// Accelerations a of the method (nv), in x.
  template <class X>
  static auto own_of(X& x) {
    return x.history.head(x.v.size());
  }
  /// Lengths h₋₅ … h₋₁ of the last steps, then the step length `shifted` [s]; empty if x has no history.
  template <class X>
  static auto lengths_of(X& x) {
    return x.history.tail(std::min<Index>(lengths, x.history.size()));
  }
  /// Step length `shifted` of x [s].
  template <class X>
  static double shifted_of(X const& x) {
    return x.history[x.history.size() - 1];
  }
  /// True if a point before x is known: after a step, and after a start with start correction.
  template <class X>
  static bool has_earlier_point(X const& x) {
    return x.history[x.history.size() - 2] > 0.0;
  }

  // Derivatives of `push` and of `jerk`. A converged step depends on the earlier points only through `jerk`.

  /// Range of indices in the history.
  struct Range {
    Index first, count;  ///< first index; number of indices
  };
  /// Entries on which `jerk` depends: D₀ and D₁ of v̇ (`nv` each).
  static Range points_of_jerk(Index nv) { return {nv, 2 * nv}; }
  /// Entries of a history of `size` entries on which the start correction depends: the lengths of the last two
  /// steps, and `shifted`.
  static Range lengths_of_correction(Index size) { return {size - 3, 3}; }
  /// Appends the derivative dh of a step length to the derivatives `of_lengths` of earlier ones.
  template <class V>
  static void push_length(V& of_lengths, double dh) {
    constexpr Index last = lengths - 1;
    for (Index i = 0; i + 1 < last; ++i) of_lengths[i] = of_lengths[i + 1];
    of_lengths[last - 1] = of_lengths[last] = dh;
  }
  /// Adjoint of the effect of `push` on `jerk`, for a step from `before`. \param bar adjoint variables of the history
  /// after the step, replaced by those before it \param of_a (nv) receives the adjoint variables of v̇ before the step.
  /// Returns the derivative with respect to the length of the step.
  template <class X, class V>
  static double pull_push(X const& before, V& bar, V& of_a) {
    constexpr Index last = lengths - 1;
    Index const nv = of_a.size();
    auto newest = bar.segment(nv, nv), change = bar.segment(2 * nv, nv);
    bool const known = has_earlier_point(before);
    of_a += newest;
    if (known) of_a += change;
    newest = known ? V(-change) : V(V::Zero(nv));
    change.setZero();
    auto of_lengths = bar.tail(lengths);
    double const of_length = of_lengths[last - 1] + of_lengths[last];
    for (Index i = last; i > 0; --i) of_lengths[i] = i < last ? of_lengths[i - 1] : 0.0;
    of_lengths[0] = 0.0;
    return of_length;
  }

  /// Adds a point before x, as if a step of length h had ended at x and v̇ had changed at the rate `jerk` during this
  /// step.
  void pretend(State const& x, VecX const& jerk, double h) {
    for (Index i = 0; i < nv_; ++i) a()[i] = x.a[i] - h * jerk[i];
    copy(x.lambda.data(), rows_, lambda());
    length(1) = h;
  }

  /// Adds x, the start of a step of length h, as the last point. `own` contains the accelerations a of the method after
  /// the step.
  void push(State const& x, double h, VecX const& own) {
    copy(own.data(), nv_, memory_.data());
    Past const past(*this);
    past.push(x.a.data(), nv_, a());
    past.push(x.lambda.data(), rows_, lambda());
    for (int back = kept; back > 1; --back) length(back) = length(back - 1);
    length(1) = h;
    memory_[memory_.size() - 1] = h;
  }

  /// Extrapolates v̇ and λ to x.t + h, into `vd` and `l`. Each polynomial uses the number of points that would have
  /// given the best prediction of the present value: many in smooth motions, few if extrapolation would amplify the
  /// remaining errors of Newton's method.
  void extrapolate(State const& x, double h, VecX& vd, VecX& l) const {
    Past past(*this);
    if (h > 2.0 * length(1)) past.known = 1;  // differences over short steps are not valid for long ones
    past.extrapolate(h, x.a.data(), a(), vd);
    past.extrapolate(h, x.lambda.data(), lambda(), l);
  }

  /// Computes v̈ at x in `out`, of second order if two steps are known. Returns false if no step is known.
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
  /// Factors of the formulas for the points up to x.
  struct Past {
    int known = 1;                       ///< number of points, including x
    std::array<double, kept + 1> age{};  ///< t₀ − t₋ⱼ
    std::array<double, kept> beta{};

    explicit Past(StepHistory const& history) {
      for (; known <= kept && history.length(known) > 0.0; ++known) {
        std::size_t const j = std::size_t(known);
        age[j] = age[j - 1] + history.length(known);
        beta[j - 1] = j == 1 ? 1.0 : beta[j - 2] * age[j - 1] / (age[j] - age[1]);
      }
    }

    /// Updates the differences `d` (n each) for f = `now` (n) at x.
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

    /// Returns the number of points that would have given the best prediction of `now` (n) with the differences d (n
    /// each).
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

    /// f(t₀ + h) = Σ γⱼ D′ⱼ, γ₀ = 1, γⱼ₊₁ = γⱼ (h + t₀ − t₋ⱼ)/(t₀ − t₋ⱼ₋₁), with the best number of points; f(t₀) is
    /// `now`, and `d` contains D.
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
