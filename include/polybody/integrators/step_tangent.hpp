#pragma once
#include <polybody/solvers/tangent_solver.hpp>

namespace polybody {

/// The tangent of an implicit step and its solver, without second-order terms ck ∂(Gᵀλ)/∂q, ∂(Jᵀw)/∂q or with them.
/// They cost as much as the rest and seldom save an iteration. Steps that stall call for them; then they stay for eight
/// steps, and twice as long each time that they are called for again within as many steps after they went, as beside
/// singular positions.
template <LinearSolver Solver>
class StepTangent {
 public:
  /// Allocates all there is to be for steps without them, or with them. \param lambda of any values
  [[gnu::cold]] void analyse(System& system, SecondOrder terms, VecX const& lambda) {
    begins_with_ = terms == SecondOrder::included;
    has_second_ = false;
    first_.analyse(system, 1, [&](BlockSink& sink) { system.tangent({1.0, 1.0, 1.0}, terms, lambda, sink); });
    left_out_.clear();
    forget();
  }
  /// A start: no step has called for anything yet.
  void forget() {
    included_ = went_ = false;
    left_ = since_ = 0;
    stay_ = shortest_stay;
  }

  /// Every later factorisation drops these equations, which are redundant.
  void mark_redundant(std::span<Index const> equations) {
    if (std::equal(equations.begin(), equations.end(), left_out_.begin(), left_out_.end())) return;
    left_out_ = Sequence<Index>(equations.begin(), equations.end());
    first_.mark_redundant(equations);
    if (has_second_) second_.mark_redundant(equations);
  }

  /// The solver of the tangent as it is now.
  TangentSolver<Solver>& solver() { return included_ ? second_ : first_; }
  /// Whether the tangent has second-order terms now.
  SecondOrder terms() const { return included_ || begins_with_ ? SecondOrder::included : SecondOrder::omitted; }

  /// A step calls for second-order terms; \param lambda of any values.
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
  /// A step has ended. True where second-order terms go, and their factorisation with them.
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
  long stay_ = shortest_stay;  ///< steps for which they stay
  long left_ = 0;              ///< of these
  long since_ = 0;             ///< steps since they went
};

}  // namespace polybody
