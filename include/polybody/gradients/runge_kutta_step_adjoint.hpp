#pragma once
/// \file
/// The adjoint of a step of an explicit Runge–Kutta method, exactly: the step is walked through in recorded numbers
/// (gradients/runge_kutta_walk.hpp) and taken backwards (gradients/recorded_places.hpp). Nothing is iterated.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/gradients/alpha_step_adjoint.hpp>
#include <polybody/gradients/recorded_places.hpp>
#include <polybody/gradients/runge_kutta_walk.hpp>

namespace polybody {

/// Adjoints of steps of RungeKutta4 or DormandPrince, from the last one to the first. The length of a step stays as it
/// was chosen.
template <class Method, LinearSolver Solver = DefaultSolver>
class RungeKuttaStepAdjoint {
 public:
  /// Adjoints of steps by `method`. The model must outlive it.
  template <class M>
  [[gnu::cold]] RungeKuttaStepAdjoint(M const& model, System& system, Method const& method)
      : places_(model, system), walk_(method) {}

  /// Takes the costate of the state after the step to that of the state before it. Returns what a last correction
  /// changed: zero, for there is none. \param told f(place, μ) for each place where the step solves equations: what the
  /// result changes by with them, its sign changed. \throws LinearSolverSingular at a singular position, NonFinite.
  template <class F>
  double retreat(StepTaken const& step, Costate& x, F&& told) {
    State const& before = step.before;
    numbers_.q0 = before.q;
    numbers_.v0 = before.v;
    numbers_.acceleration[0] = before.a;
    places_.forget();
    walk_(places_.template system<double>(), numbers_, step, [&](EquationPlace<>& at) {
      places_.solve(at);
      return places_.largest_row();
    });
    Recording& recording = places_.recording();
    Recording::On const on(recording);
    set(before.q, recorded_.q0);
    set(before.v, recorded_.v0);
    set(before.a, recorded_.acceleration[0]);
    places_.again();
    walk_(places_.template system<Recorded>(), recorded_, step, [&](EquationPlace<Recorded>& at) {
      places_.solve(at);
      return 0.0;
    });
    recording.clear_slopes(recording.size());
    add(x.q, recorded_.at.q);
    add(x.v, recorded_.at.v);
    add(x.a, recorded_.at.a);
    add(x.lambda, recorded_.at.lambda);
    places_.sweep(told);
    take(recorded_.q0, x.q);
    take(recorded_.v0, x.v);
    take(recorded_.acceleration[0], x.a);
    x.lambda.setZero();
    return 0.0;
  }

 private:
  using Numbers = VecXOf<Recorded>;

  static void set(VecX const& from, Numbers& to) {
    to.resize(from.size());
    for (Index i = 0; i < from.size(); ++i) to[i] = Recorded::variable(from[i]);
  }
  void add(VecX const& slopes, Numbers const& to) {
    for (Index i = 0; i < slopes.size(); ++i) places_.recording().slope(to[i].number) += slopes[i];
  }
  void take(Numbers const& from, VecX& slopes) {
    for (Index i = 0; i < from.size(); ++i) slopes[i] = places_.recording().slope(from[i].number);
  }

  RecordedPlaces<Solver> places_;
  RungeKuttaWalk<Method> walk_;
  RungeKuttaNumbers<Method, double> numbers_;
  RungeKuttaNumbers<Method, Recorded> recorded_;
};

/// Adjoints of runs by RungeKutta4.
template <class Stabilisation>
struct AdjointsOfStages<RungeKutta4<Stabilisation>> {
  using Type = RungeKuttaStepAdjoint<RungeKutta4<Stabilisation>>;  ///< of its steps
};
/// Adjoints of runs by DormandPrince.
template <class Stabilisation>
struct AdjointsOfStages<DormandPrince<Stabilisation>> {
  using Type = RungeKuttaStepAdjoint<DormandPrince<Stabilisation>>;  ///< of its steps
};

}  // namespace polybody
