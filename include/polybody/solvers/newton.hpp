#pragma once
/// \file
/// Modified Newton method, which reuses a factorisation as long as the iteration contracts [Hairer & Wanner 1996,
/// §IV.8].
/// Theory: Eqs. 7.1 to 7.5.

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>

#include <polybody/solvers/anderson.hpp>

namespace polybody {

/// Conditions under which a solve by Newton's method stops, factorises again or fails.
struct NewtonOptions {
  int max_iterations = 20;  ///< number of iterations at which a solve fails, in [1, 10⁶]
  /// Cost of a factorisation, in iterations. The tangent is factorised again if this saves more iterations than it
  /// costs, over as many solves as the last factorisation completed.
  double factorisation_cost = 3.0;
  bool always_refactor = false;  ///< full Newton method: factorise in every iteration
  int max_growths = 2;           ///< number of growing corrections after which a solve fails
  /// Budget of a solve for real-time loops, in iterations; a factorisation counts as `factorisation_cost` iterations.
  /// When the budget is spent, the solve ends at the first iterate near the solution and reports the last correction.
  /// 0: no budget.
  double budget = 0.0;
  bool predictive_stop = true;  ///< true: stop by the predicted next correction; false: by the last one

  /// \throws InvalidInput if a count is outside [1, 10⁶], if the cost is negative or NaN, or if a nonzero budget is
  /// below the cost of a factorisation and an iteration. The message begins with `who`.
  [[gnu::cold]] void check(std::string const& who) const {
    require_count(max_iterations, who, ": newton.max_iterations");
    require_count(max_growths, who, ": newton.max_growths");
    if (!(factorisation_cost >= 0.0))
      throw InvalidInput("newton.option",
                         {ErrorObject{who}, ": newton.factorisation_cost must be zero or positive, but is ",
                          ErrorValue{factorisation_cost}, "."});
    if (budget != 0.0 && !(budget >= factorisation_cost + 1.0))
      throw InvalidInput(
          "newton.option",
          {ErrorObject{who},
           ": newton.budget must be zero (none) or at least the cost of a factorisation and an iteration, ",
           factorisation_cost + 1.0, ", but is ", ErrorValue{budget}, "."});
  }
};

/// Result of a solve. `singular` and `not_finite` refer to the first iterate. If a later iterate is singular or not
/// finite, the result is `diverged`.
enum class NewtonResult { converged, diverged, singular, not_finite };

/// Result, cost and contraction of a solve.
struct NewtonReport {
  NewtonResult result = NewtonResult::converged;  ///< result of the solve
  int iterations = 0;                             ///< number of evaluated right-hand sides, each with a solution
  int factorisations = 0;                         ///< number of factorised tangents
  int searches = 0;                               ///< number of further evaluations, in line searches
  double theta = 0.0;                             ///< last contraction rate ‖Δₖ‖/‖Δₖ₋₁‖ [1]
  double left = 0.0;  ///< ratio of the last correction to its tolerance if the budget ended the solve; otherwise 0
};

/// Data that Newton's method passes from one solve to the next in a sequence of similar problems.
struct ReusedFactorisation {
  bool usable = false;  ///< a factorisation is available
  double theta = 1.0;   ///< contraction rate of the factorisation [1]
  double fresh = 0.05;  ///< expected contraction rate of a new factorisation [1], from previous factorisations
  int served = 0;       ///< number of solves that the factorisation completed
  double seen = 0.0;    ///< last contraction rate measured with the factorisation [1]; 0: not measured
  bool stale = false;   ///< the next solve begins with a new factorisation, as for contacts that change every step
};

/// Norm of a correction and its tolerance, which may depend on the iterate.
struct CorrectionSize {
  double norm, tolerated = 1.0;  ///< ‖Δ‖ and its tolerance, both in the unit of the problem
};

namespace detail {

/// Number of further iterations after a correction of `relative_size` times its tolerance, at the contraction rate
/// `theta`.
inline double iterations_to_come(double relative_size, double theta) {
  if (!(theta < 1.0)) return std::numeric_limits<double>::infinity();
  return std::max(0.0, std::log(relative_size * theta / (1.0 - theta)) / -std::log(theta));
}

/// Contraction of the corrections of Newton's method, and the part of a correction that is applied.
struct NewtonProgress {
  double before = 0.0, earlier = 0.0;  ///< norms of the last and of the last but one correction
  double largest = 0.0;                ///< largest norm of all corrections
  double relative_size = 0.0;          ///< ratio of the last correction to its tolerance
  double part = 1.0;
  int grown = 0;

