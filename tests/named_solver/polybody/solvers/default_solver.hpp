#pragma once
// This header hides the library's header of the same name. Tests that name no solver use the solver of the
// environment variable,
//   POLYBODY_SOLVER=EigenSparseLu ctest ...
// or the library's default if the variable is not set. `DenseLu` is used up to 400 unknowns.

#include <memory>
#include <span>
#include <vector>

#include <polybody/solvers/auto_lu.hpp>
#include <polybody/solvers/block_factor.hpp>

namespace polybody {

/// A linear solver of any type, behind a pointer.
struct SolverInTests {
  virtual ~SolverInTests() = default;
  virtual void analyse(Index size, std::span<Block const> blocks) = 0;
  virtual void begin() = 0;
  virtual void add(Index row, Index col, BlockView const& b) = 0;
  virtual Index factor() = 0;
  virtual bool reordered() const = 0;
  virtual std::size_t reorderings() const = 0;
  virtual void limit_reorderings(std::size_t count) noexcept = 0;
  virtual std::span<Index const> dropped() const = 0;
  virtual void mark_redundant(std::span<Index const> unknowns) = 0;
  virtual bool is_doubtful(double share) const = 0;
  virtual Sequence<IndexMap<double>> null_vectors(VecX const& sizes) const = 0;
  virtual double sign_of_determinant() const = 0;
  virtual void solve(VecX const& b, VecX& x) const = 0;
};

/// Use of a solver: a solver that requires symmetry, or pivots within blocks only, is not valid for all uses.
enum class SolverFor { steps, unsymmetric_steps, statics };

/// The solver that the environment variable names, for a matrix of this size. Returns none if the variable is not
/// set, or if the solver is not valid for this use.
/// \throws InvalidInput for an unknown name. Defined in support/solver_instances.cpp.
std::unique_ptr<SolverInTests> solver_named_by_environment(Index size, SolverFor use);

/// `Default`, unless the environment variable names another solver.
template <class Default, SolverFor use>
class NamedSolver {
 public:
  using Unsymmetric = NamedSolver<Default, use == SolverFor::steps ? SolverFor::unsymmetric_steps : use>;

  void analyse(Index size, std::span<Block const> blocks) {
    other_ = solver_named_by_environment(size, use);
    other_ ? other_->analyse(size, blocks) : default_.analyse(size, blocks);
  }
  void begin() { other_ ? other_->begin() : default_.begin(); }
  void add(Index row, Index col, BlockView const& b) { other_ ? other_->add(row, col, b) : default_.add(row, col, b); }
  Index factor() { return other_ ? other_->factor() : default_.factor(); }
  bool reordered() const {
    if (other_) return other_->reordered();
    if constexpr (requires { default_.reordered(); }) return default_.reordered();
    return false;
  }
  std::size_t reorderings() const {
    if (other_) return other_->reorderings();
    if constexpr (requires { default_.reorderings(); }) return default_.reorderings();
    return 0;
  }
  void limit_reorderings(std::size_t count) noexcept {
    if (other_) return other_->limit_reorderings(count);
    if constexpr (requires { default_.limit_reorderings(count); }) default_.limit_reorderings(count);
  }
  std::span<Index const> dropped() const {
    if (other_) return other_->dropped();
    if constexpr (requires { default_.dropped(); }) return default_.dropped();
    return {};
  }
  void solve(VecX const& b, VecX& x) const { other_ ? other_->solve(b, x) : default_.solve(b, x); }
  void mark_redundant(std::span<Index const> unknowns)
    requires requires(Default s) { s.mark_redundant(unknowns); }
  {
    other_ ? other_->mark_redundant(unknowns) : default_.mark_redundant(unknowns);
  }
  bool is_doubtful(double share) const
    requires requires(Default const s) { s.is_doubtful(share); }
  {
    return other_ ? other_->is_doubtful(share) : default_.is_doubtful(share);
  }
  Sequence<IndexMap<double>> null_vectors(VecX const& sizes) const
    requires requires(Default const s) { s.null_vectors(sizes); }
  {
    return other_ ? other_->null_vectors(sizes) : default_.null_vectors(sizes);
  }
  double sign_of_determinant() const
    requires requires(Default const s) { s.sign_of_determinant(); }
  {
    return other_ ? other_->sign_of_determinant() : default_.sign_of_determinant();
  }

 private:
  Default default_;
  std::unique_ptr<SolverInTests> other_;
};

using DefaultSolver = NamedSolver<BlockSolver, SolverFor::steps>;
using DefaultStaticSolver = NamedSolver<AutoLu, SolverFor::statics>;

}  // namespace polybody
