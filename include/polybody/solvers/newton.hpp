#pragma once
/// \file
/// Newton's method that keeps its factorisation while it contracts [Hairer & Wanner 1996, §IV.8].

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>

#include <polybody/solvers/anderson.hpp>

namespace polybody {

/// When to stop, refactor and give up.
struct NewtonOptions {
  int max_iterations = 20;  ///< at which it gives up, in [1, 10⁶]
  /// What a factorisation costs, in iterations: it is renewed where that saves more of them over as many solves as the
  /// last one served.
  double factorisation_cost = 3.0;
  bool always_refactor = false;  ///< full Newton
  int max_growths = 2;           ///< of the corrections, after which it gives up
  /// What a solve should cost, in iterations, where a factorisation costs as many as above. At this bound it ends with
  /// the first iterate that is near, and reports what it left, as a loop in real time asks for. 0: no bound.
  double budget = 0.0;
  bool predictive_stop = true;  ///< stop on what θ tells of the next correction, not on the last one itself

  /// \throws InvalidInput naming `who` for counts outside [1, 10⁶], a cost that is no number ≥ 0, or a budget below a
  /// factorisation and an iteration.
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

/// Singular or not finite is what the first iterate is; where a later one is, Newton diverged.
enum class NewtonResult { converged, diverged, singular, not_finite };

/// What a solve cost and how well it contracted.
struct NewtonReport {
  NewtonResult result = NewtonResult::converged;  ///< how it ended
  int iterations = 0;                             ///< evaluations of the right-hand side that were solved for
  int factorisations = 0;                         ///< tangents that were factored
  double theta = 0.0;                             ///< last contraction rate ‖Δₖ‖/‖Δₖ₋₁‖, a ratio
  double left = 0.0;  ///< where it ended for its budget, the last correction relative to what is tolerated; else 0
};

/// What Newton's method keeps from solve to solve of problems that follow each other.
struct ReusedFactorisation {
  bool usable = false;  ///< a factorisation is at hand
  double theta = 1.0;   ///< its contraction rate, a ratio
  double fresh = 0.05;  ///< the ratio that is expected of a new one, as others had
  int served = 0;       ///< solves that it has ended
  double seen = 0.0;    ///< the rate that its corrections showed last, a ratio; 0: none
  bool stale = false;  ///< the last solve found at once that one had to be made, as where contacts change in every step
};

/// The norm of a correction, and how much of it is tolerated, which may depend on the iterate.
struct CorrectionSize {
  double norm, tolerated = 1.0;  ///< ‖Δ‖ and what of it is tolerated, both in the unit of the problem
};

namespace detail {

/// Iterations that are still to come after a correction that is `rated` times what is tolerated, at the rate θ.
inline double iterations_to_come(double rated, double theta) {
  if (!(theta < 1.0)) return std::numeric_limits<double>::infinity();
  return std::max(0.0, std::log(rated * theta / (1.0 - theta)) / -std::log(theta));
}

/// How the corrections of Newton's method shrink, and the part of them that is taken.
struct NewtonProgress {
  double before = 0.0, earlier = 0.0;  ///< norms of the last correction and of the one before it
  double largest = 0.0;                ///< of all
  double rated = 0.0;                  ///< the last one beside what was tolerated
  double part = 1.0;
  int grown = 0;

  /// Rates the next correction by the last one. False where it grew.
  bool rate(CorrectionSize const& size, NewtonOptions const& options, double& theta) {
    double const norm = size.norm, beside_tolerated = norm / size.tolerated;
    theta = beside_tolerated / rated;
    if (options.always_refactor) {
      if (norm > (1.0 - 0.1 * part) * before)
        part = std::max(0.5 * part, 1.0 / 64.0);
      else if (norm <= (1.1 - part) * before)
        part = std::min(1.0, 2.0 * part);
    }
    bool const grows = options.always_refactor ? earlier > 0.0 && norm >= earlier : theta >= 1.0;
    return !(grows && beside_tolerated > 1.0);
  }
  /// Whether a new factorisation saves more iterations than it costs, over as many solves as the last one served.
  /// \param theta the rate with the one at hand
  static bool renewal_pays(CorrectionSize const& size, NewtonOptions const& options, ReusedFactorisation const& kept,
                           double theta) {
    if (theta <= 1.5 * kept.fresh) return false;  // no better than what is at hand
    double const by = size.norm / size.tolerated;
    double const saved = iterations_to_come(by, theta) - iterations_to_come(by, kept.fresh);
    return saved * std::max(kept.served, 1) > options.factorisation_cost;
  }

  /// Whether corrections stay where they are, so that it may be rounding that they consist of.
  bool stalls(CorrectionSize const& size, bool shrinks) const {
    bool const grew = size.norm >= before, twice = size.norm > 0.5 * before && before > 0.5 * earlier && earlier > 0.0;
    return !shrinks || ((grew || twice) && size.norm <= 1e4 * size.tolerated);
  }

