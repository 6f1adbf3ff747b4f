#pragma once
/// \file
/// Adjoint of a step of Radau; gradients/radau_linearised_step.hpp contains the linearised step. With y = (v̇_i, λ_i)
/// of the three stages and R(y; x₀) their equations, μ is the solution of (∂R/∂y)ᵀ μ = ȳ. A tape records the stages and
/// the operations after them once. The backward sweep over the projection and the last change of v̇ solves linear
/// equations point by point (gradients/recorded_points.hpp). A factorisation of the transposed matrix of all stages
/// approximates μ. Products from sweeps over the tape of the stages correct μ until the corrections are at round-off.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <polybody/gradients/alpha_step_adjoint.hpp>
#include <polybody/gradients/radau_stage_solution.hpp>
#include <polybody/gradients/recorded_points.hpp>

namespace polybody {

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
          {"The equations of the adjoint of the step to t = ", ErrorTime{step.before.t + step.h}, " s are singular at ",
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

/// Adjoint of the steps of runs with Radau.
template <>
struct StageAdjoints<Radau> {
  using Type = RadauStepAdjoint<>;  ///< adjoint of a step
};

}  // namespace polybody
