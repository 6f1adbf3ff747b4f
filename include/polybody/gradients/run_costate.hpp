#pragma once
/// \file
/// Adjoint variables of a run: derivatives of the objective function with respect to the state, the integrator history
/// and the time.

#include <polybody/gradients/alpha_step_adjoint.hpp>
#include <polybody/gradients/parameter.hpp>
#include <polybody/gradients/run_sensitivity.hpp>

namespace polybody::detail {

/// Adjoint variables of a run with the generalised-α family.
struct RunCostate {
  Costate at;      ///< derivatives with respect to the state and the algorithmic accelerations
  VecX history;    ///< (history) derivatives with respect to the rest of the history: earlier points, step lengths
  double t = 0.0;  ///< derivative with respect to the time [J's unit/s]

  explicit RunCostate(State const& x) : at(x), history(VecX::Zero(x.history.size())) {}

  /// Change of J due to a change dx of the state.
  double dot(State const& dx) const { return at.dot(dx) + history.dot(dx.history); }
  /// Change of J from the state x to the state y, without round-off from their common part.
  double dot(State const& y, State const& x) const {
    return at.q.dot(y.q - x.q) + at.v.dot(y.v - x.v) + at.a.dot(y.a - x.a) + at.lambda.dot(y.lambda - x.lambda) +
           at.own.dot(StepHistory::own_of(y) - StepHistory::own_of(x)) + history.dot(y.history - x.history);
  }
  /// Adds `by` times the adjoint variables `of`.
  void add(RunCostate const& of, double by) {
    at.q += by * of.at.q;
    at.v += by * of.at.v;
    at.a += by * of.at.a;
    at.lambda += by * of.at.lambda;
    at.own += by * of.at.own;
    history += by * of.history;
    t += by * of.t;
  }
  /// Backward sweep over `StepHistory::push` of a step from `before`, after the backward sweep of `at`. Returns the
  /// derivative of J with respect to the step length in the history.
  double pull_push(State const& before) { return StepHistory::pull_push(before, history, at.a); }
};

/// Derivative, along a direction, of a result that depends on a state x and a length h, by differences. `move` adds e
/// times the direction to the state and to the length. \param f f(y, length): the result; it may change the copy y of
/// the state;
/// \param e distance of the differences
template <class Move, class F>
double slope_along(State const& x, double h, double e, Move const& move, F const& f) {
  double sum = 0.0;
  for (std::size_t k = 0; k < FourPoints::places.size(); ++k) {
    State y = x;
    double length = h;
    move(y, length, FourPoints::places[k] * e);
    sum += FourPoints::weights[k] / e * f(y, length);
  }
  return sum;
}

/// Range of entries of a vector of the state.
struct PartOfStates {
  VecX State::* part;
  Index first, count;
  double size;  ///< magnitude of the entries
};
/// Adds the derivatives with respect to each entry of a range to the entries of `to` with the same indices. The
/// distance of the differences is 10⁻⁴ of the magnitude, or 10⁻⁴ if the magnitude is zero. At larger distances, the
/// effect of stiff elements on the jerk at a start is not a polynomial of degree four. At smaller distances, round-off
/// dominates.
template <class F>
void add_derivatives_by(PartOfStates const& of, State const& x, double h, F const& f, VecX& to) {
  double const e = 1e-4 * (of.size > 0.0 ? of.size : 1.0);
  for (Index i = of.first; i < of.first + of.count; ++i)
    to[i] += slope_along(x, h, e, [&](State& y, double&, double by) { (y.*of.part)[i] += by; }, f);
}

}  // namespace polybody::detail
