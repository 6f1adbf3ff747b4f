#pragma once
/// \file
/// The tangent-linear of a step of an explicit Runge–Kutta method (integrators/runge_kutta.hpp), exactly. With
/// k = (δ˙, v̇) of the stages
///   δ_i = h Σ a_ij δ˙_j,  v_i = v₀ + h Σ a_ij v̇_j,  q_i = q₀ ⊞ δ_i
/// are differentiated as they stand, and each v̇_i, every step of Gauss–Newton of a projection and its step of the
/// speeds as the solution of linear equations at their place (gradients/solved_places.hpp). Nothing is iterated.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/gradients/projection_slope.hpp>
#include <polybody/gradients/solved_places.hpp>
#include <polybody/integrators/runge_kutta.hpp>

namespace polybody {

/// Slopes of steps of RungeKutta4 or DormandPrince, one step after the other. The length of a step stays as it was
/// chosen: its own derivative is not part of them.
template <class Method, LinearSolver Solver = DefaultSolver>
class RungeKuttaStepSlope {
  using Stabilisation = decltype(Method::stabilisation);
  static constexpr bool projects = std::same_as<Stabilisation, Projection>;
  static_assert(
      projects || std::derived_from<Stabilisation, NoCorrection> || std::same_as<Stabilisation, Baumgarte>,
      "Steps of Runge–Kutta methods are differentiated with Projection, Baumgarte or NoStabilisation. Dependent "
      "coordinates that are chosen in a run are not.");

 public:
  /// Directions that go through the equations together.
  static constexpr int lanes = SolvedPlaces<Solver>::lanes;

  /// Slopes of steps by `method`. The model must outlive it.
  template <class M>
  [[gnu::cold]] RungeKuttaStepSlope(M const& model, System& system, Method const& method)
      : places_(model, system), feedback_(method.stabilisation.feedback()), projection_(projection_of(method)) {}

  /// From now on slopes are those of this step. \throws LinearSolverSingular at a singular position, NonFinite.
  void set(StepTaken const& step) {
    State const& x = step.before;
    numbers_.q0 = x.q;
    numbers_.v0 = x.v;
    numbers_.acceleration[0] = x.a;
    places_.forget();
    walk(numbers_, step, [&](EquationPlace<>& at) {
      places_.solve(at);
      return places_.largest_row();
    });
  }

  /// Takes up to `lanes` derivatives of the state before the step to those of the state after it. Returns what a last
  /// correction changed: zero, for there is none. \param slope what the parameter of a direction does to the equations
  /// at each place where the step solves some
  template <TellsEquationSlopes F>
  double advance(StepTaken const& step, std::span<State* const> directions, F&& slope) {
    State const& x = step.before;
    detail::lift(x.q, directions, &State::q, duals_.q0);
    detail::lift(x.v, directions, &State::v, duals_.v0);
    detail::lift(x.a, directions, &State::a, duals_.acceleration[0]);
    places_.again();
    walk(duals_, step, [&](EquationPlace<D>& at) {
      places_.solve(at, directions.size(), slope);
      return 0.0;
    });
    detail::take_slopes(duals_.at.q, directions, &State::q);
    detail::take_slopes(duals_.at.v, directions, &State::v);
    detail::take_slopes(duals_.at.a, directions, &State::a);
    detail::take_slopes(duals_.at.lambda, directions, &State::lambda);
    return 0.0;
  }

 private:
  using D = typename SolvedPlaces<Solver>::D;
  using Tableau = typename Method::Tableau;
  static constexpr std::size_t stages = Tableau::stages;

  /// A step in the scalar T.
  template <StateScalar T>
  struct Walk {
    VecXOf<T> q0, v0, delta;                           // at the start; δ of a stage
    std::array<VecXOf<T>, stages> rate, acceleration;  // δ˙ and v̇ of the stages
    EquationPlace<T> at;                               // the stage, and at last the end
  };

  static Projection projection_of([[maybe_unused]] Method const& method) {
    if constexpr (projects)
      return method.stabilisation;
    else
      return {};
  }

  /// The step from q₀, v₀ and v̇ there to its end, which stands in w.at. \param solve solves the equations at a place
  template <StateScalar T, class Solve>
  void walk(Walk<T>& w, StepTaken const& step, Solve&& solve) {
    BasicSystem<T>& s = places_.template system<T>();
    double const h = step.h, t = step.before.t;
    w.delta = VecXOf<T>::Constant(w.v0.size(), T(0.0));
    w.rate.fill(w.delta);
    w.at.also.resize(0);
    s.local_rate(w.delta, w.v0, w.rate[0]);
    for (std::size_t i = 1; i < stages; ++i) {
      combine(w, h, Tableau::a[i], i);
      s.local_rate(w.delta, w.at.v, w.rate[i]);
      accelerations(w, t + Tableau::c[i] * h, s, solve);
      w.acceleration[i] = w.at.a;
    }
    combine(w, h, Tableau::b, stages);
    if constexpr (projects) {
      w.at.q = w.q0;
      s.plus(w.q0, w.delta, w.at.q);
      w.at.t = t + h;
      projection_.apply(s, w.at, h, solve);
      w.at.terms = {};
      solve(w.at);
    } else {
      accelerations(w, t + h, s, solve);
    }
  }
  /// δ, v = h Σ_{j<count} weights[j] k_j (plus v₀).
  template <StateScalar T, class Row>
  static void combine(Walk<T>& w, double h, Row const& weights, std::size_t count) {
    w.delta.setConstant(T(0.0));
    w.at.v = w.v0;
    for (std::size_t j = 0; j < count; ++j) {
      if (weights[j] == 0.0) continue;
      for (Index i = 0; i < w.delta.size(); ++i) {
        w.delta[i] += w.rate[j][i] * (h * weights[j]);
        w.at.v[i] += w.acceleration[j][i] * (h * weights[j]);
      }
    }
  }
  /// v̇ and λ at q₀ ⊞ δ.
  template <StateScalar T, class Solve>
  void accelerations(Walk<T>& w, double t, BasicSystem<T> const& s, Solve&& solve) {
    w.at.q = w.q0;
    s.plus(w.q0, w.delta, w.at.q);
    w.at.t = t;
    w.at.terms = {.rate = feedback_.rate, .position = feedback_.position};
    solve(w.at);
  }

  SolvedPlaces<Solver> places_;
  RowFeedback feedback_;
  ProjectionSlope projection_;
  Walk<double> numbers_;
  Walk<D> duals_;
};

/// Slopes of runs by RungeKutta4.
template <class Stabilisation>
struct SlopesOfStages<RungeKutta4<Stabilisation>> {
  using Type = RungeKuttaStepSlope<RungeKutta4<Stabilisation>>;  ///< of its steps
};
/// Slopes of runs by DormandPrince.
template <class Stabilisation>
struct SlopesOfStages<DormandPrince<Stabilisation>> {
  using Type = RungeKuttaStepSlope<DormandPrince<Stabilisation>>;  ///< of its steps
};

}  // namespace polybody
