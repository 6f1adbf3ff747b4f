#pragma once
/// \file
/// Linearised step of an explicit Runge–Kutta method. It is exact and needs no iteration. Dual numbers pass through the
/// step (gradients/runge_kutta_stages.hpp). Its accelerations and projections are solutions of linear equations;
/// gradients/solved_points.hpp differentiates them.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <polybody/gradients/runge_kutta_stages.hpp>
#include <polybody/gradients/solved_points.hpp>

namespace polybody {

/// Derivatives of successive steps of RungeKutta4 or DormandPrince, also with respect to the step lengths. The
/// dependence of step lengths on the error estimate is not differentiated.
template <class Method, LinearSolver Solver = DefaultSolver>
class RungeKuttaLinearisedStep {
  using D = typename SolvedPoints<Solver>::D;

 public:
  /// Number of directions in one pass through the equations.
  static constexpr int max_directions = SolvedPoints<Solver>::max_directions;

  /// The model must outlive this object. \param method integrator of the steps
  template <class M>
  [[gnu::cold]] RungeKuttaLinearisedStep(M const& model, System& system, Method const& method)
      : places_(model, system), walk_(method) {}

  /// Prepares the derivatives of a step by computing its stages again. \throws SingularMatrix in a singular
  /// configuration, NonFiniteValue.
  void set(StepTaken const& step) {
    State const& x = step.before;
    numbers_.q0 = x.q;
    numbers_.v0 = x.v;
    numbers_.acceleration[0] = x.a;
    places_.forget();
    walk_(places_.template system<double>(), numbers_, x.t, step.h, [&](EvaluationPoint<>& at) {
      places_.solve(at);
      return places_.largest_row();
    });
  }

  /// Converts, in place, up to `max_directions` derivatives of the state before the step to derivatives of the state
  /// after it. Returns zero, since there is no iterative correction. \param slope slope(x, l) returns the derivative of
  /// the equations at the point x along direction l, due to its parameter and its change of time; \param dh derivative
  /// of the step length along each direction [s], or none if the length is constant
  template <EquationDerivativeFunction F>
  double advance(StepTaken const& step, std::span<State* const> directions, F&& slope,
                 std::span<double const> dh = {}) {
    State const& x = step.before;
    detail::lift(x.q, directions, &State::q, duals_.q0);
    detail::lift(x.v, directions, &State::v, duals_.v0);
    detail::lift(x.a, directions, &State::a, duals_.acceleration[0]);
    places_.again();
    walk_(places_.template system<D>(), duals_, x.t, detail::lift<max_directions>(step.h, dh),
          [&](EvaluationPoint<D>& at) {
            places_.solve(at, directions.size(), slope);
            return 0.0;
          });
    detail::take_derivatives(duals_.at.q, directions, &State::q);
    detail::take_derivatives(duals_.at.v, directions, &State::v);
    detail::take_derivatives(duals_.at.a, directions, &State::a);
    detail::take_derivatives(duals_.at.lambda, directions, &State::lambda);
    return 0.0;
  }

 private:
  SolvedPoints<Solver> places_;
  RungeKuttaStages<Method> walk_;
  RungeKuttaNumbers<Method, double> numbers_;
  RungeKuttaNumbers<Method, D> duals_;
};

/// Linearised step for runs with RungeKutta4.
template <class Stabilisation>
struct StageDerivatives<RungeKutta4<Stabilisation>> {
  using Type = RungeKuttaLinearisedStep<RungeKutta4<Stabilisation>>;  ///< linearised step
};
/// Linearised step for runs with DormandPrince.
template <class Stabilisation>
struct StageDerivatives<DormandPrince<Stabilisation>> {
  using Type = RungeKuttaLinearisedStep<DormandPrince<Stabilisation>>;  ///< linearised step
};

}  // namespace polybody
