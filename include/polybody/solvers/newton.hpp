#pragma once
/// \file
/// Newton's method that keeps its factorisation while it contracts [Hairer & Wanner 1996, §IV.8].

#include <algorithm>
#include <cmath>
#include <limits>

#include <polybody/math/types.hpp>

namespace polybody {

/// When to stop, refactor and give up. Norms are scaled: one means "as large as the tolerance".
struct NewtonOptions {
  int max_iterations = 20;
  double refactor_above = 0.3;   ///< contraction θ above which the factorisation is renewed
  bool always_refactor = false;  ///< full Newton
  int growths = 2;               ///< of the corrections, after which it gives up
  bool foretell = true;          ///< stop on what θ tells of the next correction, not on the last one itself
};

enum class NewtonResult { converged, diverged, singular, not_finite };

/// What a solve cost and how well it contracted.
struct NewtonReport {
  NewtonResult result = NewtonResult::converged;
  int iterations = 0;
  int factorisations = 0;
  double theta = 0.0;  ///< last contraction rate ‖Δₖ‖/‖Δₖ₋₁‖
};

/// Solves by corrections Δ. The problem offers
///   bool evaluate()     the right-hand side at the iterate; false when it is not finite
///   bool refactor()     the tangent there; false when it is singular
///   double solve()      the next correction; returns its scaled norm
///   void apply()        adds it; or void apply(double part), which full Newton damps
/// `factored` says whether an earlier factorisation may be used, `theta` its contraction rate; both are kept.
/// Stops when θ/(1 − θ) ‖Δ‖ ≤ 1; fails after growing as often as `growths` says. Full Newton in a stiff direction contracts by turns
/// (θ = 0.01, 0.8, 1e-4, …: bending, then the stretch that it left), so no single rate predicts the next correction:
/// it stops when ‖Δ‖ ≤ 1 itself, and grows when ‖Δₖ‖ ≥ ‖Δₖ₋₂‖. Where it would go in circles, as between a contact and none, half of a
/// correction is enough: the part that is taken is halved when ‖Δ‖ exceeds the least one so far, and doubled when ‖Δ‖ shrinks by what
/// that part explains.
template <class Problem>
NewtonReport newton(Problem&& problem, NewtonOptions const& options, bool& factored, double& theta) {
  NewtonReport report;
  double before = 0.0, earlier = 0.0;
  int grown = 0;
  double part = 1.0, least = std::numeric_limits<double>::infinity();
  bool fresh = false;  // factored within this solve
  theta = std::pow(std::max(theta, 1e-4), 0.8);  // an old rate is trusted less with every solve
  for (int k = 0; k < options.max_iterations; ++k) {
    if (!problem.evaluate()) {
      report.result = NewtonResult::not_finite;
      return report;
    }
    bool compare = k > 0;
    if (!factored || options.always_refactor) {
      if (!problem.refactor()) {
        report.result = NewtonResult::singular;
        factored = false;
        return report;
      }
      ++report.factorisations;
      factored = fresh = true;
      if (k == 0) theta = 1.0;
    }
    double const norm = problem.solve();
    ++report.iterations;
    if (!std::isfinite(norm)) {
      report.result = fresh ? NewtonResult::singular : NewtonResult::not_finite;
      factored = false;
      return report;
    }
    if (compare && before > 0.0) {
      theta = norm / before;
      report.theta = theta;
      if (options.always_refactor) {
        if (norm > least)
          part *= 0.5;
        else if (norm <= (1.1 - part) * before)
          part = std::min(1.0, 2.0 * part);
      }
      bool const grows = options.always_refactor ? earlier > 0.0 && norm >= earlier : theta >= 1.0;
      if (grows && norm > 1.0) {
        factored = false;
        if (++grown >= options.growths) {
          report.result = NewtonResult::diverged;
          return report;
        }
      } else if (theta > options.refactor_above) {
        factored = false;
      }
    }
    if constexpr (requires { problem.apply(part); })
      problem.apply(part);
    else
      problem.apply();
    least = std::min(least, norm);
    earlier = before;
    before = norm;
    double const rate = std::min(theta, 0.99);
    bool const small = norm <= 0.1;  // rounding no longer contracts
    if (options.always_refactor || !options.foretell ? norm <= 1.0 : small || (theta < 1.0 && rate / (1.0 - rate) * norm <= 1.0))
      return report;
  }
  report.result = NewtonResult::diverged;
  factored = false;
  return report;
}

}  // namespace polybody