  /// Computes the ratio θ of the correction `size` to the last one. Returns false if the correction grew and is above
  /// its tolerance.
  bool rate(CorrectionSize const& size, NewtonOptions const& options, double& theta) {
    double const norm = size.norm, relative = norm / size.tolerated;
    theta = relative / relative_size;
    if (options.always_refactor) {
      if (norm > (1.0 - 0.1 * part) * before)
        part = std::max(0.5 * part, 1.0 / 64.0);
      else if (norm <= (1.1 - part) * before)
        part = std::min(1.0, 2.0 * part);
    }
    bool const grows = options.always_refactor ? earlier > 0.0 && norm >= earlier : theta >= 1.0;
    return !(grows && relative > 1.0);
  }
  /// True if a new factorisation saves more iterations than it costs, over as many solves as the last factorisation
  /// completed. \param theta contraction rate of the current factorisation
  static bool renewal_pays(CorrectionSize const& size, NewtonOptions const& options, ReusedFactorisation const& reused,
                           double theta) {
    if (theta <= 1.5 * reused.fresh) return false;  // a new factorisation is not better
    double const by = size.norm / size.tolerated;
    double const saved = iterations_to_come(by, theta) - iterations_to_come(by, reused.fresh);
    return saved * std::max(reused.served, 1) > options.factorisation_cost;
  }

  /// True if the corrections may consist of round-off: `shrinks` is false, or a correction of at most 1e4 times its
  /// tolerance grows or is the second one in succession above half of its predecessor.
  bool stagnates(CorrectionSize const& size, bool shrinks) const {
    bool const grew = size.norm >= before, twice = size.norm > 0.5 * before && before > 0.5 * earlier && earlier > 0.0;
    return !shrinks || ((grew || twice) && size.norm <= 1e4 * size.tolerated);
  }

  /// Records the norm of a correction that is applied.
  void take(CorrectionSize const& size) {
    earlier = before;
    before = size.norm;
    largest = std::max(largest, size.norm);
    relative_size = size.norm / size.tolerated;
  }
  /// True if the solve ends after the applied correction. \param renewed true if the tangent was factorised at this
  /// iterate \param left relative residual of the fit of the correction by previous ones [1]; the next correction is
  /// proportional to it
  bool ends(NewtonOptions const& options, bool renewed, double theta, double left = 1.0) const {
    if (options.always_refactor || !options.predictive_stop) return relative_size <= 1.0;
    double const contraction = std::min(theta, 0.99);
    bool const small = relative_size <= 0.1;  // round-off does not contract
    double const expected = contraction / (1.0 - contraction) * left * relative_size;
    return small || ((!renewed || grown == 0) && theta < 1.0 && expected <= 1.0);
  }
};

/// Inputs and state of one solve by Newton's method.
template <class Problem>
struct NewtonSolve {
  Problem& problem;
  NewtonOptions const& options;
  ReusedFactorisation& reused;
  bool begins_fresh;  ///< the solve begins with a new factorisation
  NewtonReport report = {};
  NewtonProgress progress = {};
  bool fresh = false, renewed = false;  ///< true if the tangent was factorised at the last or at this iterate
  bool rounding = false;                ///< the correction consists of round-off
  bool restarted = false;               ///< the solve has returned to its first iterate
  bool follows = false;                 ///< the last correction used the current factorisation
  std::optional<AndersonFit> fit = {};  ///< fit of this correction by previous corrections

