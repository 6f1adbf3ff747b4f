#pragma once
/// \file
/// Linearised step and adjoint of a step of Radau (integrators/radau.hpp). They contain the terms that the matrix of
/// Newton's method omits.
///
/// With y = (δv̇_i, δλ_i) of the three stages, the method gives the changes of q_i and v_i. The equations
///   δ[M v̇_i − f_i + G_iᵀλ_i] = 0,  δ[G_i v̇_i + γ_i] = 0
/// are linear in y. One pass of dual numbers through each stage evaluates the left-hand sides. Iterative refinement
/// with a factorised matrix of all stages solves for y, until the corrections are at round-off. Each stage contributes
/// its own tangent matrix with second-order terms, and the derivatives of its constraint equations. The projection at
/// the end of the step and the subsequent change of v̇ are solutions of linear equations; gradients/solved_points.hpp
/// differentiates them.
///
/// Adjoint: with y = (v̇_i, λ_i) and the equations R(y; x₀) of the stages, μ is the solution of (∂R/∂y)ᵀ μ = ȳ. A tape
/// records the stages and the operations after them once. The backward sweep over the projection and the last change of
/// v̇ solves linear equations point by point (gradients/recorded_points.hpp). A factorisation of the transposed matrix
/// of all stages approximates μ. Products from sweeps over the tape of the stages correct μ until the corrections are
/// at round-off.
/// Theory: Eq. 8.22.

#include <polybody/gradients/alpha_step_adjoint.hpp>
#include <polybody/gradients/radau_stage_solution.hpp>
#include <polybody/gradients/recorded_points.hpp>
#include <polybody/gradients/solved_points.hpp>

namespace polybody {

/// Derivatives of successive steps of Radau, also with respect to the step lengths. A state does not contain the stages
/// of a step, so they are computed again. If Newton's method does not converge for a step of a model with constraint
/// equations, `Radau` may compute stages over 1.25 times the length of the step. The derivatives then belong to a step
/// with stages over the length of the step itself. The difference has the order of the integration errors.
template <LinearSolver Solver = DefaultSolver>
class RadauLinearisedStep {
 public:
  /// Largest number of directions in one pass through the equations: one for each derivative of a dual number.
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
  /// the derivatives of v̇ and λ of the stages.
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

/// Adjoints of successive steps of Radau, from the last one to the first. The stages are computed as in
/// `RadauLinearisedStep`.
template <LinearSolver Solver = DefaultSolver>
class RadauStepAdjoint {
 public:
  /// The model must outlive this object. \param system with `Capabilities::implicit_step`; \param method integrator of
  /// the steps
  template <class M>
  [[gnu::cold]] RadauStepAdjoint(M const& model, System& system, Radau const& method)
      : places_(model, system), stages_(places_, method) {
    recorded_.resize(places_.template system<ReverseVar>());
    solver_.analyse(system, 3, [&](BlockSink& sink) { write_transposed(sink, 0.0, 1.0); });
    mu_ = y_ = product_ = VecX::Zero(3 * system.size());
  }
  RadauStepAdjoint(RadauStepAdjoint const&) = delete;  // its members refer to each other

  /// Converts, in place, the adjoint variables of the state after the step to adjoint variables of the state before it.
  /// Calls `visit(place, μ)` for each point where the step solves equations; −μ is the derivative of the objective
  /// function with respect to these equations. Returns the relative size of the last correction of μ. \throws
  /// NewtonConvergenceFailure if the stages do not converge as they are computed again, SingularMatrix in a singular
  /// configuration, NonFiniteValue.
  template <class F>
  double backward_step(StepTaken const& step, Costate& x, F&& visit) {
    stages_.find(step);
    factor(step);
    Tape& recording = places_.recording();
    Tape::On const on(recording);
    std::size_t const stages_end = record(step);
    recording.clear_derivatives(recording.size());
    detail::add_to_derivatives(recording, recorded_.at.q, x.q);
    detail::add_to_derivatives(recording, recorded_.at.v, x.v);
    detail::add_to_derivatives(recording, recorded_.next, x.a);
    detail::add_to_derivatives(recording, recorded_.lambda[2], x.lambda);
    places_.sweep(visit, stages_end);
    recording.sweep(stages_end, 1);
    take_stages(y_);
    detail::take_derivatives(recording, recorded_.q0, x.q);
    detail::take_derivatives(recording, recorded_.v0, x.v);
    double const left = solution_.solve(
        y_, mu_,
        [&](VecX const& of) -> VecX const& {
          pull(stages_end, of);
          return product_;
        },
        [&](VecX const& rhs, VecX& correction) { solver_.solve(rhs, correction); }, most_products);
    for (Index i = 0; i < x.q.size(); ++i) x.q[i] -= recording.slope(recorded_.q0[i].number);
    for (Index i = 0; i < x.v.size(); ++i) x.v[i] -= recording.slope(recorded_.v0[i].number);
    x.a.setZero();
    x.lambda.setZero();
    Index const n = size();
    for (std::size_t i = 0; i < 3; ++i) {
      VecX const mu = mu_.segment(Index(i) * n, n);
      visit(stages_.stage_places()[i], mu);
    }
    return left;
  }

