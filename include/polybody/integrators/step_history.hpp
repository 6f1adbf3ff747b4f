#pragma once
#include <polybody/math/errors.hpp>
#include <polybody/system/state.hpp>

namespace polybody {

/// The last two steps of a run: what extrapolation and differences in time need. It stands in `State::memory`,
/// so a copy of a state carries it along:
///   [the method's own nv entries | v̇₋₁ | v̇₋₂ | λ₋₁ | λ₋₂ | h₋₂, h₋₁ | length for which the state is shifted].
class StepHistory {
  static Index size(Index nv, Index rows) { return 3 * nv + 2 * rows + 3; }
  auto a(int back) const { return memory_.segment(back * nv_, nv_); }
  auto lambda(int back) const { return memory_.segment(3 * nv_ + (back - 1) * rows_, rows_); }
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
    a(2) = a(1);
    lambda(2) = lambda(1);
    length(2) = length(1);
    a(1) = x.a;
    lambda(1) = x.lambda;
    length(1) = h;
    memory_[memory_.size() - 1] = h;
  }

  /// v̇ and λ at x.t + h, of third order in h where two steps are known.
  void extrapolate(State const& x, double h, VecX& vd, VecX& l) const {
    vd = x.a;
    l = x.lambda;
    double const h1 = length(1), h2 = length(2);
    if (h1 == 0.0) return;
    vd += h / h1 * (x.a - a(1));
    l += h / h1 * (x.lambda - lambda(1));
    if (h2 == 0.0) return;
    double const c = h * (h + h1) / (h1 + h2);
    vd += c * ((x.a - a(1)) / h1 - (a(1) - a(2)) / h2);
    l += c * ((x.lambda - lambda(1)) / h1 - (lambda(1) - lambda(2)) / h2);
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
