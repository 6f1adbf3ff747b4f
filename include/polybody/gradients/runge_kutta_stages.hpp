#pragma once
/// \file
/// Step of an explicit Runge–Kutta method (integrators/runge_kutta.hpp) in any scalar type T, for its derivatives. With
/// k = (δ˙, v̇) of the stages
///   δ_i = h Σ a_ij δ˙_j,  v_i = v₀ + h Σ a_ij v̇_j,  q_i = q₀ ⊞ δ_i.
/// Each v̇_i, each Gauss–Newton iteration of a projection and its correction of the velocities is a solution of linear
/// equations.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <polybody/gradients/projection_derivative.hpp>
#include <polybody/integrators/runge_kutta.hpp>

namespace polybody {

/// Values of a step in the scalar type T.
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
  /// δ, v = h Σ_{j<count} weights[j] k_j (plus v₀).
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

}  // namespace polybody
