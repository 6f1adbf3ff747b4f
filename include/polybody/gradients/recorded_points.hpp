#pragma once
/// \file
/// Points at which a recorded time step solves linear equations K x = b with K = [M, Gᵀ; G, 0]. From
///   K δx = δb − δK x  follows  b̄ = μ = K⁻ᵀ x̄ = K⁻¹ x̄,
/// where x̄ and b̄ are the derivatives of the objective function with respect to x and b. One function template
/// computes the step in doubles and in tape variables. With doubles it solves the equations and factorises K at each
/// point. With tape variables it passes through the same points in the same order. The backward sweep computes the
/// multipliers μ of each point.

#include <polybody/gradients/adjoint_kernels.hpp>
#include <polybody/gradients/solved_points.hpp>

namespace polybody {

/// Evaluation points of a step on a tape, with the adjoint multipliers μ of their equations.
template <LinearSolver Solver = DefaultSolver>
class RecordedPoints {
 public:
  /// The model must outlive this object.
  template <class M>
  [[gnu::cold]] RecordedPoints(M const& model, System& system)
      : found_(system), recorded_(stepped_system<ReverseVar>(model, with<Capabilities::motion>)) {
    rhs_ = mu_ = VecX::Zero(system.size());
  }

  /// System with the scalar type T.
  template <StateScalar T>
  BasicSystem<T>& system() {
    if constexpr (std::same_as<T, double>)
      return found_.system();
    else
      return recorded_;
  }
  /// Tape of the step.
  Tape& recording() { return recording_; }

  /// Discards all points.
  void forget() { found_.forget(); }
  /// Returns to the first point. The tape remains unchanged.
  void again() { passed_.clear(); }

  /// Adds x as another point, and stores the solution in its a and λ. \throws SingularMatrix, NonFiniteValue.
  void solve(EvaluationPoint<>& x) { found_.solve(x); }
  /// Largest absolute residual of the constraint equations for a = 0 at the last point.
  double largest_row() const { return found_.largest_row(); }
  /// Indices of the redundant constraint equations at the last point.
  std::span<Index const> dropped() const { return found_.dropped(); }

  /// Records the next point: sets a and λ of x to its solution, as variables, and evaluates the equations.
  void solve(EvaluationPoint<ReverseVar>& x) {
    auto const& place = found_[passed_.size()].place;
    Passed here{.begin = recording_.size()};
    detail::set_variables(place.a, x.a);
    detail::set_variables(place.lambda, x.lambda);
    equations_.evaluate(recorded_, x);
    here.end = recording_.size();
    numbers_of(x.a, here.a);
    numbers_of(x.lambda, here.lambda);
    numbers_of(equations_.balance, here.balance);
    numbers_of(equations_.rows, here.rows);
    passed_.push_back(std::move(here));
  }

  /// Sweeps backward to operation `begin`, which precedes the first point. Before the call, the tape must contain the
  /// derivatives with respect to the results of the step. Calls `visit(place, μ)` for each point, from the last one to
  /// the first; μ (nv + rows) has the order of the velocities, then of the constraint equations.
  template <class F>
  void sweep(F&& visit, std::size_t begin = 1) {
    std::size_t end = recording_.size();
    for (std::size_t k = passed_.size(); k-- > 0;) {
      Passed const& here = passed_[k];
      auto& found = found_[k];
      Index const nv = Index(here.a.size());
      recording_.sweep(end, here.end);
      for (Index i = 0; i < nv; ++i) rhs_[i] = recording_.slope(here.a[std::size_t(i)]);
      for (std::size_t i = 0; i < here.lambda.size(); ++i) rhs_[nv + Index(i)] = recording_.slope(here.lambda[i]);
      found.factors.solve(rhs_, mu_);
      for (Index i = 0; i < nv; ++i) recording_.slope(here.balance[std::size_t(i)]) -= mu_[i];
      for (std::size_t i = 0; i < here.rows.size(); ++i) recording_.slope(here.rows[i]) -= mu_[nv + Index(i)];
      recording_.sweep(here.end, here.begin);
      visit(std::as_const(found.place), std::as_const(mu_));
      end = here.begin;
    }
    recording_.sweep(end, begin);
  }

 private:
  struct Passed {
    std::size_t begin = 0, end = 0;  // operations of its variables and equations
    std::vector<Tape::Number> a = {}, lambda = {}, balance = {}, rows = {};
  };
  static void numbers_of(VecXOf<ReverseVar> const& from, std::vector<Tape::Number>& to) {
    for (Index i = 0; i < from.size(); ++i) to.push_back(from[i].number);
  }

  SolutionPoints<Solver> found_;
  BasicSystem<ReverseVar> recorded_;
  PointEquations<ReverseVar> equations_;
  Tape recording_;
  std::vector<Passed> passed_;
  VecX rhs_, mu_;
};

}  // namespace polybody
