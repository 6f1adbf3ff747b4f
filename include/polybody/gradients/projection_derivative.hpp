#pragma once
/// \file
/// A projection at the end of a step (integrators/stabilisation.hpp) in doubles and duals, for the step's derivative.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/gradients/evaluation_point.hpp>
#include <polybody/integrators/stabilisation.hpp>

namespace polybody {

/// `Projection::apply` at the end of a step of h, for doubles and duals.
class ProjectionDerivative {
 public:
  /// With the options of the step's own projection.
  explicit ProjectionDerivative(Projection const& options) : options_(options) {}

  /// Brings q and v of x back to the rows. Doubles tell how many steps of Gauss–Newton it takes, and duals take as
  /// many. \param solve what solves the equations at x
  template <StateScalar T, class Solve>
  void apply(BasicSystem<T> const& system, EvaluationPoint<T>& x, double h, Solve&& solve) {
    if (system.rows() == 0) return;
    VecXOf<T> moved = x.v, next = x.q;
    double const enough = options_.tolerance * (1.0 + largest(x.q)) / (h * h);
    x.also.resize(0);
    x.terms = {.force = 0.0, .bias = 0.0, .position = 1.0 / (h * h)};
    for (int k = 0;; ++k) {
      double const open = solve(x);
      for (Index i = 0; i < moved.size(); ++i) moved[i] = x.a[i] * (h * h);
      system.plus(x.q, moved, next);
      x.q.swap(next);
      if constexpr (std::same_as<T, double>) steps_ = open <= enough || k == options_.max_iterations ? k : k + 1;
      if (k == steps_) break;
    }
    x.terms = {.force = 0.0, .bias = 0.0, .rate = 1.0 / h};
    solve(x);
    for (Index i = 0; i < x.v.size(); ++i) x.v[i] += x.a[i] * h;
  }

 private:
  template <StateScalar T>
  static double largest(VecXOf<T> const& q) {
    double most = 0.0;
    for (Index i = 0; i < q.size(); ++i) most = std::max(most, std::abs(value_of(q[i])));
    return most;
  }

  Projection options_;
  int steps_ = 0;  // after the first one
};

}  // namespace polybody
