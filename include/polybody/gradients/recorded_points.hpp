#pragma once
/// \file
/// Places of a recorded step where linear equations are solved: of K x = b, K = [M, Gᵀ; G, 0],
///   K δx = δb − δK x,  so  μ = K⁻ᵀ x̄ = K⁻¹ x̄
/// is what a result changes by with −b at a place, where x̄ is what it changes by with the solution. A step is written
/// once: doubles find and factor its places, recorded numbers meet them in the same order, and going back each place is
/// answered by its multipliers μ.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/gradients/adjoint_kernels.hpp>
#include <polybody/gradients/solved_points.hpp>

namespace polybody {

/// The places of a step with multipliers of their solutions.
template <LinearSolver Solver = DefaultSolver>
class RecordedPoints {
 public:
  /// The model must outlive it.
  template <class M>
  [[gnu::cold]] RecordedPoints(M const& model, System& system)
      : found_(system), recorded_(stepped_system<ReverseVar>(model, with<Capabilities::motion>)) {
    rhs_ = mu_ = VecX::Zero(system.size());
  }

  /// The system in the scalar T.
  template <StateScalar T>
  BasicSystem<T>& system() {
    if constexpr (std::same_as<T, double>)
      return found_.system();
    else
      return recorded_;
  }
  /// The recording of the step.
  Tape& recording() { return recording_; }

  /// What follows is solved at new places.
  void forget() { found_.forget(); }
  /// What follows is recorded, from the first place on.
  void again() { passed_.clear(); }

  /// Solves at another place, into its a and λ. \throws SingularMatrix, NonFiniteValue.
  void solve(EvaluationPoint<>& x) { found_.solve(x); }
  /// |rows| at a = 0 where it solved last, at most.
  double largest_row() const { return found_.largest_row(); }
  /// Equations that repeat others where it solved last.
  std::span<Index const> dropped() const { return found_.dropped(); }

  /// Into a and λ of x, as variables, the solution of the next place; its equations are recorded.
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

  /// Takes the recording backwards to operation `begin`, before the first place, from slopes that the results of the
  /// step have. \param told f(place, μ) for each place, from the last one on; μ (nv + rows) by speeds, then by rows
  template <class F>
  void sweep(F&& told, std::size_t begin = 1) {
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
      told(std::as_const(found.place), std::as_const(mu_));
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
