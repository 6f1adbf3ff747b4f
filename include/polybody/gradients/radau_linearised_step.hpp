#pragma once
/// \file
/// Linearised step of Radau (integrators/radau.hpp). It is exact: it contains the terms that the matrix of Newton's
/// method omits.
///
/// With y = (δv̇_i, δλ_i) of the three stages, the formulas of the method give the changes of q_i and v_i, and
///   δ[M v̇_i − f_i + G_iᵀλ_i] = 0,  δ[G_i v̇_i + γ_i] = 0
/// is linear in y. One pass of dual numbers through each stage evaluates the left-hand side. Iterative refinement with
/// a factorised matrix of all stages solves for y, until the corrections are at round-off. Each stage contributes its
/// own tangent matrix with second-order terms, and the derivatives of its constraint equations. The projection at the
/// end of the step and the subsequent change of v̇ are solutions of linear equations; gradients/solved_points.hpp
/// differentiates them.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <polybody/gradients/radau_stage_solution.hpp>
#include <polybody/gradients/solved_points.hpp>

namespace polybody {

/// Derivatives of successive steps of Radau, also with respect to the step lengths. A state does not contain the stages
/// of a step, so they are computed again. If Newton's method does not converge for a step, `Radau` uses stages longer
/// than the step. The derivatives then belong to a step with stages of its own length; the difference has the order of
/// the integration errors.
template <LinearSolver Solver = DefaultSolver>
class RadauLinearisedStep {
 public:
  /// Number of directions in one pass through the equations: one for each derivative of a dual number.
  static constexpr int max_directions = SolvedPoints<Solver>::max_directions;

  /// The model must outlive this object. \param system with `Capabilities::implicit_step`; \param method integrator of
  /// the steps
  template <class M>
  [[gnu::cold]] RadauLinearisedStep(M const& model, System& system, Radau const& method)
      : places_(model, system), stages_(places_, method) {
    correction_ = VecX::Zero(3 * system.size());
    along_.fill(correction_);
    duals_.resize(places_.template system<D>());
  }
  RadauLinearisedStep(RadauLinearisedStep const&) = delete;  // its members refer to each other

  /// Prepares the derivatives of a step by computing its stages again. \throws NewtonConvergenceFailure if the stages
  /// do not converge, SingularMatrix in a singular configuration, NonFiniteValue.
  void set(StepTaken const& step) { stages_.find(step); }

  /// Converts, in place, up to `max_directions` derivatives of the state before the step to derivatives of the state
  /// after it. Returns the largest relative change in the last corrections. The change is relative to the norm of the
  /// derivatives, or to the norm of v̇ or λ divided by the scale of the parameter if this quotient is larger. \param
  /// slope slope(x, l) returns the derivative of the equations at the point x along direction l, due to its parameter
  /// and its change of time; \param dh derivative of the step length along each direction [s], or none if the length is
  /// constant
  template <EquationDerivativeFunction F>
  double advance(StepTaken const& step, std::span<State* const> directions, F&& slope,
                 std::span<double const> dh = {}) {
    begin(step, directions);
    D const h = detail::lift<max_directions>(step.h, dh);
    auto const by = derivatives_of_stages(directions.size(), slope);
    double left = std::numeric_limits<double>::infinity();
    for (int k = 0; k < most_corrections; ++k) {
      stages_.evaluate(duals_, dual_equations_, step, h,
                       [&](Index first) { keep_derivatives(first, directions.size(), by); });
      double now = 0.0;
      for (std::size_t l = 0; l < directions.size(); ++l) now = std::max(now, correct(l, by));
      bool const done = now <= 1e-15 || (k > 1 && now <= 1e-10 && now >= 0.3 * left);
      left = now;
      if (done) break;
    }
    duals_.find(places_.template system<D>(), h);
    places_.again();
    stages_.finish(duals_, step, [&](EvaluationPoint<D>& at) {
      places_.solve(at, directions.size(), slope);
      return 0.0;
    });
    detail::take_derivatives(duals_.at.q, directions, &State::q);
    detail::take_derivatives(duals_.at.v, directions, &State::v);
    detail::take_derivatives(duals_.next, directions, &State::a);
    detail::take_derivatives(duals_.lambda[2], directions, &State::lambda);
    return left;
  }