 private:
  using Numbers = VecXOf<ReverseVar>;
  static constexpr Index most_products = 60;

  Index size() { return places_.template system<double>().size(); }

  void write_transposed(BlockSink& sink, double t, double h) {
    TransposedSink<BlockSink> transposed(sink);
    BlockSink through(transposed);
    stages_.write(t, h, through);
  }
  void factor(StepTaken const& step) {
    Index const bad = solver_.factor([&](BlockSink& sink) { write_transposed(sink, step.before.t, step.h); });
    if (bad >= 0)
      throw SingularMatrix(
          "derivative.singular",
          {"The adjoint equations of the step to t = ", ErrorTime{step.before.t + step.h}, " s are singular at ",
           ErrorObject{name_of_equation(places_.template system<double>(),
                                        bad % equations_of(places_.template system<double>()))},
           ". Avoid the singular configuration, or take a smaller step."});
  }

  /// Records the start and the stages as variables, their equations, and then the points after them. Returns the number
  /// of operations of the stages.
  std::size_t record(StepTaken const& step) {
    detail::RadauStages<double> const& found = stages_.numbers();
    detail::set_variables(step.before.q, recorded_.q0);
    detail::set_variables(step.before.v, recorded_.v0);
    for (std::size_t i = 0; i < 3; ++i) {
      detail::set_variables(found.vd[i], recorded_.vd[i]);
      detail::set_variables(found.lambda[i], recorded_.lambda[i]);
      recorded_.delta[i].setConstant(ReverseVar(0.0));  // zero: the tape must contain the whole iteration for δ
    }
    numbers_.clear();
    stages_.evaluate(recorded_, equations_, step, step.h, [&](Index) {
      for (Index i = 0; i < equations_.balance.size(); ++i) numbers_.push_back(equations_.balance[i].number);
      for (Index i = 0; i < equations_.rows.size(); ++i) numbers_.push_back(equations_.rows[i].number);
    });
    std::size_t const end = places_.recording().size();
    places_.again();
    stages_.finish(recorded_, step, [&](EvaluationPoint<ReverseVar>& at) {
      places_.solve(at);
      return 0.0;
    });
    return end;
  }

  /// Computes the products of the transposed derivatives of R with μ. The products with ∂R/∂y are stored in `product_`.
  void pull(std::size_t stages_end, VecX const& mu) {
    Tape& recording = places_.recording();
    recording.clear_derivatives(stages_end);
    for (std::size_t i = 0; i < numbers_.size(); ++i) recording.slope(numbers_[i]) += mu[Index(i)];
    recording.sweep(stages_end, 1);
    take_stages(product_);
    Index const n = size(), nv = recorded_.v0.size(), rows = n - nv;
    for (Index i = 0; i < 3; ++i)
      for (Index k = 0; k < rows; ++k) product_[i * n + nv + k] += stages_.slack(i, k) * mu[i * n + nv + k];
  }
  /// Copies the derivatives with respect to v̇_i and λ_i to `out`.
  void take_stages(VecX& out) {
    Index at = 0;
    for (std::size_t i = 0; i < 3; ++i)
      for (Numbers const* const of : {&recorded_.vd[i], &recorded_.lambda[i]})
        for (Index k = 0; k < of->size(); ++k) out[at++] = places_.recording().slope((*of)[k].number);
  }
  RecordedPoints<Solver> places_;
  detail::RadauStageSolution<RecordedPoints<Solver>> stages_;
  PointEquations<ReverseVar> equations_;
  detail::RadauStages<ReverseVar> recorded_;
  TangentSolver<AutoLu> solver_;       // of the transposed matrix
  std::vector<Tape::Number> numbers_;  // tape numbers of the equations of all stages
  detail::TransposedSolution solution_;
  VecX mu_, y_, product_;
};

/// Derivatives of the steps of Radau, as `Radau::Derivatives`.
struct RadauDerivatives {
  template <class>
  using LinearisedStep = RadauLinearisedStep<>;  ///< linearised step
  template <class>
  using StepAdjoint = RadauStepAdjoint<>;  ///< adjoint of a step
};

}  // namespace polybody
