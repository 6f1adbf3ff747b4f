#pragma once
/// \file
/// Linear equations of an integrator (`TangentSolver`), with their size and the names of their unknowns.

#include <algorithm>
#include <limits>
#include <span>

#include <polybody/math/vectors.hpp>
#include <polybody/solvers/redundancy_dropping.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

/// True if weight and inertia are the only forces: no force element, compliant joint or force of a body acts.
template <class = void>
[[gnu::cold]] bool under_gravity_only(System const& s) {
  if (!s.step_coordinates().reduced->moves_by_newton_euler || !s.data().actions.empty()) return false;
  for (ConstraintBlock<double> const& block : s.data().rows)
    if (block.source != ConstraintSource::joint) return false;
  return true;
}

/// Linear equations of an integrator. The system defines the unknowns and writes the matrix; `Solver` factorises and
/// solves. Models with `joint_coordinates::ArticulatedBody` use the articulated-body algorithm instead of `Solver`.
template <LinearSolver Solver>
class TangentSolver {
 public:
  /// Allocates all memory. \param copies number of copies of the unknowns, for example one for each stage of a method
  [[gnu::cold]] void analyse(System& system, Index copies, BlockWriter const& write) {
    copies_ = copies;
    coordinates_ = system.step_coordinates();
    size_ = system.size();
    equations_ = coordinates_ ? coordinates_.reduced->equations : size_;
    if (coordinates_) frozen_ = coordinates_.entries->make_frozen_state(coordinates_.self.get());
    walks_ = false;
    keeps_multipliers_ = copies == 1 && multipliers_of(system) > system.rows();
    if (keeps_multipliers_) {
      balance_.setZero(equations_);
      full_q_.setZero(system.layout().coordinates);
      full_v_.setZero(system.layout().velocities);
    }
    if (solves_by_bodies()) {
      walks_ = system.rows() == 0 && under_gravity_only(system);
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

  /// Evaluates the system, unless it is a tree under weight alone, whose recursions do not need the evaluation.
  void evaluate(System& system, At<double> const& at) const {
    if (!walks_) system.evaluate(at.q, at.v, at.t);
  }
  /// r = M a − f + Gᵀλ at x, the state of the last evaluation. If multiplier estimates are stored
  /// (`carries_multipliers`), the solver stores the residual of the full model and sets r to zero; r is then available
  /// from `System::residual`.
  void balance(System& system, StepPosition const& x, VecX& r) {
    if (walks_) return coordinates_.entries->balance(coordinates_.self.get(), x, system.load_factor, r);
    if (!keeps_multipliers_) return system.residual(x.a, x.lambda, r);
    coordinates_.entries->balance_to_equations(coordinates_.self.get(), residual_of_bodies(system, x.a, x.lambda),
                                               balance_);
    r.setZero();
  }
  /// False if the residual that the last `balance` stored is not finite.
  bool is_finite() const { return !keeps_multipliers_ || all_finite(balance_); }
  /// Computes the correction y of a step: accelerations and all multipliers of the system. `rhs` contains −r of the
  /// last `balance` and the right-hand sides of the constraint equations. If multiplier estimates are stored, the
  /// equations of all bodies are solved for the residual of the full model, and the solution is projected on the joints
  /// of the current iterate. With −Tᵀr as right-hand side, a reused factorisation would transfer forces from body to
  /// body with outdated moment arms, and this error would grow from joint to joint.
  void correct(VecX const& rhs, VecX& y) {
    if (!keeps_multipliers_) return solve(rhs, y);
    coordinates_.entries->rows_to_equations(coordinates_.self.get(), rhs.data() + coordinates_.reduced->velocities,
                                            balance_);
    solver_.solve(balance_, x_);
    coordinates_.entries->correction_from_equations(coordinates_.self.get(), x_, y);
  }
  /// True if multiplier estimates of eliminated joints are stored. A correction then also reduces the error of the
  /// estimates. The size of the correction does not include this error, so that the contraction rate of another step
  /// does not predict the next correction.
  bool carries_multipliers() const { return keeps_multipliers_; }
  /// Returns the tree to the state `at` after a factorisation in another state. Requires `carries_multipliers()`.
  void return_to(At<double> const& at) {
    coordinates_.entries->expand(coordinates_.self.get(), at.q, at.v, full_q_, full_v_);
  }
  /// Factorises the tangent of the residual at x. Returns −1, or the index of an equation without a pivot
  /// (`name_of_equation`).
  Index factor_tangent(System& system, StepPosition const& x, TangentCoefficients const& k, SecondOrder second) {
    if (walks_)
      return coordinates_.entries->factor_balance(coordinates_.self.get(), frozen_.get(), x, system.load_factor, k);
    return factor([&](BlockSink& sink) { system.tangent(k, second, x.lambda, sink); });
  }

  /// Writes and factorises the matrix in the state of the last evaluation of the system. Returns −1, or the index
  /// of an equation without a pivot (`name_of_equation`).
  Index factor(BlockWriter const& write) {
    if (coordinates_) coordinates_.entries->freeze(coordinates_.self.get(), frozen_.get());
    if (solves_by_bodies()) return coordinates_.entries->factor(coordinates_.self.get(), frozen_.get(), write);
    Index const bad = write_and_factor(solver_, write);
    fewest_dropped_ = std::min(fewest_dropped_, dropped().size());
    return bad;
  }

  /// Assigns the coordinates of the last evaluation of the system to copy k. Call it while the matrix is written.
  /// Without this call, all copies use the coordinates of the last evaluation before `factor`.
  [[gnu::cold]] void hold_copy(std::size_t k) {
    if (!coordinates_) return;
    while (by_copy_.size() <= k) by_copy_.push_back(coordinates_.entries->make_frozen_state(coordinates_.self.get()));
    coordinates_.entries->freeze(coordinates_.self.get(), by_copy_[k].get());
  }

  /// Linear solver that `analyse` sets up.
  Solver& linear_solver() { return solver_; }

  /// Number of changes of the elimination order; 0 for solvers with a fixed order.
  std::size_t reorderings() const {
    if constexpr (requires { solver_.reorderings(); })
      return solver_.reorderings();
    else
      return 0;
  }
  /// Reverts all changes of the elimination order except the first `count`, for later factorisations.
  void limit_reorderings(std::size_t count) noexcept {
    if constexpr (requires { solver_.limit_reorderings(count); }) solver_.limit_reorderings(count);
  }

  /// True if the last factorisation dropped more equations than an earlier one. Its state is then a singular
  /// configuration. In other states these equations are independent, and the factorisation would not enforce them.
  bool lost_rank() const { return dropped().size() > fewest_dropped_; }

  /// Makes every later factorisation drop these constraint equations. No effect for several copies, for the
  /// articulated-body algorithm, and for solvers without `mark_redundant`.
  [[gnu::cold]] void mark_redundant(std::span<Index const> equations) {
    if constexpr (requires { solver_.mark_redundant(equations); }) {
      if (solves_by_bodies() || copies_ != 1) return;
      solver_.mark_redundant(equations);
      fewest_dropped_ = std::numeric_limits<std::size_t>::max();
    }
  }
  /// True if the last factorisation dropped more equations than `mark_redundant` lists, or has small pivots of closing
  /// joints: see `BlockFactor::is_doubtful`.
  [[gnu::cold]] bool is_doubtful() const {
    if constexpr (requires { solver_.is_doubtful(1e-3); }) return !solves_by_bodies() && solver_.is_doubtful(1e-3);
    return false;
  }
  /// Computes the null vectors of the dropped equations for equations of these `sizes`, in the unknowns of the linear
  /// equations (`BlockFactor::null_vectors`). Empty if `Solver` does not provide null vectors.
  [[gnu::cold]] Sequence<IndexMap<double>> null_vectors(VecX const& sizes) {
    if constexpr (requires { solver_.null_vectors(sizes); }) return solver_.null_vectors(sizes);
    return {};
  }

  /// Solution x for the right-hand side `rhs`, both in the unknowns of the time step.
  void solve(VecX const& rhs, VecX& x) {
    if (!coordinates_) return solver_.solve(rhs, x);
    if (solves_by_bodies()) return coordinates_.entries->solve(frozen_.get(), rhs, x);
    Index const n = size_, m = equations_;
    for (Index k = 0; k < copies_; ++k) {
      std::copy_n(rhs.data() + k * n, n, part_.data());
      coordinates_.entries->to_equations(coordinates_.self.get(), frozen_of(k), part_, equation_);
      std::copy_n(equation_.data(), m, rhs_.data() + k * m);
    }
    solver_.solve(rhs_, x_);
    for (Index k = 0; k < copies_; ++k) {
      std::copy_n(x_.data() + k * m, m, equation_.data());
      coordinates_.entries->from_equations(coordinates_.self.get(), frozen_of(k), equation_, solution_);
      std::copy_n(solution_.data(), n, x.data() + k * n);
    }
  }

  /// Redundant equations of the last factorisation; empty for solvers that do not list them.
  std::span<Index const> dropped() const {
    if constexpr (requires { solver_.dropped(); })
      return solver_.dropped();
    else
      return {};
  }

 private:
  /// State of the coordinates for copy k.
  void* frozen_of(Index k) const {
    return std::size_t(k) < by_copy_.size() ? by_copy_[std::size_t(k)].get() : frozen_.get();
  }
  bool solves_by_bodies() const { return coordinates_ && coordinates_.reduced->solves_by_bodies; }

  Solver solver_;
  Coordinates coordinates_;
  FrozenState frozen_;
  Sequence<FrozenState> by_copy_;   // states of the copies, if set by `hold_copy`
  bool keeps_multipliers_ = false;  // multiplier estimates of joints with joint coordinates are stored
  bool walks_ = false;              // recursions over the tree compute residual and tangent
  std::size_t fewest_dropped_ = std::numeric_limits<std::size_t>::max();
  Index copies_ = 1, size_ = 0, equations_ = 0;
  VecX rhs_, x_, part_, solution_, equation_, balance_, full_q_, full_v_;
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
