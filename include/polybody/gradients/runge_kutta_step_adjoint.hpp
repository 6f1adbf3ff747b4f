#pragma once
/// \file
/// Adjoint of a step of an explicit Runge–Kutta method. It is exact and needs no iteration. A tape records the step
/// (gradients/runge_kutta_stages.hpp), and the backward sweep solves linear equations point by point
/// (gradients/recorded_points.hpp).

#include <polybody/gradients/alpha_step_adjoint.hpp>
#include <polybody/gradients/recorded_points.hpp>
#include <polybody/gradients/runge_kutta_stages.hpp>

namespace polybody {

/// Adjoints of successive steps of RungeKutta4 or DormandPrince, from the last one to the first. The step lengths are
/// constants.
template <class Method, LinearSolver Solver = DefaultSolver>
class RungeKuttaStepAdjoint {
 public:
  /// The model must outlive this object. \param method integrator of the steps
  template <class M>
  [[gnu::cold]] RungeKuttaStepAdjoint(M const& model, System& system, Method const& method)
      : places_(model, system), walk_(method) {}

  /// Converts, in place, the adjoint variables of the state after the step to adjoint variables of the state before it.
  /// Calls `visit(place, μ)` for each point where the step solves equations; −μ is the derivative of the objective
  /// function with respect to these equations. Returns zero, since there is no iterative correction. \throws
  /// SingularMatrix in a singular configuration, NonFiniteValue.
  template <class F>
  double backward_step(StepTaken const& step, Costate& x, F&& visit) {
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
    places_.sweep(visit);
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

/// Adjoint of the steps of runs with RungeKutta4.
template <class Stabilisation>
struct StageAdjoints<RungeKutta4<Stabilisation>> {
  using Type = RungeKuttaStepAdjoint<RungeKutta4<Stabilisation>>;  ///< adjoint of a step
};
/// Adjoint of the steps of runs with DormandPrince.
template <class Stabilisation>
struct StageAdjoints<DormandPrince<Stabilisation>> {
  using Type = RungeKuttaStepAdjoint<DormandPrince<Stabilisation>>;  ///< adjoint of a step
};

}  // namespace polybody
