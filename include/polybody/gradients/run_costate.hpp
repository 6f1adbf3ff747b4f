#pragma once
/// \file
/// What a result of a run changes by where the run stands: with its state, what an integrator remembers, and its time.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/gradients/alpha_step_adjoint.hpp>
#include <polybody/gradients/parameter.hpp>
#include <polybody/gradients/run_sensitivity.hpp>

namespace polybody::detail {

/// The costate of a run under the generalised-α family.
struct RunCostate {
  Costate at;      ///< of the state, with the method's own accelerations
  VecX history;    ///< (history) of what is remembered beside them: points before, lengths of steps
  double t = 0.0;  ///< of the time [J's unit/s]

  explicit RunCostate(State const& x) : at(x), history(VecX::Zero(x.history.size())) {}

  /// What J changes by where the state changes by dx.
  double dot(State const& dx) const { return at.dot(dx) + history.dot(dx.history); }
  /// Without rounding of what y and x have in common.
  double dot(State const& y, State const& x) const {
    Index const nv = at.own.size();
    return at.q.dot(y.q - x.q) + at.v.dot(y.v - x.v) + at.a.dot(y.a - x.a) + at.lambda.dot(y.lambda - x.lambda) +
           at.own.dot(y.history.head(nv) - x.history.head(nv)) + history.dot(y.history - x.history);
  }
  /// Adds another one, times a factor.
  void add(RunCostate const& of, double by) {
    at.q += by * of.at.q;
    at.v += by * of.at.v;
    at.a += by * of.at.a;
    at.lambda += by * of.at.lambda;
    at.own += by * of.at.own;
    history += by * of.history;
    t += by * of.t;
  }
  /// Back over `StepHistory::push` of a step that set out from `before`, after `at` has gone back over it. Returns what
  /// J changes by with the length that was pushed.
  double pull_push(State const& before) {
    constexpr Index last = StepHistory::lengths - 1;
    Index const nv = at.own.size();
    auto newest = history.segment(nv, nv), change = history.segment(2 * nv, nv);
    bool const known = lengths_of(before)[last - 1] > 0.0;  // the point before this one
    at.a += newest;
    if (known) at.a += change;
    newest = known ? VecX(-change) : VecX(VecX::Zero(nv));
    change.setZero();
    auto lengths = history.tail(StepHistory::lengths);
    double const of_length = lengths[last - 1] + lengths[last];
    for (Index i = last; i > 0; --i) lengths[i] = i < last ? lengths[i - 1] : 0.0;
    lengths[0] = 0.0;
    return of_length;
  }
};

/// The derivative of a result of a map from states, x and a length h, where `move` moves these by e times a direction.
/// \param f f(y, length): the result, of a copy; \param e distance of the differences
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

/// Numbers of a part of states.
struct PartOfStates {
  VecX State::* part;
  Index first, count;
  double size;  ///< of the numbers
};
/// The same by the numbers of a part, added to `to` at their places. They are differenced over 1e-4 of their size, or
/// of one where it is zero: wider, what stiff elements do to the jerk of a start is no polynomial of fourth degree, and
/// narrower it rounds.
template <class F>
void add_derivatives_by(PartOfStates const& of, State const& x, double h, F const& f, VecX& to) {
  double const e = 1e-4 * (of.size > 0.0 ? of.size : 1.0);
  for (Index i = of.first; i < of.first + of.count; ++i)
    to[i] += slope_along(x, h, e, [&](State& y, double&, double by) { (y.*of.part)[i] += by; }, f);
}

}  // namespace polybody::detail