 private:
  using D = typename SolvedPoints<Solver>::D;
  using StageDerivatives = std::array<std::array<EquationDerivative, 3>, std::size_t(max_directions)>;
  static constexpr int most_corrections = 60;

  /// Sets the start and the values of the stages. The derivatives of v̇ and λ at the start are the initial guess for
  /// the stages.
  void begin(StepTaken const& step, std::span<State* const> directions) {
    detail::lift(step.before.q, directions, &State::q, duals_.q0);
    detail::lift(step.before.v, directions, &State::v, duals_.v0);
    for (std::size_t i = 0; i < 3; ++i) {
      detail::lift(stages_.numbers().vd[i], directions, &State::a, duals_.vd[i]);
      detail::lift(stages_.numbers().lambda[i], directions, &State::lambda, duals_.lambda[i]);
      duals_.delta[i] = stages_.numbers().delta[i].template cast<D>();
    }
  }
  template <class F>
  StageDerivatives derivatives_of_stages(std::size_t directions, F&& slope) {
    StageDerivatives out;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t l = 0; l < directions; ++l) out[l][i] = slope(stages_.stage_places()[i], l);
    return out;
  }

  /// Stores the negative changes of the equations of a stage in `along_`, including the derivatives with respect to the
  /// parameters. \param first index of the first unknown of the stage
  void keep_derivatives(Index first, std::size_t directions, StageDerivatives const& by) {
    VecXOf<D> const &balance = dual_equations_.balance, &rows = dual_equations_.rows;
    std::size_t const stage = std::size_t(first / places_.template system<double>().size());
    for (std::size_t l = 0; l < directions; ++l) {
      EquationDerivative const& of = by[l][stage];
      double* const to = along_[l].data() + first;
      for (Index i = 0; i < balance.size(); ++i) to[i] = -(balance[i].d[Index(l)] + of.balance[i]);
      for (Index i = 0; i < rows.size(); ++i) to[balance.size() + i] = -(rows[i].d[Index(l)] + of.rows[i]);
    }
  }
  /// Corrects δv̇ and δλ of the stages along direction l. Returns the largest relative correction.
  double correct(std::size_t l, StageDerivatives const& by) {
    stages_.solver().solve(along_[l], correction_);
    Index const n = places_.template system<double>().size(), nv = stages_.numbers().v0.size(), k = Index(l);
    double now = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      double const scale = by[l][i].scale;
      VecX const of_a = correction_.segment(Index(i) * n, nv),
                 of_lambda = correction_.segment(Index(i) * n + nv, n - nv);
      now = std::max({now, add_slope(of_a, k, scale, duals_.vd[i]), add_slope(of_lambda, k, scale, duals_.lambda[i])});
    }
    return now;
  }
  static double add_slope(VecX const& correction, Index l, double scale, VecXOf<D>& to) {
    double derivatives = 0.0, values = 0.0;
    for (Index i = 0; i < to.size(); ++i) {
      to[i].d[l] += correction[i];
      derivatives = std::hypot(derivatives, to[i].d[l]);
      values = std::hypot(values, to[i].v);
    }
    double const all = std::max(derivatives, values / scale);
    return all > 0.0 ? correction.norm() / all : correction.norm();
  }

  SolvedPoints<Solver> places_;
  detail::RadauStageSolution<SolvedPoints<Solver>> stages_;
  PointEquations<D> dual_equations_;
  detail::RadauStages<D> duals_;
  std::array<VecX, std::size_t(max_directions)> along_;
  VecX correction_;
};

/// Linearised step for runs with Radau.
template <>
struct StageDerivatives<Radau> {
  using Type = RadauLinearisedStep<>;  ///< linearised step
};

}  // namespace polybody
