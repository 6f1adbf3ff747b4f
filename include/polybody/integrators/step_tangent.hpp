#pragma once
/// \file
/// Equations of an implicit step: evaluation, residual, corrections of Newton's method, and tangent.

#include <polybody/solvers/gmres.hpp>
#include <polybody/solvers/tangent_solver.hpp>
#include <polybody/system/contact_coupling.hpp>

namespace polybody {

/// Equations of an implicit step with their tangent, with or without the second-order terms ∂(Gᵀλ)/∂q and ∂(Jᵀw)/∂q,
/// which have the factor ck of `TangentCoefficients`. These terms cost as much as all other terms and seldom save an
/// iteration. A step that does not converge activates them for eight steps. If another step does not converge within
/// the same number of steps after the end of this period, the next period is twice as long. This occurs near singular
/// configurations.
template <LinearSolver Solver>
class StepTangent {
 public:
  /// Allocates the memory for steps with or without second-order `terms`. \param lambda multipliers; only their number
  /// matters, because the sparsity pattern does not depend on their values
  [[gnu::cold]] void analyse(System& system, SecondOrder terms, VecX const& lambda) {
    begins_with_ = terms == SecondOrder::included;
    has_second_ = false;
    first_.analyse(system, 1, [&](BlockSink& sink) { system.tangent({1.0, 1.0, 1.0}, terms, lambda, sink); });
    coordinates_ = system.step_coordinates();
    carries_multipliers_ = multipliers_of(system) > system.rows();
    if (carries_multipliers_) {
      balance_.setZero(coordinates_.reduced->equations);
      solution_ = balance_;
      full_q_.setZero(system.layout().coordinates);
      full_v_.setZero(system.layout().velocities);
    }
    // D has an inverse without multipliers and first-order states
    couples_ = !system.data().found_pairs.empty() && !coordinates_ && system.rows() == 0 && system.layout().states == 0;
    if (couples_) {
      coupling_.reserve(4 * system.velocities());
      coupling_.ratios.reserve(2 * system.velocities());
      gmres_.resize(system.velocities());
    }
    left_out_.clear();
    forget();
  }
  /// Deactivates the second-order terms that failed steps activated, and resets the number of steps for which they
  /// stay active. Called at the start of a run.
  void forget() {
    included_ = went_ = false;
    left_ = since_ = 0;
    stay_ = shortest_stay;
    coupling_.ratios.forget();
  }
  /// Starts the tangents of a step. The first tangent uses the friction ratios of the last tangent.
  void begin_step() {
    coupling_.ratios.begin_step();
    factored_ = 0;
    exact_contacts_ = false;
  }

  /// Every later factorisation drops these redundant `equations`.
  void mark_redundant(std::span<Index const> equations) {
    if (std::equal(equations.begin(), equations.end(), left_out_.begin(), left_out_.end())) return;
    left_out_ = Sequence<Index>(equations.begin(), equations.end());
    first_.mark_redundant(equations);
    if (has_second_) second_.mark_redundant(equations);
  }

