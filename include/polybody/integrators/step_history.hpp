#pragma once
#include <array>

#include <polybody/math/errors.hpp>
#include <polybody/system/state.hpp>

namespace polybody {

/// The last three steps of a run: what extrapolation and differences in time need. It stands in `State::memory`,
/// so a copy of a state carries it along:
///   [the method's own nv entries | v̇₋₁ … v̇₋₃ | λ₋₁ … λ₋₃ | h₋₃ … h₋₁ | length for which the state is shifted].
class StepHistory {
  static constexpr int kept = 3;
  static Index size(Index nv, Index rows) { return (kept + 1) * nv + kept * rows + kept + 1; }
  auto a(int back) const { return memory_.segment(back * nv_, nv_); }
  auto lambda(int back) const { return memory_.segment((kept + 1) * nv_ + (back - 1) * rows_, rows_); }
  double& length(int back) const { return memory_[memory_.size() - 1 - back]; }

  Index nv_, rows_;
  VecX& memory_;

 public:
  /// Of a state after `reset`. \throws InvalidInput for another.
  explicit StepHistory(State& x) : nv_(x.a.size()), rows_(x.lambda.size()), memory_(x.memory) {
    if (memory_.size() != size(nv_, rows_))
      throw InvalidInput("This state has no memory of a run: call start before step.");
  }

  /// Nothing before x; the method's own entries are v̇.
  static void reset(State& x) {
    Index const nv = x.a.size();
    x.memory.setZero(size(nv, x.lambda.size()));
    x.memory.head(nv) = x.a;
  }

  auto own() const { return memory_.head(nv_); }
  double shifted() const { return memory_[memory_.size() - 1]; }

  /// As if a step h had ended at x and v̇ had changed at the rate `jerk` in it.
  void pretend(State const& x, VecX const& jerk, double h) {
    a(1) = x.a - h * jerk;
    lambda(1) = x.lambda;
    length(1) = h;
  }

  /// Makes x, from which a step h was taken, the last one; `own` are the method's entries after it.
  void push(State const& x, double h, VecX const& own) {
    memory_.head(nv_) = own;
    for (int back = kept; back > 1; --back) {
      a(back) = a(back - 1);
      lambda(back) = lambda(back - 1);
      length(back) = length(back - 1);
    }
    a(1) = x.a;
    lambda(1) = x.lambda;
    length(1) = h;
    memory_[memory_.size() - 1] = h;
  }

  /// v̇ and λ at x.t + h by the polynomial through all that is known [Lagrange]; of order four after three steps.
  void extrapolate(State const& x, double h, VecX& vd, VecX& l) const {
    std::array<double, kept + 1> t{};  // times before x
    int n = 1;
    for (; n <= kept && length(n) > 0.0; ++n) t[std::size_t(n)] = t[std::size_t(n - 1)] - length(n);
    for (int i = 0; i < n; ++i) {
      double c = 1.0;
      for (int j = 0; j < n; ++j)
        if (j != i) c *= (h - t[std::size_t(j)]) / (t[std::size_t(i)] - t[std::size_t(j)]);
      if (i == 0) {
        vd = c * x.a;
        l = c * x.lambda;
      } else {
        vd += c * a(i);
        l += c * lambda(i);
      }
    }
  }

  /// v̈ at x, of second order where two steps are known. False where none is.
  bool jerk(State const& x, VecX& out) const {
    double const h1 = length(1), h2 = length(2);
    if (h1 == 0.0) return false;
    out = (x.a - a(1)) / h1;
    if (h2 > 0.0) out += h1 / (h1 + h2) * ((x.a - a(1)) / h1 - (a(1) - a(2)) / h2);
    return true;
  }
};

}  // namespace polybody
