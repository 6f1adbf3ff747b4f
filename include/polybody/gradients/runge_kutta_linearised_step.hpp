#pragma once
/// \file
/// The tangent-linear of a step of an explicit Runge–Kutta method, exactly: the step is walked through in dual numbers
/// (gradients/runge_kutta_stages.hpp), and what it solves for are solutions of linear equations at their places
/// (gradients/solved_points.hpp). Nothing is iterated.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/gradients/runge_kutta_stages.hpp>
#include <polybody/gradients/solved_points.hpp>

namespace polybody {

/// Slopes of steps of RungeKutta4 or DormandPrince, one step after the other, also by their lengths. What the error
/// makes of a length is not part of them.
template <class Method, LinearSolver Solver = DefaultSolver>
class RungeKuttaLinearisedStep {
  using D = typename SolvedPoints<Solver>::D;

 public:
  /// Directions that go through the equations together.
  static constexpr int lanes = SolvedPoints<Solver>::lanes;

  /// Slopes of steps by `method`. The model must outlive it.
  template <class M>
  [[gnu::cold]] RungeKuttaLinearisedStep(M const& model, System& system, Method const& method)
      : places_(model, system), walk_(method) {}

  /// From now on slopes are those of this step. \throws SingularMatrix at a singular position, NonFiniteValue.
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

  /// Takes up to `lanes` derivatives of the state before the step to those of the state after it. Returns what a last
  /// correction changed: zero, for there is none. \param slope what the parameter of a direction, and the time that
  /// moves along it, do to the equations at each place where the step solves some; \param dh the derivative of the
  /// step's length along each direction [s], or none where it stays
  template <EquationDerivativeFunction F>
  double advance(StepTaken const& step, std::span<State* const> directions, F&& slope,
                 std::span<double const> dh = {}) {
    State const& x = step.before;
    detail::lift(x.q, directions, &State::q, duals_.q0);
    detail::lift(x.v, directions, &State::v, duals_.v0);
    detail::lift(x.a, directions, &State::a, duals_.acceleration[0]);
    places_.again();
    walk_(places_.template system<D>(), duals_, x.t, detail::lift<lanes>(step.h, dh), [&](EvaluationPoint<D>& at) {
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

/// Slopes of runs by RungeKutta4.
template <class Stabilisation>
struct StageDerivatives<RungeKutta4<Stabilisation>> {
  using Type = RungeKuttaLinearisedStep<RungeKutta4<Stabilisation>>;  ///< of its steps
};
/// Slopes of runs by DormandPrince.
template <class Stabilisation>
struct StageDerivatives<DormandPrince<Stabilisation>> {
  using Type = RungeKuttaLinearisedStep<DormandPrince<Stabilisation>>;  ///< of its steps
};

}  // namespace polybody