  /// The correction is taken.
  void take(CorrectionSize const& size) {
    earlier = before;
    before = size.norm;
    largest = std::max(largest, size.norm);
    rated = size.norm / size.tolerated;
  }
  /// Whether the correction that is taken is the last one. \param renewed the factorisation is of this iterate
  /// \param left the share of it that the next one comes from, by a fit of past ones
  bool ends(NewtonOptions const& options, bool renewed, double theta, double left = 1.0) const {
    if (options.always_refactor || !options.predictive_stop) return rated <= 1.0;
    double const contraction = std::min(theta, 0.99);
    bool const small = rated <= 0.1;  // rounding no longer contracts
    double const expected = contraction / (1.0 - contraction) * left * rated;
    return small || ((!renewed || grown == 0) && theta < 1.0 && expected <= 1.0);
  }
};

/// A solve: what it has at hand, and where it stands.
template <class Problem>
struct NewtonSolve {
  Problem& problem;
  NewtonOptions const& options;
  ReusedFactorisation& kept;
  bool begins_anew;  ///< as the last solve found its factorisation of no use
  NewtonReport report = {};
  NewtonProgress progress = {};
  bool fresh = false, renewed = false;  ///< a factorisation was made at the last iterate, at this one
  bool rounding = false;                ///< the correction is what rounding leaves
  bool restarted = false;               ///< the iterate is the first one again
  bool follows = false;                 ///< the last correction was by the factorisation at hand
  std::optional<AndersonFit> fit = {};  ///< of this correction by the ones before it

  /// What has been spent and `more` stay within the budget.
  bool affords(double more) const {
    return options.budget == 0.0 ||
           report.iterations + options.factorisation_cost * report.factorisations + more <= options.budget;
  }
  /// \return whether the tangent has a factorisation
  bool renew() {
    if (!problem.refactor()) return false;
    ++report.factorisations;
    kept.served = 0;
    kept.seen = 0.0;
    follows = false;
    return kept.usable = renewed = true;
  }
  /// Goes back to the first iterate where an earlier solve's factorisation led far from it.
  bool restart() {
    if constexpr (requires { problem.restart(); }) {
      restarted = report.factorisations == 0 && problem.is_far_from_solution(progress.largest);
      if (!restarted) return false;
      problem.restart();
      progress = {};
      kept.usable = false;
    }
    return restarted;
  }
  /// What is left moves the iterate little beside what it moves by itself.
  bool is_near(double norm) const {
    if constexpr (requires { problem.is_far_from_solution(norm); })
      return !problem.is_far_from_solution(100.0 * norm);
    else
      return norm <= 0.01 * progress.largest;
  }
  static bool is_finite(CorrectionSize const& size) { return std::isfinite(size.norm / size.tolerated); }

  /// Fits the correction by those before it of the same factorisation.
  void fit_correction() {
    if constexpr (requires { problem.acceleration(); })
      if (follows && !fit) fit = problem.acceleration().fit(problem.correction());
  }
  /// After a combined step ‖Δₖ‖/‖Δₖ₋₁‖ is no rate of the factorisation: that is what the fit tells. As one ratio may be
  /// small by chance, a rate θ is followed by one of at least θ^1.5. Returns that of corrections to come, combined
  /// ones.
  double rate_of_factorisation() {
    double const ratio = kept.theta;
    if constexpr (requires { problem.acceleration(); })
      if (follows) {
        if (problem.acceleration().combined()) fit_correction();
        kept.theta = std::max(fit ? fit->contraction : ratio, kept.seen * std::sqrt(kept.seen));
      }
    kept.seen = kept.theta;
    return std::min(ratio, kept.theta);
  }

  /// Rates the next correction, renews the factorisation where it asks for that, and solves again. False where it
  /// diverges.
  bool rate(int k, CorrectionSize& size) {
    double const rate_before = kept.theta;
    bool shrinks = progress.rate(size, options, kept.theta);
    double const to_come = rate_of_factorisation();
    report.theta = kept.theta;
    if (fresh && !renewed) kept.fresh = std::clamp(std::sqrt(kept.fresh * kept.theta), 0.01, 0.5);
    if constexpr (requires { problem.is_round_off(size.norm); })
      if (size.norm > size.tolerated && progress.stalls(size, shrinks)) {
        rounding = problem.is_round_off(size.norm);
        if (rounding) {
          kept.theta = rate_before;
          kept.seen = 0.0;
          return true;
        }
        if (!problem.evaluate()) return false;  // it was asked of places beside the iterate
      }
    bool const asks = !renewed && (!shrinks || progress.renewal_pays(size, options, kept, to_come)) &&
                      affords(options.factorisation_cost);
    if (k == 1 && !options.always_refactor)
      kept.stale = begins_anew ? asks || kept.theta > 2.0 * kept.fresh : asks && !fresh && kept.theta > 0.5;
    if (asks && restart()) return true;
    if (asks) {
      if (!renew()) return false;
      kept.theta = 1.0;  // of the new one nothing is known
      size = CorrectionSize{problem.solve()};
      if (!is_finite(size)) return false;
      bool const first = report.factorisations == 1;  // what an earlier solve's one made tells nothing of this one's
      shrinks = first || size.norm < progress.before || size.norm <= size.tolerated;
    }
    return shrinks || ++progress.grown < options.max_growths;
  }

