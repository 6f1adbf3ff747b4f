#pragma once
/// \file
/// Linear equations of an integrator (`TangentSolver`), with their size and the names of their unknowns.

#include <algorithm>
#include <limits>
#include <span>

#include <polybody/math/index_map.hpp>
#include <polybody/math/vectors.hpp>
#include <polybody/solvers/redundancy_dropping.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

/// True if gravity is the only applied force: no force element, compliant joint or force of a body acts.
template <class = void>
[[gnu::cold]] bool under_gravity_only(System const& s) {
  if (!s.step_coordinates().reduced->moves_by_newton_euler || !s.data().actions.empty()) return false;
  for (ConstraintBlock<double> const& block : s.data().rows)
    if (block.source != ConstraintSource::joint) return false;
  return true;
}

/// Linear equations in the unknowns of a time step, for any linear solver.
class LinearEquations {
 public:
  virtual ~LinearEquations() = default;

  /// Allocates all memory. \param copies number of copies of the unknowns, for example one for each stage of a method
  /// \throws InvalidInput for several copies in a model with `joint_coordinates::ArticulatedBody`
  virtual void analyse(System& system, Index copies, BlockWriter const& write) = 0;
  /// Writes and factorises the matrix in the state of the last evaluation of the system. Returns −1 on success,
  /// otherwise the index of an equation without a pivot, for `name_of_equation`.
  virtual Index factor(BlockWriter const& write) = 0;
  /// Solution x for the right-hand side `rhs`, both in the unknowns of the time step.
  virtual void solve(VecX const& rhs, VecX& x) = 0;

  /// Number of changes of the elimination order; 0 for solvers with a fixed order.
  virtual std::size_t reorderings() const = 0;
  /// Reverts all changes of the elimination order except the first `count`, for later factorisations.
  virtual void limit_reorderings(std::size_t count) noexcept = 0;
  /// Indices of the equations that the last factorisation dropped as redundant; empty for solvers that do not list
  /// them.
  virtual std::span<Index const> dropped() const = 0;
  /// Makes every later factorisation drop these constraint equations. No effect for several copies, for the
  /// articulated-body algorithm, and for solvers without `mark_redundant`.
  virtual void mark_redundant(std::span<Index const> equations) = 0;
  /// True if the last factorisation dropped more equations than `mark_redundant` lists, or has relative pivots of at
  /// most 1e-3 in closing joints: see `BlockFactor::is_doubtful`.
  virtual bool is_doubtful() const = 0;
  /// Computes the null vectors of the dropped equations, in the unknowns of the linear equations
  /// (`BlockFactor::null_vectors`). Empty if the linear solver does not provide null vectors. \param sizes
  /// typical magnitudes of all equations
  virtual Sequence<IndexMap<double>> null_vectors(VecX const& sizes) = 0;
};

/// Linear equations of an integrator in the unknowns of a time step. The system writes the matrix, and `Solver`
/// factorises and solves. Models with `joint_coordinates::ArticulatedBody` use the articulated-body algorithm instead
/// of `Solver`.
template <LinearSolver Solver>
class TangentSolver final : public LinearEquations {
 public:
  [[gnu::cold]] void analyse(System& system, Index copies, BlockWriter const& write) override {
    copies_ = copies;
    coordinates_ = system.step_coordinates();
    size_ = system.size();
    equations_ = coordinates_ ? coordinates_.reduced->equations : size_;
    if (coordinates_) frozen_ = coordinates_->make_frozen();
    by_recursion_ = solves_by_bodies() && system.rows() == 0 && under_gravity_only(system);
    if (solves_by_bodies()) {
      if (copies > 1)
        throw InvalidInput("solver.stages", {ErrorObject{"joint_coordinates::ArticulatedBody"},
                                             " cannot solve for all stages of a method together. Use "
                                             "joint_coordinates::Augmented."});
    } else {
      PatternSink pattern;
      BlockSink sink(pattern);
      write(sink);
      solver_.analyse(copies * equations_, pattern.blocks);
    }
    if (coordinates_) {
      rhs_.setZero(copies * equations_);
      x_ = rhs_;
      part_.setZero(size_);
      solution_ = part_;
      equation_.setZero(equations_);
    }
  }

  /// Factorises the tangent of the residual at x. Returns −1 on success, otherwise the index of an equation without a
  /// pivot, for `name_of_equation`.
  Index factor_tangent(System& system, StepPosition const& x, TangentCoefficients const& k, SecondOrder second) {
    if (by_recursion_) return frozen_->factor_balance(x, system.load_factor, k);
    return factor([&](BlockSink& sink) { system.tangent(k, second, x.lambda, sink); });
  }

  Index factor(BlockWriter const& write) override {
    if (coordinates_) frozen_->freeze();
    if (solves_by_bodies()) return frozen_->factor(write);
    Index const bad = write_and_factor(solver_, write);
    fewest_dropped_ = std::min(fewest_dropped_, dropped().size());
    return bad;
  }

