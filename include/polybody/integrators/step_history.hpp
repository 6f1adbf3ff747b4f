#pragma once
#include <algorithm>
#include <array>
#include <limits>

#include <polybody/math/errors.hpp>
#include <polybody/system/state.hpp>

namespace polybody {

/// The last five steps of a run: what extrapolation and differences in time need. It stands in `State::memory`,
/// so a copy of a state carries it along:
///   [the method's own nv entries | v̇₋₁ … v̇₋₅ | λ₋₁ … λ₋₅ | h₋₅ … h₋₁ | length for which the state is shifted].
class StepHistory {
  static constexpr int kept = 5;
  static Index size(Index nv, Index rows) { return (kept + 1) * nv + kept * rows + kept + 1; }
  double* a(int back) const { return memory_.data() + back * nv_; }
  double* lambda(int back) const { return memory_.data() + (kept + 1) * nv_ + (back - 1) * rows_; }
  static void copy(double const* from, Index n, double* to) { std::copy(from, from + n, to); }
  double& length(int back) const { return memory_[memory_.size() - 1 - back]; }

  Index nv_, rows_;
  VecX& memory_;

 public:
  /// The history of a state after `reset`. \throws InvalidInput for a state without one.
  explicit StepHistory(State& x) : nv_(x.a.size()), rows_(x.lambda.size()), memory_(x.memory) {
    if (memory_.size() != size(nv_, rows_))
      throw InvalidInput("This state has no memory of a run: call start before step.");
  }

  /// Nothing before x; the method's own entries are v̇.
  static void reset(State& x) {
    Index const nv = x.a.size();
    x.memory.setZero(size(nv, x.lambda.size()));
    copy(x.a.data(), nv, x.memory.data());
  }

  /// The method's own entries into `out` (nv).
  void own(VecX& out) const { copy(memory_.data(), nv_, out.data()); }
  double shifted() const { return memory_[memory_.size() - 1]; }

  /// As if a step h had ended at x and v̇ had changed at the rate `jerk` in it.
  void pretend(State const& x, VecX const& jerk, double h) {
    for (Index i = 0; i < nv_; ++i) a(1)[i] = x.a[i] - h * jerk[i];
    copy(x.lambda.data(), rows_, lambda(1));
    length(1) = h;
  }

  /// Makes x, from which a step h was taken, the last one; `own` are the method's entries after it.
  void push(State const& x, double h, VecX const& own) {
    copy(own.data(), nv_, memory_.data());
    for (int back = kept; back > 1; --back) {
      copy(a(back - 1), nv_, a(back));
      copy(lambda(back - 1), rows_, lambda(back));
      length(back) = length(back - 1);
    }
    copy(x.a.data(), nv_, a(1));
    copy(x.lambda.data(), rows_, lambda(1));
    length(1) = h;
    memory_[memory_.size() - 1] = h;
  }

  /// v̇ and λ at x.t + h, each by the polynomial through as many of the last points as would have foretold its present
  /// value best: many where the motion is smooth, few where what Newton left over would be blown up [Lagrange].
  void extrapolate(State const& x, double h, VecX& vd, VecX& l) const {
    Times t{};
    int known = 1;
    bool const far = h > 2.0 * length(1);  // what was learnt over short steps does not reach that far
    for (; known <= kept && length(known) > 0.0 && !far; ++known)
      t[std::size_t(known)] = t[std::size_t(known - 1)] - length(known);
    extrapolate(t, known, h, x.a, [this](int back) { return a(back); }, vd);
    extrapolate(t, known, h, x.lambda, [this](int back) { return lambda(back); }, l);
  }

  /// v̈ at x, of second order where two steps are known. False where none is.
  bool jerk(State const& x, VecX& out) const {
    double const h1 = length(1), h2 = length(2);
    if (h1 == 0.0) return false;
    for (Index i = 0; i < nv_; ++i) {
      double const last = (x.a[i] - a(1)[i]) / h1;
      out[i] = h2 > 0.0 ? last + h1 / (h1 + h2) * (last - (a(1)[i] - a(2)[i]) / h2) : last;
    }
    return true;
  }

 private:
  using Times = std::array<double, kept + 1>;  ///< before x

  /// Lagrange's weight at time `at` of point i among the points [first, end).
  static double weight(Times const& t, int i, int first, int end, double at) {
    double c = 1.0;
    for (int j = first; j < end; ++j)
      if (j != i) c *= (at - t[std::size_t(j)]) / (t[std::size_t(i)] - t[std::size_t(j)]);
    return c;
  }

  /// From `known` points, `now` the first and `get(i)` the others, into `out`.
  template <class Get>
  static void extrapolate(Times const& t, int known, double h, VecX const& now, Get&& get, VecX& out) {
    int best = 1;
    double least = std::numeric_limits<double>::infinity();
    auto const add = [&](double factor, double const* from) {
      for (Index k = 0; k < out.size(); ++k) out[k] += factor * from[k];
    };
    for (int n = 1; n < known; ++n) {
      out = now;
      for (int i = 1; i <= n; ++i) add(-weight(t, i, 1, n + 1, 0.0), get(i));
      double const error = out.squaredNorm();
      if (error < least) {
        least = error;
        best = n;
      }
    }
    double const first = weight(t, 0, 0, best, h);
    for (Index k = 0; k < out.size(); ++k) out[k] = first * now[k];
    for (int i = 1; i < best; ++i) add(weight(t, i, 0, best, h), get(i));
  }
};

}  // namespace polybody
