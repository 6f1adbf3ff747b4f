#pragma once
/// \file
/// Projection at the end of a step (integrators/stabilisation.hpp) in any scalar type, for the derivatives of the step.

#include <polybody/gradients/evaluation_point.hpp>
#include <polybody/integrators/stabilisation.hpp>

namespace polybody {

/// `Projection::apply` at the end of a step of length h, in any scalar type.
class ProjectionDerivative {
 public:
  /// \param options options of the projection in the step itself
  explicit ProjectionDerivative(Projection const& options) : options_(options) {}

  /// Projects q and v of x onto the constraint equations. The call with doubles determines the number of Gauss–Newton
  /// iterations; calls with other scalar types repeat this number. \param solve solves the equations at x; for doubles
  /// it returns the largest constraint residual
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
  int steps_ = 0;  // number of iterations after the first one
};

}  // namespace polybody