  /// Assigns the coordinates of the last evaluation of the system to copy k. Call it while the matrix is written.
  /// Without this call, all copies use the coordinates of the last evaluation before `factor`.
  [[gnu::cold]] void hold_copy(std::size_t k) {
    if (!coordinates_) return;
    while (by_copy_.size() <= k) by_copy_.push_back(coordinates_->make_frozen());
    by_copy_[k]->freeze();
  }

  /// True if recursions over the tree of bodies factorise the tangent and compute the residual
  /// (`StepCoordinates::balance`). Gravity is then the only force.
  bool by_recursion() const { return by_recursion_; }

  /// Linear solver that `analyse` sets up.
  Solver& linear_solver() { return solver_; }

  std::size_t reorderings() const override {
    if constexpr (requires { solver_.reorderings(); })
      return solver_.reorderings();
    else
      return 0;
  }
  void limit_reorderings(std::size_t count) noexcept override {
    if constexpr (requires { solver_.limit_reorderings(count); }) solver_.limit_reorderings(count);
  }

  /// True if the last factorisation dropped more equations than an earlier one. The system is then in a singular
  /// configuration. In other states the additional equations are independent, and the factorisation would not enforce
  /// them.
  bool lost_rank() const { return dropped().size() > fewest_dropped_; }

  [[gnu::cold]] void mark_redundant(std::span<Index const> equations) override {
    if constexpr (requires { solver_.mark_redundant(equations); }) {
      if (solves_by_bodies() || copies_ != 1) return;
      solver_.mark_redundant(equations);
      fewest_dropped_ = std::numeric_limits<std::size_t>::max();
    }
  }
  [[gnu::cold]] bool is_doubtful() const override {
    if constexpr (requires { solver_.is_doubtful(1e-3); }) return !solves_by_bodies() && solver_.is_doubtful(1e-3);
    return false;
  }
  [[gnu::cold]] Sequence<IndexMap<double>> null_vectors(VecX const& sizes) override {
    if constexpr (requires { solver_.null_vectors(sizes); }) return solver_.null_vectors(sizes);
    return {};
  }

  void solve(VecX const& rhs, VecX& x) override {
    if (!coordinates_) return solver_.solve(rhs, x);
    if (solves_by_bodies()) return frozen_->solve(rhs, x);
    Index const n = size_, m = equations_;
    for (Index k = 0; k < copies_; ++k) {
      std::copy_n(rhs.data() + k * n, n, part_.data());
      frozen_of(k).to_equations(part_, equation_);
      std::copy_n(equation_.data(), m, rhs_.data() + k * m);
    }
    solver_.solve(rhs_, x_);
    for (Index k = 0; k < copies_; ++k) {
      std::copy_n(x_.data() + k * m, m, equation_.data());
      frozen_of(k).from_equations(equation_, solution_);
      std::copy_n(solution_.data(), n, x.data() + k * n);
    }
  }

  std::span<Index const> dropped() const override {
    if constexpr (requires { solver_.dropped(); })
      return solver_.dropped();
    else
      return {};
  }

 private:
  /// State of the coordinates for copy k.
  FrozenMaps& frozen_of(Index k) const {
    return std::size_t(k) < by_copy_.size() ? *by_copy_[std::size_t(k)] : *frozen_;
  }
  bool solves_by_bodies() const { return coordinates_ && coordinates_.reduced->solves_by_bodies; }

  Solver solver_;
  Coordinates coordinates_;
  std::shared_ptr<FrozenMaps> frozen_;
  Sequence<std::shared_ptr<FrozenMaps>> by_copy_;  // states of the copies, if set by `hold_copy`
  bool by_recursion_ = false;
  std::size_t fewest_dropped_ = std::numeric_limits<std::size_t>::max();
  Index copies_ = 1, size_ = 0, equations_ = 0;
  VecX rhs_, x_, part_, solution_, equation_;
};

/// Number of unknowns of the linear equations of a system; the velocities are the first of them.
inline Index equations_of(System const& s) {
  return s.step_coordinates() ? s.step_coordinates().reduced->equations : s.size();
}
/// Number of velocities among the unknowns of the linear equations of a system.
inline Index equation_velocities_of(System const& s) {
  return s.step_coordinates() ? s.step_coordinates().reduced->equation_velocities : s.velocities();
}
/// Name of the body or joint to which unknown i of the linear equations belongs.
template <class = void>
std::string name_of_equation(System const& s, Index i) {
  if (!s.step_coordinates() || s.step_coordinates().reduced->full_unknown.empty()) return s.name_of(i);
  Index const full = s.step_coordinates().reduced->full_unknown[std::size_t(i)];
  return full >= 0 ? s.layout().name_of(full) : "unknown";
}

}  // namespace polybody
