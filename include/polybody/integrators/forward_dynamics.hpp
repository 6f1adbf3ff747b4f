#pragma once
/// \file
/// Accelerations and multipliers of a state, and projections onto the rows: all through the matrix
/// [M, Gᵀ; G, 0] [thesis Eq. 3.2].

#include <algorithm>
#include <span>

#include <polybody/math/vectors.hpp>
#include <polybody/solvers/constant_block_cache.hpp>
#include <polybody/solvers/default_solver.hpp>
#include <polybody/solvers/tangent_solver.hpp>
#include <polybody/system/plausibility_check.hpp>

namespace polybody {

/// What accelerations feed back of a violation of the rows: Φ̈ + rate Φ̇ + position Φ = 0.
struct ConstraintFeedback {
  double rate = 0.0;      ///< [1/s]
  double position = 0.0;  ///< [1/s²]
};

/// How nearly the rows of a place repeat each other.
struct ConstraintGain {
  double moved = 0.0;       ///< largest change of a speed by which rows open by ±1 are closed, relative to that 1
  std::size_t dropped = 0;  ///< rows that do
  /// Whether it is a singular position beside a usual one: rows repeat others there, or moves are ten times as large.
  bool far_above(ConstraintGain const& usual) const { return dropped > usual.dropped || moved > 10.0 * usual.moved; }
};

namespace detail {
/// Names the force element that pushes with a force that is NaN, infinite or too large, where one does.
template <class = void>
std::string whose_force(System const& s) {
  for (AppliedWrench<double> const& action : s.data().actions)
    for (double const w : action.w)
      if (!(std::abs(w) <= largest_number))
        return sentence_of({", that of \"", s.layout().forces[std::size_t(action.source)].name, "\""});
  return "";
}
/// The same as a sentence of its own, for motions that it may have caused.
template <class = void>
std::string and_whose_force(System const& s) {
  std::string const whose = whose_force(s);
  return whose.empty() ? "" : " A force is not finite or too large" + whose + '.';
}
/// \throws NonFiniteValue naming body, force element and time when an entry of x (by speeds) is NaN or infinite.
template <class = void>
void require_finite_force(System const& s, VecX const& x) {
  if (Index const i = first_not_finite(x); i >= 0)
    throw NonFiniteValue(
        "force.not_finite",
        {"A force on ", ErrorObject{s.name_of(i)}, non_finite_suffix(x[i]), " at t = ", ErrorTime{s.at().t}, " s",
         whose_force(s), ". Check the forces applied to it, whose markers may coincide, and the state before."});
}
/// \throws NonFiniteValue naming joint and time when an entry of x (by rows) is NaN or infinite.
template <class = void>
void require_finite_rows(System const& s, VecX const& x) {
  if (Index const i = first_not_finite(x); i >= 0)
    throw NonFiniteValue(
        "motion.not_finite",
        {"The motion at ", ErrorObject{s.name_of(s.velocities() + i)}, non_finite_suffix(x[i]),
         " at t = ", ErrorTime{s.at().t}, " s. Check the state before, or take a smaller step.", and_whose_force(s)});
}
/// What a step ends at. \throws NonFiniteValue naming body and time when a coordinate or a speed is NaN or infinite.
template <class = void>
void require_finite_end(System const& s, VecX const& q, VecX const& v, double t) {
  Index const in_v = first_not_finite(v), in_q = in_v < 0 ? first_not_finite(q) : -1;
  if (in_v < 0 && in_q < 0) return;
  throw NonFiniteValue("motion.not_finite",
                       {"The motion of ", ErrorObject{in_v < 0 ? name_of_coordinate(s, in_q) : s.name_of(in_v)},
                        non_finite_suffix(in_v < 0 ? q[in_q] : v[in_v]), " at t = ", ErrorTime{t},
                        " s. Check its velocity and the forces on it before.", and_whose_force(s)});
}
/// \throws NonFiniteValue when the place of the last evaluation is none: before a matrix is called singular there.
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
/// The equations at the last evaluation, whose right-hand side is `rhs`, have no finite solution. Where numbers in them
/// are too large, that is the reason; else the matrix is singular, first noticed at `who`.
/// \throws NonFiniteValue, SingularMatrix.
template <class = void>
[[noreturn, gnu::cold]] void throw_unsolvable(System const& s, VecX const& rhs, std::string const& who) {
  double const t = s.at().t;
  require_finite_place(s);
  if (Index const i = first_not_finite(rhs); i >= 0)
    throw NonFiniteValue("force.not_finite", {"The right-hand side of ", ErrorObject{s.name_of(i)},
                                              non_finite_suffix(rhs[i]), " at t = ", ErrorTime{t},
                                              " s. Check the forces on it and its velocity.", and_whose_force(s)});
  throw SingularMatrix("motion.singular", {"The equations of motion have no unique acceleration at t = ", ErrorTime{t},
                                           " s; the pivot is lost at ", ErrorObject{who},
                                           ". Check for a redundant joint, or for a free body without inertia."});
}

/// By the unknowns of the linear equations: those that are speeds of bodies whose mass matrix is constant.
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

/// Cost of attempts at a step that failed.
struct AttemptCost {
  int iterations = 0, factorisations = 0, evaluations = 0;  ///< as in `StepReport`
};

/// Accelerations, multipliers and projections by one factorisation of [M, Gᵀ; G, 0].
template <LinearSolver Solver = DefaultSolver>
class ForwardDynamics {
 public:
  /// Allocates all there is to be for the system, which must outlive it.
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
    if (system.rows() > 0 || !has_constant_mass(system))
      solver_.linear_solver().keep(detail::constant_unknowns(system));
    solver_.analyse(system, 1, [&](BlockSink& sink) { system.masses(sink); });
  }

