#pragma once
/// \file
/// Newton's method that keeps its factorisation while it contracts [Hairer & Wanner 1996, §IV.8].

#include <algorithm>
#include <cmath>
#include <limits>

#include <polybody/math/types.hpp>

namespace polybody {

/// When to stop, refactor and give up.
struct NewtonOptions {
  int max_iterations = 20;
  double refactor_above = 0.3;   ///< contraction θ above which the factorisation is renewed
  bool always_refactor = false;  ///< full Newton
  int growths = 2;               ///< of the corrections, after which it gives up
  bool predictive_stop = true;   ///< stop on what θ tells of the next correction, not on the last one itself

  /// \throws InvalidInput naming `who` for counts outside [1, 10⁶], or a contraction that is no number ≥ 0.
  [[gnu::cold]] void check(std::string const& who) const {
    require_count(max_iterations, who, ": newton.max_iterations");
    require_count(growths, who, ": newton.growths");
    if (!(refactor_above >= 0.0))
      throw InvalidInput{who, ": newton.refactor_above must be zero or positive, but is ", refactor_above, "."};
  }
};

/// Singular or not finite is what the first iterate is; where a later one is, Newton diverged.
enum class NewtonResult { converged, diverged, singular, not_finite };

/// What a solve cost and how well it contracted.
struct NewtonReport {
  NewtonResult result = NewtonResult::converged;
  int iterations = 0;
  int factorisations = 0;
  double theta = 0.0;  ///< last contraction rate ‖Δₖ‖/‖Δₖ₋₁‖
};

/// The norm of a correction, and how much of it is tolerated, which may depend on the iterate.
struct CorrectionSize {
  double norm, tolerated = 1.0;
};

namespace detail {

/// How the corrections of Newton's method shrink, and the part of them that is taken.
struct NewtonProgress {
  double before = 0.0, earlier = 0.0;  ///< norms of the last correction and of the one before it
  double rated = 0.0;                  ///< the last one beside what was tolerated
  double part = 1.0;
  int grown = 0;

  /// Rates the next correction by the last one. False where corrections grew too often.
  bool rate(CorrectionSize const& size, NewtonOptions const& options, bool& factored, double& theta) {
    double const norm = size.norm, beside_tolerated = norm / size.tolerated;
    theta = beside_tolerated / rated;
    if (options.always_refactor) {
      if (norm > (1.0 - 0.1 * part) * before)
        part = std::max(0.5 * part, 1.0 / 64.0);
      else if (norm <= (1.1 - part) * before)
        part = std::min(1.0, 2.0 * part);
    }
    bool const grows = options.always_refactor ? earlier > 0.0 && norm >= earlier : theta >= 1.0;
    if (grows && beside_tolerated > 1.0) {
      factored = false;
      return ++grown < options.growths;
    }
    if (theta > options.refactor_above) factored = false;
    return true;
  }

  /// Whether corrections stay where they are, so that it may be rounding that they consist of.
  bool stalls(CorrectionSize const& size, bool shrinks) const {
    bool const grew = size.norm >= before, twice = size.norm > 0.5 * before && before > 0.5 * earlier && earlier > 0.0;
    return !shrinks || ((grew || twice) && size.norm <= 1e4 * size.tolerated);
  }

  /// The correction has been applied: whether it was the last one. \param renewed the factorisation is of this iterate
  bool ends(CorrectionSize const& size, NewtonOptions const& options, bool renewed, double theta) {
    earlier = before;
    before = size.norm;
    rated = size.norm / size.tolerated;
    if (options.always_refactor || !options.predictive_stop) return rated <= 1.0;
    double const contraction = std::min(theta, 0.99);
    bool const small = rated <= 0.1;  // rounding no longer contracts
    return small || ((!renewed || grown == 0) && theta < 1.0 && contraction / (1.0 - contraction) * rated <= 1.0);
  }
};

}  // namespace detail

/// Solves by corrections Δ. The problem offers
///   bool evaluate()           the right-hand side at the iterate; false when it is not finite
///   bool refactor()           the tangent there; false when it is singular
///   CorrectionSize solve()    the next correction; or double, its norm where 1 is tolerated
///   void apply()              adds it; or void apply(double part), which full Newton damps
///   bool is_rounding(double)  (or not there) whether a correction of this norm is what rounding of the iterate leaves
/// `factored` says whether an earlier factorisation may be used, `theta` its contraction rate; both are kept.
/// With ‖Δ‖ beside what is tolerated it stops when θ/(1 − θ) ‖Δ‖ ≤ 1, for a new factorisation only as long as no
/// correction grew: the rate θ after a large correction is small for any iterate and says nothing of convergence. It
/// fails after as many growing corrections as `growths` says. Full Newton in a stiff direction contracts by turns (θ =
/// 0.01, 0.8, 1e-4, …: bending, then the stretch that it left), so no single rate predicts the next correction: it
/// stops when ‖Δ‖ ≤ 1 itself, and grows when ‖Δₖ‖ ≥ ‖Δₖ₋₂‖, by the norms themselves, as what is tolerated shrinks with
/// a wild iterate's accelerations. Where it would go in circles, as between a contact and none, half of a correction is
/// enough: the part that is taken is halved, down to 1/64, when ‖Δ‖ shrinks by less than a tenth of that part, and
/// doubled when it shrinks by what the part explains.
template <class Problem>
NewtonReport newton(Problem&& problem, NewtonOptions const& options, bool& factored, double& theta) {
  NewtonReport report;
  detail::NewtonProgress progress;
  auto const fail = [&](NewtonResult result) {
    report.result = result;
    factored = false;
    return report;
  };
  theta = std::pow(std::max(theta, 1e-4), 0.8);  // an old rate is trusted less with every solve
  for (int k = 0; k < options.max_iterations; ++k) {
    if (!problem.evaluate()) {
      report.result = k == 0 ? NewtonResult::not_finite : NewtonResult::diverged;
      factored = factored && k == 0;
      return report;
    }
    bool renewed = false;
    if (!factored || options.always_refactor) {
      if (!problem.refactor()) return fail(k == 0 ? NewtonResult::singular : NewtonResult::diverged);
      ++report.factorisations;
      factored = renewed = true;
      if (k == 0) theta = 1.0;
    }
    CorrectionSize const size{problem.solve()};
    ++report.iterations;
    if (!std::isfinite(size.norm / size.tolerated))
      return fail(k > 0 ? NewtonResult::diverged : renewed ? NewtonResult::singular : NewtonResult::not_finite);
    if (k > 0 && progress.before > 0.0) {
      double const rate_before = theta;
      bool const factored_before = factored, shrinks = progress.rate(size, options, factored, theta);
      report.theta = theta;
      if constexpr (requires { problem.is_rounding(size.norm); })
        if (size.norm > size.tolerated && progress.stalls(size, shrinks) && problem.is_rounding(size.norm)) {
          theta = rate_before;
          factored = factored_before;
          return report;
        }
      if (!shrinks) return fail(NewtonResult::diverged);
    }
    if constexpr (requires { problem.apply(progress.part); })
      problem.apply(progress.part);
    else
      problem.apply();
    if (progress.ends(size, options, renewed, theta)) return report;
  }
  return fail(NewtonResult::diverged);
}

}  // namespace polybody
