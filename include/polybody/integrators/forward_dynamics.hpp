#pragma once
/// \file
/// Accelerations and multipliers of a state, and projections onto the constraint equations. The matrix of all
/// linear equations is [M, Gᵀ; G, 0] [thesis Eq. 3.2].
/// Theory: Eqs. 5.2, 6.27, 9.45.

#include <algorithm>
#include <memory>
#include <span>

#include <polybody/math/vectors.hpp>
#include <polybody/solvers/constant_block_cache.hpp>
#include <polybody/solvers/default_solver.hpp>
#include <polybody/solvers/tangent_solver.hpp>

namespace polybody {

/// Feedback of a constraint violation in the accelerations: Φ̈ + rate Φ̇ + position Φ = 0.
struct ConstraintFeedback {
  double rate = 0.0;      ///< factor of Φ̇ [1/s]
  double position = 0.0;  ///< factor of Φ [1/s²]
};

/// Measure of the distance from a singular configuration; both numbers are larger near such a configuration.
struct ConstraintGain {
  double moved = 0.0;       ///< largest change of a velocity that corrects violations of ±1 [1]
  std::size_t dropped = 0;  ///< number of redundant constraint equations
  /// True if the configuration is singular compared with a `usual` one: it has more redundant equations, or `moved` is
  /// more than ten times as large.
  bool far_above(ConstraintGain const& usual) const { return dropped > usual.dropped || moved > 10.0 * usual.moved; }
};

namespace detail {
/// Part of a message that names the first force element with a force that is NaN, infinite or above `largest_number`;
/// empty if there is none.
template <class = void>
std::string whose_force(System const& s) {
  for (AppliedWrench<double> const& action : s.data().actions)
    for (double const w : action.w)
      if (!(std::abs(w) <= largest_number))
        return sentence_of({" (force element \"", s.layout().forces[std::size_t(action.source)].name, "\")"});
  return "";
}
/// Sentence of a message that names the force element of `whose_force` as a possible cause; empty if there is none.
template <class = void>
std::string and_whose_force(System const& s) {
  std::string const whose = whose_force(s);
  return whose.empty() ? "" : " A force is not finite or too large" + whose + '.';
}
/// \throws NonFiniteValue naming body, force element and time if an entry of x (nv) is NaN, infinite or above
/// `largest_number`.
template <class = void>
void require_finite_force(System const& s, VecX const& x) {
  if (Index const i = first_not_finite(x); i >= 0)
    throw NonFiniteValue(
        "force.not_finite",
        {"A force on ", ErrorObject{s.name_of(i)}, non_finite_suffix(x[i]), " at t = ", ErrorTime{s.at().t}, " s",
         whose_force(s), ". Check the forces applied to it (their markers may coincide) and the preceding state."});
}
/// \throws NonFiniteValue naming joint and time if an entry of x (rows) is NaN, infinite or above `largest_number`.
template <class = void>
void require_finite_rows(System const& s, VecX const& x) {
  if (Index const i = first_not_finite(x); i >= 0)
    throw NonFiniteValue("motion.not_finite",
                         {"The motion at ", ErrorObject{s.name_of(s.velocities() + i)}, non_finite_suffix(x[i]),
                          " at t = ", ErrorTime{s.at().t},
                          " s. Check the state before this time, or take a smaller step.", and_whose_force(s)});
}
/// Checks the state of the last evaluation, before the matrix at this state is reported as singular. \throws
/// NonFiniteValue if a coordinate or velocity is NaN, infinite or above `largest_number`.
template <class = void>
void require_finite_place(System const& s) {
  auto const& [q, v, t] = s.at();
  Index const in_v = first_not_finite(v), in_q = in_v < 0 ? first_not_finite(q) : -1;
  if (in_v < 0 && in_q < 0) return;
  throw NonFiniteValue(
      "motion.not_finite",
      {"The motion of ", ErrorObject{in_v < 0 ? s.layout().name_of_coordinate(in_q) : s.layout().name_of(in_v)},
       non_finite_suffix(in_v < 0 ? q[in_q] : v[in_v]), " at t = ", ErrorTime{t},
       " s. Check the forces on it, or take a smaller step.", and_whose_force(s)});
}
/// Reports that the equations at the last evaluation, with right-hand side `rhs`, have no finite solution. The message
/// names an entry of the state or of `rhs` that is NaN, infinite or above `largest_number`. Otherwise the matrix is
/// singular, and the message names `who`, the owner of the first missing pivot.
template <class = void>
[[noreturn, gnu::cold]] void throw_unsolvable(System const& s, VecX const& rhs, std::string const& who) {
  double const t = s.at().t;
  require_finite_place(s);
  if (Index const i = first_not_finite(rhs); i >= 0)
    throw NonFiniteValue("force.not_finite", {"The right-hand side of ", ErrorObject{s.name_of(i)},
                                              non_finite_suffix(rhs[i]), " at t = ", ErrorTime{t},
                                              " s. Check the forces on it and its velocity.", and_whose_force(s)});
  throw SingularMatrix("motion.singular", {"The equations of motion have no unique acceleration at t = ", ErrorTime{t},
                                           " s: their matrix is singular at ", ErrorObject{who},
                                           ". Check for a redundant joint, or for a free body without inertia."});
}

/// Flags of the unknowns of the linear equations: true for velocities of bodies with a constant mass matrix.
template <class = void>
Sequence<bool> constant_unknowns(System const& s) {
  Sequence<bool> out(std::size_t(equations_of(s)), false);
  Coordinates const& c = s.step_coordinates();
  if (c && c.reduced->full_unknown.empty()) return out;
  Sequence<bool> constant(std::size_t(s.layout().velocities), false);
  for (BodyLayout const& b : s.layout().bodies) std::fill_n(constant.begin() + b.v0, b.velocities, b.constant_mass);
  for (Index i = 0; i < equation_velocities_of(s); ++i) {
    Index const full = c ? c.reduced->full_unknown[std::size_t(i)] : i;
    if (full >= 0 && full < s.layout().velocities) out[std::size_t(i)] = constant[std::size_t(full)];
  }
  return out;
}

}  // namespace detail

/// Accelerations, multipliers and projections by one factorisation of [M, Gᵀ; G, 0].
template <LinearSolver Solver = DefaultSolver>
class ForwardDynamics {
 public:
  /// Allocates all memory for the system, which must outlive this object.
  [[gnu::cold]] explicit ForwardDynamics(System& system)
      : zero_a_(VecX::Zero(system.velocities())),
        zero_lambda_(VecX::Zero(system.rows())),
        r_(VecX::Zero(system.velocities())),
        phi_(VecX::Zero(system.rows())),
        open_(phi_),
        rhs_(VecX::Zero(system.size())),
        x_(VecX::Zero(system.size())),
        delta_(VecX::Zero(system.velocities())),
        next_(VecX::Zero(system.coordinates())) {
    by_tree_ = system.step_coordinates() && system.step_coordinates().reduced->solves_by_bodies && system.rows() == 0;
    if (by_tree_) only_weight_ = under_gravity_only(system);
    solver_ = solver_for(system);
    solver_->analyse(system, 1, [&](BlockSink& sink) { system.masses(sink); });
  }

