#pragma once
#include <polybody/solvers/tangent_solver.hpp>

namespace polybody {

/// Tangent of an implicit step and its solver, with or without the second-order terms ck ∂(Gᵀλ)/∂q, ∂(Jᵀw)/∂q. These
/// terms cost as much as all other terms and seldom save an iteration. A step that does not converge activates them for
/// eight steps. If another step does not converge within the same number of steps after the end of this period, the
/// next period is twice as long. This occurs near singular configurations.
template <LinearSolver Solver>
class StepTangent {
 public:
  /// Allocates all memory for steps with or without second-order `terms`. \param lambda multipliers of any values
  [[gnu::cold]] void analyse(System& system, SecondOrder terms, VecX const& lambda) {
    begins_with_ = terms == SecondOrder::included;
    has_second_ = false;
    first_.analyse(system, 1, [&](BlockSink& sink) { system.tangent({1.0, 1.0, 1.0}, terms, lambda, sink); });
    left_out_.clear();
    forget();
  }
  /// Deactivates the activated terms and resets their period, at the start of a run.
  void forget() {
    included_ = went_ = false;
    left_ = since_ = 0;
    stay_ = shortest_stay;
  }

  /// Every later factorisation drops these redundant `equations`.
  void mark_redundant(std::span<Index const> equations) {
    if (std::equal(equations.begin(), equations.end(), left_out_.begin(), left_out_.end())) return;
    left_out_ = Sequence<Index>(equations.begin(), equations.end());
    first_.mark_redundant(equations);
    if (has_second_) second_.mark_redundant(equations);
  }

  /// Solver of the present tangent.
  TangentSolver<Solver>& solver() { return included_ ? second_ : first_; }
  /// Second-order terms of the present tangent: included or omitted.
  SecondOrder terms() const { return included_ || begins_with_ ? SecondOrder::included : SecondOrder::omitted; }

  /// Activates second-order terms. \param lambda multipliers of any values
  [[gnu::cold]] void include(System& system, VecX const& lambda) {
    if (begins_with_ || included_) return;
    if (!has_second_) {
      second_.analyse(system, 1,
                      [&](BlockSink& sink) { system.tangent({1.0, 1.0, 1.0}, SecondOrder::included, lambda, sink); });
      second_.mark_redundant({left_out_.data(), left_out_.size()});
    }
    has_second_ = included_ = true;
    stay_ = went_ && since_ <= stay_ ? std::min(2 * stay_, longest_stay) : shortest_stay;
    left_ = stay_;
  }
  /// Counts a step. Returns true if the period of second-order terms ends, which invalidates the factorisation.
  bool end_step() {
    ++since_;
    if (!included_ || --left_ > 0) return false;
    included_ = false;
    went_ = true;
    since_ = 0;
    return true;
  }

 private:
  static constexpr long shortest_stay = 8, longest_stay = 1L << 20;

  TangentSolver<Solver> first_, second_;
  Sequence<Index> left_out_;
  bool begins_with_ = false, has_second_ = false, included_ = false, went_ = false;
  long stay_ = shortest_stay;  ///< length of a period with second-order terms, in steps
  long left_ = 0;              ///< remaining steps of the period
  long since_ = 0;             ///< steps since the end of the last period
};

}  // namespace polybody