  /// Evaluates the system, unless it is a tree under weight alone, whose recursions do not need the evaluation.
  void evaluate(System& system, At<double> const& at) const {
    if (!first_.by_recursion()) system.evaluate(at.q, at.v, at.t);
  }
  /// r = M a − f + Gᵀλ at x, the state of the last evaluation. If multiplier estimates are stored
  /// (`carries_multipliers`), this object stores the residual of the full model and sets r to zero; r is then available
  /// from `System::residual`.
  void balance(System& system, StepPosition const& x, VecX& r) {
    if (first_.by_recursion()) return coordinates_->balance(x, system.load_factor, r);
    if (!carries_multipliers_) return system.residual(x.a, x.lambda, r);
    coordinates_->balance_to_equations(residual_of_bodies(system, x.a, x.lambda), balance_);
    r.setZero();
  }
  /// False if the residual that the last `balance` stored is not finite.
  bool is_finite() const { return !carries_multipliers_ || all_finite(balance_); }
  /// Computes the correction y of a step: accelerations and all multipliers of the system. `rhs` contains −r of the
  /// last `balance` and the right-hand sides of the constraint equations. If multiplier estimates are stored, the
  /// equations of all bodies are solved for the residual of the full model, and the solution is projected on the joints
  /// of the current iterate. With −Tᵀr as right-hand side, a reused factorisation would transfer forces from body to
  /// body with outdated moment arms, and this error would grow from joint to joint.
  void correct(VecX const& rhs, VecX& y) {
    if (!coupling_.empty()) return solve_coupled(rhs, y);
    if (!carries_multipliers_) return solver().solve(rhs, y);
    coordinates_->rows_to_equations(rhs.data() + coordinates_.reduced->velocities, balance_);
    solver().linear_solver().solve(balance_, solution_);
    coordinates_->correction_from_equations(solution_, y);
  }
  /// True if multiplier estimates of eliminated joints are stored. A correction then also reduces the error of the
  /// estimates. The size of the correction does not include this error, so that the contraction rate of another step
  /// does not predict the next correction.
  bool carries_multipliers() const { return carries_multipliers_; }
  /// True if each iteration factorises the tangent, because friction acts between coupled bodies. Newton's method then
  /// converges quadratically, except for the terms that `SlipTangent` omits.
  bool follows_friction() const { return !coupling_.ratios.empty(); }
  /// True if the next tangent of this step contains the derivatives of coupled contacts. They cost more than the
  /// approximate stiffness. The fourth tangent of a step uses them if the contraction rate `theta` exceeds a quarter.
  bool needs_exact_contacts(double theta) {
    return exact_contacts_ = exact_contacts_ || (follows_friction() && factored_ > 2 && theta > 0.25);
  }
  /// Number of repetitions of a step that does not converge, except the last one without μ (`AlphaMethod`).
  static int repetitions(System const& s) { return s.layout().has_groups ? 2 : 1; }
  /// Returns the tree to the state `at` after a factorisation in another state. Requires `carries_multipliers()`.
  void return_to(At<double> const& at) { coordinates_->expand(at.q, at.v, full_q_, full_v_); }
  /// Factorises the tangent at x, the state of the last evaluation. Returns −1 on success, otherwise the index of the
  /// equation without a pivot.
  Index factor(System& system, StepPosition const& x, TangentCoefficients k) {
    if (couples_) k.coupling = &coupling_;
    ++factored_;
    return solver().factor_tangent(system, x, k, terms());
  }

  /// Solver of the present tangent.
  TangentSolver<Solver>& solver() { return included_ ? second_ : first_; }
  /// Second-order terms of the present tangent: included or omitted.
  SecondOrder terms() const { return included_ || begins_with_ ? SecondOrder::included : SecondOrder::omitted; }

  /// Activates second-order terms, and allocates their memory at the first call. \param lambda multipliers; only their
  /// number matters
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
  /// Solves (D + C) y = rhs with the factorised blocks D of all bodies and the blocks C of `coupling_`, as
  /// (1 + C D⁻¹) z = rhs and y = D⁻¹ z.
  void solve_coupled(VecX const& rhs, VecX& y) {
    VecX const& z = gmres_.solve(rhs, coupled_residual, most_coupled_products, [&](VecX const& x, VecX& sum) {
      solver().solve(x, y);
      coupling_.add_product(y, sum);
    });
    solver().solve(z, y);
  }

  static constexpr double coupled_residual = 1e-3;  // relative residual of coupled solutions
  static constexpr int most_coupled_products = 200;
  static constexpr long shortest_stay = 8, longest_stay = 1L << 20;

  TangentSolver<Solver> first_, second_;
  Coordinates coordinates_;
  bool carries_multipliers_ = false;
  VecX balance_, solution_, full_q_, full_v_;
  bool couples_ = false;  ///< true if the blocks of a contact set between bodies are evaluated
  ContactCoupling coupling_;
  int factored_ = 0;             ///< number of factorisations in this step
  bool exact_contacts_ = false;  ///< true if tangents of this step contain the derivatives of coupled contacts
  Gmres gmres_;
  Sequence<Index> left_out_;
  bool begins_with_ = false, has_second_ = false, included_ = false, went_ = false;
  long stay_ = shortest_stay;  ///< length of a period with second-order terms, in steps
  long left_ = 0;              ///< remaining steps of the period
  long since_ = 0;             ///< steps since the end of the last period
};

}  // namespace polybody