  /// Solves M a + Gᵀλ = f, G a = −γ − `feedback` at the coordinates, velocities and time `at`. \throws SingularMatrix,
  /// NonFiniteValue.
  void accelerations(System& system, At<double> const& at, VecX& a, VecX& lambda,
                     ConstraintFeedback const& feedback = {}) {
    if (by_tree_ && accelerations_of_tree(system, at, a)) return lambda.resize(0);
    system.evaluate(at.q, at.v, at.t);
    factor(system);
    system.residual(zero_a_, zero_lambda_, r_);
    detail::require_finite_force(system, r_);
    system.acceleration_bias(phi_);
    if (feedback.rate != 0.0) {
      system.violation_rate(open_);
      for (Index i = 0; i < phi_.size(); ++i) phi_[i] += feedback.rate * open_[i];
    }
    if (feedback.position != 0.0) {
      system.violation(open_);
      for (Index i = 0; i < phi_.size(); ++i) phi_[i] += feedback.position * open_[i];
    }
    detail::require_finite_rows(system, phi_);
    solve(system, -1.0, -1.0);
    take(0, system.velocities(), a);
    take(system.velocities(), system.rows(), lambda);
    if (!system.data().multipliers.empty()) follow_reactions(system, a, lambda);
  }

  /// Applies to v the smallest change (in the norm of M) that satisfies G v + Φ_t = 0. Returns max |change|.
  double project_velocities(System& system, VecX const& q, VecX& v, double t) {
    if (system.rows() == 0) return 0.0;
    system.evaluate(q, v, t);
    factor(system);
    system.violation_rate(phi_);
    solve(system, 0.0, -1.0);
    take(0, system.velocities(), delta_);
    for (Index i = 0; i < v.size(); ++i) v[i] += delta_[i];
    return largest_size(delta_);
  }

  /// Performs one Gauss–Newton step towards Φ = 0 with the smallest change of q (in the norm of M). Returns max |Φ|
  /// before the step.
  double project_positions_once(System& system, VecX& q, VecX const& v, double t) {
    system.evaluate(q, v, t);
    system.violation(phi_);
    double const before = largest_size(phi_);
    if (before == 0.0) return before;
    factor(system);
    solve(system, 0.0, -1.0);
    take(0, system.velocities(), delta_);
    next_ = q;
    system.plus(q, delta_, next_);
    q.swap(next_);
    return before;
  }

