#pragma once
/// \file
/// Linearised step and adjoint of a step of an explicit Runge–Kutta method (integrators/runge_kutta.hpp). Both are
/// exact and need no iteration. A step is computed in any scalar type T. With the rates δ˙_j and the accelerations v̇_j
/// of the stages,
///   δ_i = h Σ a_ij δ˙_j,  v_i = v₀ + h Σ a_ij v̇_j,  q_i = q₀ ⊞ δ_i.
/// Linear equations are solved for each v̇_i, each Gauss–Newton iteration of a projection, and the correction of the
/// velocities by the projection. Dual numbers pass through the step for its linearised form
/// (gradients/solved_points.hpp). For its adjoint a tape records the step, and the backward sweep solves linear
/// equations point by point (gradients/recorded_points.hpp).

#include <polybody/gradients/alpha_step_adjoint.hpp>
#include <polybody/gradients/projection_derivative.hpp>
#include <polybody/gradients/recorded_points.hpp>
#include <polybody/gradients/solved_points.hpp>
#include <polybody/integrators/runge_kutta.hpp>

namespace polybody {

/// Workspace of one Runge–Kutta step in the scalar type T: initial state, increment, and all stages.
template <class Method, StateScalar T>
struct RungeKuttaNumbers {
  VecXOf<T> q0;                                                 ///< (nq) coordinates at the start
  VecXOf<T> v0;                                                 ///< (nv) velocities at the start
  VecXOf<T> delta;                                              ///< (nv) increment δ of a stage
  std::array<VecXOf<T>, Method::Tableau::stages> rate;          ///< (nv) δ˙ of the stages
  std::array<VecXOf<T>, Method::Tableau::stages> acceleration;  ///< (nv) v̇ of the stages
  EvaluationPoint<T> at;                                        ///< point of a stage; finally the end of the step
};

/// Computes steps of a Runge–Kutta method in any scalar type.
template <class Method>
class RungeKuttaStages {
  using Stabilisation = decltype(Method::stabilisation);
  static constexpr bool projects = std::same_as<Stabilisation, Projection>;
  static_assert(projects || std::derived_from<Stabilisation, NoCorrection> || std::same_as<Stabilisation, Baumgarte>,
                "Derivatives of Runge–Kutta steps need Projection, Baumgarte or NoStabilisation. "
                "CoordinatePartitioning is not supported.");
  using Tableau = typename Method::Tableau;
  static constexpr std::size_t stages = Tableau::stages;

 public:
  /// \param method integrator of the steps
  explicit RungeKuttaStages(Method const& method)
      : feedback_(method.stabilisation.feedback()), projection_(projection_of(method)) {}

  /// Computes the step from q₀, v₀ and the v̇ of the first stage; the end is stored in w.at. \param system the
  /// equations in T; \param t time at the start [s]; \param h step length, of type T if it varies [s]; \param solve
  /// solves the equations at a point
  template <StateScalar T, class H, class Solve>
  void operator()(BasicSystem<T>& system, RungeKuttaNumbers<Method, T>& w, double t, H const& h, Solve&& solve) {
    w.delta = VecXOf<T>::Constant(w.v0.size(), T(0.0));
    w.rate.fill(w.delta);
    w.at.also.resize(0);
    system.local_rate(w.delta, w.v0, w.rate[0]);
    for (std::size_t i = 1; i < stages; ++i) {
      combine(w, h, Tableau::a[i], i);
      system.local_rate(w.delta, w.at.v, w.rate[i]);
      accelerations(w, t + Tableau::c[i] * value_of(h), system, solve);
      w.acceleration[i] = w.at.a;
    }
    combine(w, h, Tableau::b, stages);
    if constexpr (projects) {
      w.at.q = w.q0;
      system.plus(w.q0, w.delta, w.at.q);
      w.at.t = t + value_of(h);
      projection_.apply(system, w.at, value_of(h), solve);
      w.at.terms = {};
      solve(w.at);
    } else {
      accelerations(w, t + value_of(h), system, solve);
    }
  }

 private:
  static Projection projection_of([[maybe_unused]] Method const& method) {
    if constexpr (projects)
      return method.stabilisation;
    else
      return {};
  }
  /// δ = h Σ_{j<count} weights[j] δ˙_j, v = v₀ + h Σ_{j<count} weights[j] v̇_j.
  template <StateScalar T, class H, class Row>
  static void combine(RungeKuttaNumbers<Method, T>& w, H const& h, Row const& weights, std::size_t count) {
    w.delta.setConstant(T(0.0));
    w.at.v = w.v0;
    for (std::size_t j = 0; j < count; ++j) {
      if (weights[j] == 0.0) continue;
      H const weight = h * weights[j];
      for (Index i = 0; i < w.delta.size(); ++i) {
        w.delta[i] += w.rate[j][i] * weight;
        w.at.v[i] += w.acceleration[j][i] * weight;
      }
    }
  }
  /// v̇ and λ at q₀ ⊞ δ.
  template <StateScalar T, class Solve>
  void accelerations(RungeKuttaNumbers<Method, T>& w, double t, BasicSystem<T> const& s, Solve&& solve) {
    w.at.q = w.q0;
    s.plus(w.q0, w.delta, w.at.q);
    w.at.t = t;
    w.at.terms = {.rate = feedback_.rate, .position = feedback_.position};
    solve(w.at);
  }

  ConstraintFeedback feedback_;
  ProjectionDerivative projection_;
};

/// Derivatives of successive steps of RungeKutta4 or DormandPrince, also with respect to the step lengths. The
/// dependence of step lengths on the error estimate is not differentiated.
template <class Method, LinearSolver Solver = DefaultSolver>
class RungeKuttaLinearisedStep {
  using D = typename SolvedPoints<Solver>::D;

 public:
  /// Largest number of directions in one pass through the equations.
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

/// Derivatives of the steps of explicit Runge–Kutta methods, as `Derivatives` of the integrators.
struct RungeKuttaDerivatives {
  template <class Method>
  using LinearisedStep = RungeKuttaLinearisedStep<Method>;  ///< linearised step
  template <class Method>
  using StepAdjoint = RungeKuttaStepAdjoint<Method>;  ///< adjoint of a step
};

}  // namespace polybody
