#pragma once
/// \file
/// The adjoint of a step of an explicit Runge–Kutta method, exactly: the step is walked through in recorded numbers
/// (gradients/runge_kutta_stages.hpp) and taken backwards (gradients/recorded_points.hpp). Nothing is iterated.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/gradients/alpha_step_adjoint.hpp>
#include <polybody/gradients/recorded_points.hpp>
#include <polybody/gradients/runge_kutta_stages.hpp>

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
  /// result changes by with them, its sign changed. \throws SingularMatrix at a singular position, NonFiniteValue.
  template <class F>
  double backward_step(StepTaken const& step, Costate& x, F&& told) {
    State const& before = step.before;
    numbers_.q0 = before.q;
    numbers_.v0 = before.v;
    numbers_.acceleration[0] = before.a;
    places_.forget();
    walk_(places_.template system<double>(), numbers_, before.t, step.h, [&](EvaluationPoint<>& at) {
      places_.solve(at);
      return places_.largest_row();
    });
    Tape& recording = places_.recording();
    Tape::On const on(recording);
    detail::set_variables(before.q, recorded_.q0);
    detail::set_variables(before.v, recorded_.v0);
    detail::set_variables(before.a, recorded_.acceleration[0]);
    places_.again();
    walk_(places_.template system<ReverseVar>(), recorded_, before.t, step.h, [&](EvaluationPoint<ReverseVar>& at) {
      places_.solve(at);
      return 0.0;
    });
    recording.clear_derivatives(recording.size());
    detail::add_to_derivatives(recording, recorded_.at.q, x.q);
    detail::add_to_derivatives(recording, recorded_.at.v, x.v);
    detail::add_to_derivatives(recording, recorded_.at.a, x.a);
    detail::add_to_derivatives(recording, recorded_.at.lambda, x.lambda);
    places_.sweep(told);
    detail::take_derivatives(recording, recorded_.q0, x.q);
    detail::take_derivatives(recording, recorded_.v0, x.v);
    detail::take_derivatives(recording, recorded_.acceleration[0], x.a);
    x.lambda.setZero();
    return 0.0;
  }

 private:
  RecordedPoints<Solver> places_;
  RungeKuttaStages<Method> walk_;
  RungeKuttaNumbers<Method, double> numbers_;
  RungeKuttaNumbers<Method, ReverseVar> recorded_;
};

/// Adjoints of runs by RungeKutta4.
template <class Stabilisation>
struct StageAdjoints<RungeKutta4<Stabilisation>> {
  using Type = RungeKuttaStepAdjoint<RungeKutta4<Stabilisation>>;  ///< of its steps
};
/// Adjoints of runs by DormandPrince.
template <class Stabilisation>
struct StageAdjoints<DormandPrince<Stabilisation>> {
  using Type = RungeKuttaStepAdjoint<DormandPrince<Stabilisation>>;  ///< of its steps
};

}  // namespace polybody