  /// Evaluates the system at (q, v, t) and factorises the matrix for `least_change`.
  void hold(System& system, VecX const& q, VecX const& v, double t) {
    system.evaluate(q, v, t);
    factor(system);
  }

  /// out = −M⁻¹Gᵀ(G M⁻¹Gᵀ)⁻¹ φ: smallest change (in the norm of M) with G out = −φ, for M and G of the last
  /// factorisation.
  void least_change(System& system, VecX const& phi, VecX& out) {
    phi_ = phi;
    solve(system, 0.0, -1.0);
    take(0, system.velocities(), out);
  }

  /// Largest change of a velocity that corrects violations of ±1 at (q, v, t), and number of redundant equations. Near
  /// a singular configuration this change grows as 1/σ, with the least singular value σ of the constraint Jacobian.
  ConstraintGain constraint_gain(System& system, VecX const& q, VecX const& v, double t) {
    hold(system, q, v, t);
    for (Index i = 0; i < open_.size(); ++i) open_[i] = scattered_sign(i);
    least_change(system, open_, delta_);
    return {largest_size(delta_), redundant_rows().size()};
  }

  /// True if the constraint Jacobian is much closer to a loss of rank at `there` than at a configuration with the gain
  /// `usual` (`ConstraintGain::far_above`), or if the matrix at `there` is singular.
  bool is_singular(System& system, At<double> const& there, ConstraintGain const& usual) {
    try {
      return constraint_gain(system, there.q, there.v, there.t).far_above(usual);
    } catch (SingularMatrix const&) {  // from a solver that drops no redundant equations
      return true;
    }
  }
  /// True if the constraint Jacobian is much closer to a loss of rank at `there` than at `here`
  /// (`ConstraintGain::far_above`), or if the matrix at one of them is singular.
  bool loses_rank(System& system, At<double> const& here, At<double> const& there) {
    try {
      return is_singular(system, there, constraint_gain(system, here.q, here.v, here.t));
    } catch (SingularMatrix const&) {
      return true;
    }
  }

  /// out = P b with P = M⁻¹Gᵀ(G M⁻¹Gᵀ)⁻¹ G at (q, v, t): the part of b that the position constraints determine. The
  /// rows of G out for nonholonomic equations are zero.
  void constrained_part(System& system, VecX const& q, VecX const& v, double t, VecX const& b, VecX& out) {
    system.evaluate(q, v, t);
    factor(system);
    system.rows_times(b, phi_);
    for (Index const i : system.nonholonomic_equations()) phi_[i] = 0.0;
    solve(system, 0.0, 1.0);
    take(0, system.velocities(), out);
  }

  /// Solves M a + Gᵀμ = w, G a = 0 with M and G of the last factorisation: acceleration and reactions due to a force w
  /// (nv). Multipliers μ of redundant equations are zero.
  void response(System& system, VecX const& w, VecX& a, VecX& mu) {
    r_ = w;
    phi_.setZero();
    solve(system, 1.0, 0.0);
    take(0, system.velocities(), a);
    take(system.velocities(), system.rows(), mu);
  }

  /// Number of changes of the elimination order; 0 for solvers with a fixed order.
  std::size_t reorderings() const { return solver_->reorderings(); }
  /// Reverts all changes of the elimination order except the first `count`, for later factorisations.
  void limit_reorderings(std::size_t count) noexcept { solver_->limit_reorderings(count); }
  /// Indices of the redundant equations of the last factorisation (see `name_of_equation`). Their multipliers are not
  /// unique and are set to zero. Empty for solvers that do not report redundant equations.
  std::span<Index const> redundant_rows() const { return solver_->dropped(); }
  /// Every later factorisation drops these redundant `equations` (`leave_out_redundant` selects them).
  [[gnu::cold]] void mark_redundant(Sequence<Index> equations) {
    left_out_ = std::move(equations);
    solver_->mark_redundant(left_out());
  }
  bool leaves_out() const { return !left_out_.empty(); }  ///< true if equations are marked as redundant
  std::span<Index const> left_out() const { return {left_out_.data(), left_out_.size()}; }  ///< marked equations
  /// True if the selection of `mark_redundant` must be checked: the last factorisation dropped more equations or found
  /// a relative pivot of at most 1e-3 (`BlockFactor::is_doubtful`), or `note_doubt` was called.
  bool is_doubtful() const { return doubtful_ || solver_->is_doubtful(); }
  void note_doubt() { doubtful_ = true; }    ///< sets `is_doubtful` until `clear_doubt`
  void clear_doubt() { doubtful_ = false; }  ///< resets `is_doubtful`, after a new selection
  /// Computes the null vectors of `redundant_rows` in the last factorisation for equations of these `sizes`; entries
  /// are numbered as equations. Empty for solvers that compute no null vectors. See `BlockFactor::null_vectors`.
  Sequence<IndexMap<double>> null_vectors(VecX const& sizes) { return solver_->null_vectors(sizes); }
  /// Names of the joints and bodies with redundant equations.
  std::vector<std::string> redundant(System const& system) const {
    std::vector<std::string> names;
    ModelLayout const& layout = system.layout();
    Sequence<Index> const joint_of = system.step_coordinates() ? Sequence<Index>() : layout.joint_of_rows();
    for (Index const i : solver_->dropped()) {
      Index const row = i - system.velocities();
      Index const joint = row >= 0 && std::size_t(row) < joint_of.size() ? joint_of[std::size_t(row)] : -1;
      std::string name = joint >= 0 ? layout.joints[std::size_t(joint)].title() : name_of_equation(system, i);
      if (names.empty() || names.back() != name) names.push_back(std::move(name));
    }
    return names;
  }

