#pragma once
// Minimisation of a function under one inequality constraint, by the SLSQP method of NLopt [Kraft 1994] with exact
// gradients.

#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

struct ValueAndSlopes {
  double value = 0.0;
  std::vector<double> derivatives{};
};

// Problem: minimise `objective`(x) subject to `constraint`(x) ≤ 0 and least ≤ x ≤ most. Variables and function values
// should be of the order of one.
struct Design {
  std::function<ValueAndSlopes(std::span<double const>)> objective{}, constraint{};
  std::vector<double> start{}, least{}, most{};
  double tolerance = 1e-5;  // relative tolerance of x; the tolerance of the constraint is ten times as large
  int most_runs = 60;       // evaluations of the objective after each start of the method
};

struct BestDesign {
  std::vector<double> x{};
  double objective = 0.0, constraint = 0.0;
  std::string why{};  // reason for which the method stopped
  bool converged = false;
};

// Calls a function from NLopt, a C library: an exception is stored, and thrown again after the method has returned.
struct DesignCall {
  std::function<ValueAndSlopes(std::span<double const>)> const& f;
  nlopt_opt method;
  std::exception_ptr& thrown;

  static double call(unsigned n, double const* x, double* derivatives, void* data) {
    auto const& self = *static_cast<DesignCall const*>(data);
    try {
      ValueAndSlopes const here = self.f(std::span(x, n));
      if (derivatives) std::copy(here.derivatives.begin(), here.derivatives.end(), derivatives);
      return here.value;
    } catch (...) {
      self.thrown = std::current_exception();
      nlopt_force_stop(self.method);
      return 0.0;
    }
  }
};

inline char const* reason(nlopt_result result) {
  switch (result) {
    case NLOPT_XTOL_REACHED:
      return "the design no longer changes";
    case NLOPT_FTOL_REACHED:
      return "the objective no longer changes";
    case NLOPT_MAXEVAL_REACHED:
      return "the number of runs is used up";
    case NLOPT_ROUNDOFF_LIMITED:
      return "round-off prevents further progress";
    case NLOPT_SUCCESS:
      return "the optimality conditions are satisfied";
    default:
      return "the method failed";
  }
}

inline BestDesign best_design(Design const& design) {
  std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> const method(
      nlopt_create(NLOPT_LD_SLSQP, unsigned(design.start.size())), nlopt_destroy);
  std::exception_ptr thrown;
  DesignCall objective{design.objective, method.get(), thrown}, constraint{design.constraint, method.get(), thrown};
  nlopt_set_min_objective(method.get(), DesignCall::call, &objective);
  nlopt_add_inequality_constraint(method.get(), DesignCall::call, &constraint, 10.0 * design.tolerance);
  nlopt_set_lower_bounds(method.get(), design.least.data());
  nlopt_set_upper_bounds(method.get(), design.most.data());
  nlopt_set_xtol_rel(method.get(), design.tolerance);
  nlopt_set_maxeval(method.get(), design.most_runs);
  BestDesign best{.x = design.start};
  nlopt_result result = NLOPT_FAILURE;
  double before = design.objective(best.x).value;
  for (int begun = 0; begun < 8; ++begun) {  // a new start has no stored curvature that could end it early
    result = nlopt_optimize(method.get(), best.x.data(), &best.objective);
    if (thrown) std::rethrow_exception(thrown);
    best.constraint = design.constraint(best.x).value;
    bool const moves = std::abs(best.objective - before) > 10.0 * design.tolerance * std::abs(before);
    if (result < 0 || (begun > 0 && !moves)) break;
    before = best.objective;
  }
  best.why = reason(result);
  best.converged = result > 0 && result != NLOPT_MAXEVAL_REACHED && best.x != design.start;
  return best;
}