  PlausibilityCheck bounds;  ///< of the run; without limits until it begins
  AttemptCost failed;        ///< sum over failed attempts since the run reset it

  /// A step that is tried. Unless it is kept, the account of the bounds and the solver's order of elimination are as
  /// before it, so that a step taken again has the same bits.
  class Trial {
   public:
    /// Remembers the account and the order of elimination as they are.
    explicit Trial(ForwardDynamics& of) : of_(of), bounds_(of.bounds), reorderings_(of.solver_.reorderings()) {}
    Trial(Trial const&) = delete;
    ~Trial() {
      if (!kept_) of_.solver_.limit_reorderings(reorderings_);
    }
    /// What is tried counts: nothing is put back.
    void keep() {
      bounds_.keep();
      kept_ = true;
    }

   private:
    ForwardDynamics& of_;
    PlausibilityCheck::Trial bounds_;
    std::size_t reorderings_;
    bool kept_ = false;
  };
  Trial attempt() { return Trial(*this); }  ///< begins to try a step

  /// What every step asks before it accepts its end. \throws NonFiniteValue, Diverged.
  void require_end(System& system, StepResult const& end) {
    double const of_velocities = squares(end.v);
    if (!(of_velocities + squares(end.q) <= largest_number * largest_number))
      detail::require_finite_end(system, end.q, end.v, end.t);  // number by number
    bounds.require(system, end, of_velocities);
  }

  /// M a + Gᵀλ = f, G a = −γ − what is fed back, at the coordinates, speeds and time `at`. \throws
  /// SingularMatrix, NonFiniteValue.
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
  }

  /// The smallest change of v (in the norm of M) that satisfies G v + Φ_t = 0. Returns max |change|.
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

  /// One Gauss–Newton step of the smallest change of q (in the norm of M) towards Φ = 0; returns |Φ| before.
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

  /// Factors the matrix at (q, v, t) for `least_change`.
  void hold(System& system, VecX const& q, VecX const& v, double t) {
    system.evaluate(q, v, t);
    factor(system);
  }

  /// out = −M⁻¹Gᵀ(G M⁻¹Gᵀ)⁻¹ φ: the smallest change (in the norm of M) with G out = −φ, with M and G as of the last
  /// factorisation.
  void least_change(System& system, VecX const& phi, VecX& out) {
    phi_ = phi;
    solve(system, 0.0, -1.0);
    take(0, system.velocities(), out);
  }

  /// What rows that are open by ±1 move at (q, v, t): as 1/σ next to a singular position, σ the least singular value of
  /// the rows.
  ConstraintGain constraint_gain(System& system, VecX const& q, VecX const& v, double t) {
    hold(system, q, v, t);
    for (Index i = 0; i < open_.size(); ++i) open_[i] = scattered_sign(i);
    least_change(system, open_, delta_);
    return {largest_size(delta_), redundant_rows().size()};
  }

  /// Whether the rows are much nearer to losing rank at `there` than at a place of `usual` gain.
  bool is_singular(System& system, At<double> const& there, ConstraintGain const& usual) {
    try {
      return constraint_gain(system, there.q, there.v, there.t).far_above(usual);
    } catch (SingularMatrix const&) {  // of a solver that drops no rows
      return true;
    }
  }
  /// Whether the rows are much nearer to losing rank at `there` than at `here`.
  bool loses_rank(System& system, At<double> const& here, At<double> const& there) {
    try {
      return is_singular(system, there, constraint_gain(system, here.q, here.v, here.t));
    } catch (SingularMatrix const&) {
      return true;
    }
  }