 private:
  /// Computes the accelerations by the articulated-body algorithm. Returns false if a pivot is missing or if they are
  /// not finite; the equations of the full model then identify the reason.
  bool accelerations_of_tree(System& system, At<double> const& at, VecX& a) {
    Coordinates const& c = system.step_coordinates();
    VecX const* residual = nullptr;
    if (!only_weight_) {
      system.evaluate(at.q, at.v, at.t);
      residual = &residual_at_rest(system);
    }
    a.resize(system.velocities());
    Index const bad = c->accelerations(at.q, at.v, system.load_factor, residual, a);
    return bad < 0 && first_not_finite(a) < 0;
  }

  /// Repeats the solution of `accelerations` until the forces that follow reactions belong to λ. \throws
  /// NewtonConvergenceFailure
  [[gnu::cold]] void follow_reactions(System& system, VecX& a, VecX& lambda) {
    for (int k = 0; k < 200; ++k) {
      open_ = lambda;
      system.residual(zero_a_, open_, r_);
      system.rows_transposed_times(open_, delta_);
      r_ -= delta_;
      detail::require_finite_force(system, r_);
      solve(system, -1.0, -1.0);
      take(0, system.velocities(), a);
      take(system.velocities(), system.rows(), lambda);
      open_ -= lambda;
      if (largest_size(open_) <= 1e-12 * largest_size(lambda)) return;
    }
    throw NewtonConvergenceFailure(
        "motion.friction",
        {"The reactions at t = ", ErrorTime{system.at().t}, " s do not converge with the ", ErrorObject{"friction"},
         " that follows them: the friction locks the mechanism. Use a smaller "
         "coefficient, or an implicit integrator."});
  }

  /// Solver of [M, Gᵀ; G, 0]. If the matrix has constant parts, the solver factorises them only once.
  [[gnu::cold]] static std::unique_ptr<LinearEquations> solver_for(System& system) {
    Sequence<bool> constant = detail::constant_unknowns(system);
    bool const changes = system.rows() > 0 || !has_constant_mass(system);
    if (changes && std::find(constant.begin(), constant.end(), true) != constant.end()) {
      PatternSink pattern;
      system.masses(pattern);
      auto parts = std::make_unique<TangentSolver<ConstantBlockCache<StepSolver<Solver>>>>();
      if (parts->linear_solver().keep(std::move(constant), pattern.blocks) > 0) return parts;
    }
    return std::make_unique<TangentSolver<StepSolver<Solver>>>();
  }

  void factor(System& system) {
    if (system.rows() == 0 && factored_ && has_constant_mass(system)) return;
    Index const bad = solver_->factor([&](BlockSink& sink) { system.masses(sink); });
    if (bad >= 0) detail::throw_unsolvable(system, {}, name_of_equation(system, bad));
    factored_ = true;
  }

  /// Solves [M, Gᵀ; G, 0] x = [r_scale r; phi_scale φ] for x.
  void solve(System& system, double r_scale, double phi_scale) {
    Index const n = system.velocities();
    for (Index i = 0; i < n; ++i) rhs_[i] = r_scale == 0.0 ? 0.0 : r_scale * r_[i];
    for (Index i = 0; i < system.rows(); ++i) rhs_[n + i] = phi_scale * phi_[i];
    solver_->solve(rhs_, x_);
    if (Index const i = first_not_finite(x_); i >= 0) detail::throw_unsolvable(system, rhs_, system.name_of(i));
  }

  /// Copies n entries of x_ from entry `first` on to out.
  void take(Index first, Index n, VecX& out) const {
    out.resize(n);
    std::copy_n(x_.data() + first, n, out.data());
  }

  std::unique_ptr<LinearEquations> solver_;
  bool factored_ = false;
  bool by_tree_ = false, only_weight_ = false, doubtful_ = false;
  Sequence<Index> left_out_;
  VecX zero_a_, zero_lambda_, r_, phi_, open_, rhs_, x_, delta_, next_;
};

}  // namespace polybody