  /// True if the cost of the solve plus `more` iterations is within the budget.
  bool affords(double more) const {
    return options.budget == 0.0 ||
           report.iterations + options.factorisation_cost * report.factorisations + more <= options.budget;
  }
  /// Factorises the tangent. Returns false if it is singular.
  bool renew() {
    if (!problem.refactor()) return false;
    ++report.factorisations;
    reused.served = 0;
    reused.seen = 0.0;
    follows = false;
    return reused.usable = renewed = true;
  }
  /// True if the problem requires a new factorisation in each iteration, and the budget admits it.
  bool wants_renewal() const {
    if constexpr (requires { problem.renews(); }) return problem.renews() && affords(options.factorisation_cost);
    return false;
  }
  /// Returns to the first iterate if a correction with the factorisation of an earlier solve was too large
  /// (`is_far_from_solution`).
  bool restart() {
    if constexpr (requires { problem.restart(); }) {
      restarted = report.factorisations == 0 && problem.is_far_from_solution(progress.largest);
      if (!restarted) return false;
      problem.restart();
      progress = {};
      reused.usable = false;
    }
    return restarted;
  }
  /// True if `is_far_from_solution` of the problem is false for 100 times this norm. If the problem has no such
  /// function: true if the norm is at most a hundredth of the largest one.
  bool is_near(double norm) const {
    if constexpr (requires { problem.is_far_from_solution(norm); })
      return !problem.is_far_from_solution(100.0 * norm);
    else
      return norm <= 0.01 * progress.largest;
  }
  static bool is_finite(CorrectionSize const& size) { return std::isfinite(size.norm / size.tolerated); }

  /// Fits the correction by previous corrections of the same factorisation.
  void fit_correction() {
    if constexpr (requires { problem.acceleration(); })
      if (follows && !fit) fit = problem.acceleration().fit(problem.correction());
  }
  /// Updates the contraction rate of the factorisation. After a combined step ‖Δₖ‖/‖Δₖ₋₁‖ is not a contraction rate,
  /// and the rate of the fit is used. Since one ratio may be small by chance, a rate θ is followed by a rate of at
  /// least θ^1.5. Returns the expected ratio of the next, combined correction to this correction.
  double rate_of_factorisation() {
    double const ratio = reused.theta;
    if constexpr (requires { problem.acceleration(); })
      if (follows) {
        if (problem.acceleration().combined()) fit_correction();
        reused.theta = std::max(fit ? fit->contraction : ratio, reused.seen * std::sqrt(reused.seen));
      }
    reused.seen = reused.theta;
    return std::min(ratio, reused.theta);
  }

  /// Computes the contraction rate. If the factorisation has to be renewed, factorises the tangent and computes the
  /// correction again. Returns false if the iteration diverges.
  bool rate(int k, CorrectionSize& size) {
    double const rate_before = reused.theta;
    bool shrinks = progress.rate(size, options, reused.theta);
    double const to_come = rate_of_factorisation();
    report.theta = reused.theta;
    if (fresh && !renewed) reused.fresh = std::clamp(std::sqrt(reused.fresh * reused.theta), 0.01, 0.5);
    if constexpr (requires { problem.is_round_off(size.norm); })
      if (size.norm > size.tolerated && progress.stagnates(size, shrinks)) {
        rounding = problem.is_round_off(size.norm);
        if (rounding) {
          reused.theta = rate_before;
          reused.seen = 0.0;
          return true;
        }
        if (!problem.evaluate()) return false;  // `is_round_off` evaluates other iterates
      }
    bool const asks = !renewed && (!shrinks || progress.renewal_pays(size, options, reused, to_come)) &&
                      affords(options.factorisation_cost);
    if (k == 1 && !options.always_refactor)
      reused.stale = begins_fresh ? asks || reused.theta > 2.0 * reused.fresh : asks && !fresh && reused.theta > 0.5;
    if (asks && restart()) return true;
    if (asks) {
      if (!renew()) return false;
      reused.theta = 1.0;  // the rate of the new factorisation is unknown
      size = CorrectionSize{problem.solve()};
      if (!is_finite(size)) return false;
      bool const first = report.factorisations == 1;  // not comparable with an earlier solve's factorisation
      shrinks = first || size.norm < progress.before || size.norm <= size.tolerated;
    }
    return shrinks || ++progress.grown < options.max_growths;
  }