  /// Takes the correction, combined with those before it where it is not the last one by itself. Whether it is.
  bool take(CorrectionSize const& size) {
    progress.take(size);
    bool last = progress.ends(options, renewed, kept.theta);
    if constexpr (requires { problem.acceleration(); }) {
      if ((last && !fit) || options.always_refactor || !options.predictive_stop) return last;
      fit_correction();
      if (fit && fit->contraction > 0.8) follows = false;  // a combination would lead far
      if (!follows) problem.acceleration().forget();
      bool const measured = problem.acceleration().combined();  // else θ is a ratio, as of contacts that have changed
      problem.acceleration().combine(problem.correction());
      double const left = !follows ? 1.0 : measured ? fit->left : std::sqrt(fit->left);
      last = last || progress.ends(options, renewed, kept.theta, left);
      follows = true;
    }
    return last;
  }

  /// One iteration. What it ends with, if it does.
  std::optional<NewtonResult> iterate(int k) {
    if (!problem.evaluate()) {
      kept.usable = kept.usable && k == 0;
      return k == 0 ? NewtonResult::not_finite : NewtonResult::diverged;
    }
    fresh = renewed;
    renewed = restarted = false;
    auto const fail = [&](NewtonResult result) {
      kept.usable = false;
      return result;
    };
    if (!kept.usable || options.always_refactor) {
      if (!renew()) return fail(k == 0 ? NewtonResult::singular : NewtonResult::diverged);
      if (progress.before == 0.0) kept.theta = 1.0;
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
    ++kept.served;
    return NewtonResult::converged;
  }
};

}  // namespace detail

/// Solves by corrections Δ. The problem offers
///   bool evaluate()           the right-hand side at the iterate; false when it is not finite
///   bool refactor()           the tangent there; false when it is singular
///   CorrectionSize solve()    the next correction; or double, its norm where 1 is tolerated. It may be asked twice of
///                             one right-hand side, by an old and by a new factorisation
///   void apply()              adds it; or void apply(double part), which full Newton damps
///   bool is_round_off(double)  (or not there) whether a correction of this norm is what rounding of the iterate leaves
///   AndersonAcceleration& acceleration(), VecX& correction()  (or not there) what combines corrections, and the one
///                             that `solve` found and `apply` takes
///   bool is_far_from_solution(double), void restart()  (or not there) whether a correction of this norm leads further
///   away than the
///                             solution may be; brings back the first iterate
/// `kept` says whether an earlier factorisation may be used, and what is known of it.
/// A correction that tells that the factorisation should be renewed is not taken: the new one is made where it was
/// found, and answers the same right-hand side. It should be where corrections grow, and where it saves more iterations
/// than it costs (`NewtonOptions`). Where corrections of an earlier solve's factorisation led far away, the solve
/// begins again with a new one: from there it may find another solution, as rods that turn over have. Where the first
/// correction shows that, the next solves begin with a new one, until their second corrections are small again. With
/// ‖Δ‖ beside what is tolerated it stops when θ/(1 − θ) ‖Δ‖ ≤ 1, for a new factorisation only as long as no correction
/// grew: the rate θ after a large correction is small for any iterate and says nothing of convergence. Corrections of
/// one factorisation are combined, but for full Newton and without `predictive_stop`: θ is then the factorisation's own
/// rate, and ‖Δ‖ what the combination leaves of the last correction, or its geometric mean with ‖Δ‖ after the first
/// two. It fails after as many growing corrections of new factorisations as `max_growths` says. Full Newton in a stiff
/// direction contracts by turns (θ = 0.01, 0.8, 1e-4, …: bending, then the stretch that it left), so no single rate
/// predicts the next correction: it stops when ‖Δ‖ ≤ 1 itself, and grows when ‖Δₖ‖ ≥ ‖Δₖ₋₂‖, by the norms themselves,
/// as what is tolerated shrinks with a wild iterate's accelerations. Where it would go in circles, as between a contact
/// and none, half of a correction is enough: the part that is taken is halved, down to 1/64, when ‖Δ‖ shrinks by less
/// than a tenth of that part, and doubled when it shrinks by what the part explains. What is near, at the end of the
/// budget: its last correction moves it by less than a hundredth of what would be far, or of the largest one where the
/// problem does not tell. What is not goes on, as iterates at impacts may be anywhere.
template <class Problem>
NewtonReport newton(Problem&& problem, NewtonOptions const& options, ReusedFactorisation& kept) {
  detail::NewtonSolve<std::remove_reference_t<Problem>> solve{problem, options, kept, kept.stale};
  if (kept.stale) kept.usable = false;
  kept.theta = std::pow(std::max(kept.theta, 1e-4), 0.8);  // an old rate is trusted less with every solve
  kept.fresh += 0.1 * (ReusedFactorisation{}.fresh - kept.fresh);
  for (int k = 0; k < options.max_iterations; ++k)
    if (auto const result = solve.iterate(k)) {
      solve.report.result = *result;
      return solve.report;
    }
  kept.usable = false;
  solve.report.result = NewtonResult::diverged;
  return solve.report;
}

}  // namespace polybody