  /// P b: the part of b that the rows of positions force, P = M⁻¹Gᵀ(G M⁻¹Gᵀ)⁻¹ G, at (q, v, t); velocity rows have it
  /// zero.
  void constrained_part(System& system, VecX const& q, VecX const& v, double t, VecX const& b, VecX& out) {
    system.evaluate(q, v, t);
    factor(system);
    system.rows_times(b, phi_);
    for (Index const i : system.nonholonomic_equations()) phi_[i] = 0.0;
    solve(system, 0.0, 1.0);
    take(0, system.velocities(), out);
  }

  /// M a + Gᵀμ = w, G a = 0 with M and G as of the last factorisation: what a force w (nv) moves and what the rows hold
  /// of it; μ of rows that repeat others is zero.
  void response(System& system, VecX const& w, VecX& a, VecX& mu) {
    r_ = w;
    phi_.setZero();
    solve(system, 1.0, 0.0);
    take(0, system.velocities(), a);
    take(system.velocities(), system.rows(), mu);
  }

  /// Equations that repeat others (see `name_of_equation`), as of the last factorisation: their multipliers are
  /// not unique and are taken as zero. Empty for solvers that do not tell.
  std::span<Index const> redundant_rows() const { return solver_.dropped(); }
  /// Every later factorisation drops these equations, which are redundant (`leave_out_redundant` chooses them).
  [[gnu::cold]] void mark_redundant(Sequence<Index> equations) {
    left_out_ = std::move(equations);
    solver_.mark_redundant(left_out());
  }
  bool leaves_out() const { return !left_out_.empty(); }                                    ///< any equation
  std::span<Index const> left_out() const { return {left_out_.data(), left_out_.size()}; }  ///< the last ones
  /// Whether the choice of `mark_redundant` must be checked: the last factorisation dropped other equations or found a
  /// small pivot, or `note_doubt` was called.
  bool is_doubtful() const { return doubtful_ || solver_.is_doubtful(); }
  void note_doubt() { doubtful_ = true; }    ///< `is_doubtful` until `clear_doubt`
  void clear_doubt() { doubtful_ = false; }  ///< a choice is made
  /// Null vector `n` of the `dropped` equation of the last factorisation, by equations. See `BlockFactor::null_vector`.
  bool null_vector(Index dropped, VecX& n) { return solver_.null_vector(dropped, n); }
  /// Names of the joints and bodies that they belong to.
  std::vector<std::string> redundant(System const& system) const {
    std::vector<std::string> names;
    for (Index const i : solver_.dropped()) {
      std::string name = name_of_equation(system, i);
      if (names.empty() || names.back() != name) names.push_back(std::move(name));
    }
    return names;
  }

 private:
  /// The same by a tree that is its own solver. False where this has no finite result: the equations of the whole model
  /// then say why.
  bool accelerations_of_tree(System& system, At<double> const& at, VecX& a) {
    Coordinates const& c = system.step_coordinates();
    VecX const* unbalance = nullptr;
    if (!only_weight_) {
      system.evaluate(at.q, at.v, at.t);
      unbalance = &polybody::unbalance(system);
    }
    a.resize(system.velocities());
    Index const bad = c.entries->accelerations(c.self.get(), at.q, at.v, system.load_factor, unbalance, a);
    return bad < 0 && first_not_finite(a) < 0;
  }

  void factor(System& system) {
    if (system.rows() == 0 && factored_ && has_constant_mass(system)) return;
    Index const bad = solver_.factor([&](BlockSink& sink) { system.masses(sink); });
    if (bad >= 0) detail::throw_unsolvable(system, {}, name_of_equation(system, bad));
    factored_ = true;
  }

  /// [M, Gᵀ; G, 0] x = [r_scale r; phi_scale φ].
  void solve(System& system, double r_scale, double phi_scale) {
    Index const n = system.velocities();
    for (Index i = 0; i < n; ++i) rhs_[i] = r_scale == 0.0 ? 0.0 : r_scale * r_[i];
    for (Index i = 0; i < system.rows(); ++i) rhs_[n + i] = phi_scale * phi_[i];
    solver_.solve(rhs_, x_);
    if (Index const i = first_not_finite(x_); i >= 0) detail::throw_unsolvable(system, rhs_, system.name_of(i));
  }

  /// out = x_ from entry `first` on.
  void take(Index first, Index n, VecX& out) const {
    out.resize(n);
    std::copy_n(x_.data() + first, n, out.data());
  }

  TangentSolver<ConstantBlockCache<StepSolver<Solver>>> solver_;
  bool factored_ = false;
  bool by_tree_ = false, only_weight_ = false, doubtful_ = false;
  Sequence<Index> left_out_;
  VecX zero_a_, zero_lambda_, r_, phi_, open_, rhs_, x_, delta_, next_;
};

}  // namespace polybody