  /// Records the correction and combines it with previous corrections, unless the solve already ends without a
  /// combination. Returns true if the solve ends with this correction.
  bool take(CorrectionSize const& size) {
    progress.take(size);
    bool last = progress.ends(options, renewed, reused.theta);
    if constexpr (requires { problem.acceleration(); }) {
      if ((last && !fit) || options.always_refactor || !options.predictive_stop) return last;
      fit_correction();
      if (fit && fit->contraction > 0.8) follows = false;  // a combination would be large
      if (!follows) problem.acceleration().forget();
      bool const measured = problem.acceleration().combined();  // if false, θ is only a ratio, as after new contacts
      problem.acceleration().combine(problem.correction());
      double const left = !follows ? 1.0 : measured ? fit->left : std::sqrt(fit->left);
      last = last || progress.ends(options, renewed, reused.theta, left);
      follows = true;
    }
    return last;
  }

  /// Evaluates the iterate. In the full Newton method, the last correction is shortened if it overshoots.
  bool evaluate(int k) {
    if constexpr (requires { problem.search(report.searches); })
      if (k > 0 && options.always_refactor) return problem.search(report.searches);
    return problem.evaluate();
  }
  /// Executes one iteration. Returns the result if the solve ends with it.
  std::optional<NewtonResult> iterate(int k) {
    if (!evaluate(k)) {
      reused.usable = reused.usable && k == 0;
      return k == 0 ? NewtonResult::not_finite : NewtonResult::diverged;
    }
    fresh = renewed;
    renewed = restarted = false;
    auto const fail = [&](NewtonResult result) {
      reused.usable = false;
      return result;
    };
    if (!reused.usable || options.always_refactor || wants_renewal()) {
      if (!renew()) return fail(k == 0 ? NewtonResult::singular : NewtonResult::diverged);
      if (progress.before == 0.0) reused.theta = 1.0;
    }
    fit.reset();
    CorrectionSize size{problem.solve()};
    ++report.iterations;
    if (!is_finite(size))
      return fail(k > 0 ? NewtonResult::diverged : renewed ? NewtonResult::singular : NewtonResult::not_finite);
    if (k > 0 && progress.before > 0.0) {
      if (!rate(k, size)) return fail(NewtonResult::diverged);
      if (rounding) return NewtonResult::converged;
      if (restarted) return {};
    }
    bool const last = take(size);
    if constexpr (requires { problem.apply(progress.part); })
      problem.apply(progress.part);
    else
      problem.apply();
    if (!last) {
      if (affords(1.0) || !is_near(size.norm)) return {};
      report.left = size.norm / size.tolerated;
    }
    ++reused.served;
    return NewtonResult::converged;
  }
};

}  // namespace detail

/// Solves a nonlinear problem by corrections Δ. The problem provides
///   bool evaluate()           evaluates the right-hand side at the iterate; false if it is not finite
///   bool refactor()           factorises the tangent at the iterate; false if it is singular
///   CorrectionSize solve()    computes the next correction and returns its size; or double: its norm for tolerance 1.
///                             A second call for the same right-hand side follows a new factorisation
///   void apply()              adds the correction; or void apply(double part), for damping in full Newton
///   bool is_round_off(double)  (optional) true if a correction of this norm consists of round-off of the iterate
///   AndersonAcceleration& acceleration(), VecX& correction()  (optional) the acceleration, and the correction that
///                             `solve` computes and `apply` adds
///   bool renews()             (optional) true if each iteration factorises the tangent
///   bool search(int&)         (optional) evaluates the iterate, shortens the last correction if it overshoots, and
///                             adds the number of further evaluations
///   bool is_far_from_solution(double), void restart()  (optional) true if a correction of this norm is larger than the
///                             distance to the solution can be; returns to the first iterate
/// `reused` describes the factorisation of earlier solves.
///
/// Factorisation: the tangent is factorised again if corrections grow, or if this saves more iterations than it costs
/// (`NewtonOptions`). The correction that causes the new factorisation is discarded. A correction with the new
/// factorisation, for the same iterate and right-hand side, replaces it. If a correction with the factorisation of an
/// earlier solve is too large (`is_far_from_solution`), the solve restarts at its first iterate with a new
/// factorisation. From a distant iterate the solve may converge to another solution, in which for example a rod has
/// turned over. If the second correction of a solve requires a new factorisation and has a rate above 0.5, the next
/// solves begin with one. This ends when the rate of a second correction is at most twice the expected rate of a new
/// factorisation.
///
/// Stop: with ‖Δ‖ relative to its tolerance, the solve stops if θ/(1 − θ) ‖Δ‖ ≤ 1 or ‖Δ‖ ≤ 0.1. With a new
/// factorisation the first condition also requires that no correction of the solve grew. After a large correction θ is
/// small for any iterate and does not prove convergence. Corrections with the same factorisation are combined
/// (`AndersonAcceleration`), unless `always_refactor` is true or `predictive_stop` is false. θ is then the contraction
/// rate of the factorisation alone. The first condition then contains the residual of the fit in place of ‖Δ‖. At the
/// second correction, θ is only a ratio of two corrections; the condition then contains the geometric mean of ‖Δ‖ and
/// the residual of the fit. The solve fails after `max_growths` growing corrections of new factorisations.
///
/// Full Newton: in stiff directions the rate θ alternates (0.01, 0.8, 1e-4, …: bending, then the stretch due to
/// bending), so that one rate does not predict the next correction. Full Newton stops if ‖Δ‖ ≤ 1. A correction grows if
/// ‖Δₖ‖ ≥ ‖Δₖ₋₂‖, without tolerances, because the tolerance shrinks with the accelerations of an iterate far from the
/// solution. Only a part of each correction may be applied, to prevent cycles, for example between a closed and an open
/// contact. The part is halved, down to 1/64, if ‖Δ‖ shrinks by less than a tenth of the part. It is doubled if ‖Δ‖
/// shrinks in proportion to the part.
///
/// Budget: an iterate is near the solution if `is_far_from_solution` is false for 100 times its last correction.
/// Without this function, the last correction must be at most a hundredth of the largest one. If the iterate is not
/// near, the solve continues beyond the budget, because an iterate at an impact may be far from the solution.
template <class Problem>
NewtonReport newton(Problem&& problem, NewtonOptions const& options, ReusedFactorisation& reused) {
  detail::NewtonSolve<std::remove_reference_t<Problem>> solve{problem, options, reused, reused.stale};
  if (reused.stale) reused.usable = false;
  reused.theta = std::pow(std::max(reused.theta, 1e-4), 0.8);  // an old rate becomes less reliable with every solve
  reused.fresh += 0.1 * (ReusedFactorisation{}.fresh - reused.fresh);
  for (int k = 0; k < options.max_iterations; ++k)
    if (auto const result = solve.iterate(k)) {
      solve.report.result = *result;
      return solve.report;
    }
  reused.usable = false;
  solve.report.result = NewtonResult::diverged;
  return solve.report;
}

}  // namespace polybody
