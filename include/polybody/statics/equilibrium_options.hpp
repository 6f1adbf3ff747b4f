#pragma once
/// \file
/// Options and report of `equilibrium`, and its load steps.

#include <algorithm>
#include <string>
#include <vector>

#include <polybody/math/types.hpp>

namespace polybody {

/// Options of `equilibrium`: load steps and Newton iteration.
struct EquilibriumOptions {
  int load_steps = 1;  ///< number of load steps for loads and gravity, equal if none fails
  /// Smallest load step [1]. A failed step is halved. A converged step doubles the next one, up to 1/`load_steps`.
  double min_load_step = 1e-4;
  double tolerance = 1e-11;  ///< largest correction at convergence, relative to 1 + max |q|
  int max_iterations = 50;   ///< largest number of iterations in a load step

  /// \throws InvalidInput unless the counts are in [1, 10⁶] and the other numbers are positive and finite.
  void check() const {
    require_count(load_steps, "equilibrium: load_steps");
    require_positive(min_load_step, "equilibrium: min_load_step");
    require_positive(tolerance, "equilibrium: the tolerance");
    require_count(max_iterations, "equilibrium: max_iterations");
  }
};

/// Report of `equilibrium`: cost, free motions, redundant constraints and stability.
struct EquilibriumReport {
  int load_steps = 0;  ///< number of load steps that converged
  int iterations = 0;  ///< number of Newton iterations
  /// Free motions about the equilibrium, which have no stiffness and are not excited by a load, such as: body "payload"
  /// turns about (0, 0, 1) through (0, 0, -2). The displacement along free motions has minimum norm.
  std::vector<std::string> free_motions = {};
  /// Names of joints and bodies with redundant constraints, one entry per name. The multipliers of these constraints
  /// are zero.
  std::vector<std::string> redundant = {};
  /// Number of negative eigenvalues of the tangent stiffness, symmetrised, on the motions that the constraint equations
  /// permit. It is 0 in a stable state. A state with a positive number is unstable. −1 means not computed: the model
  /// has first-order states, the state is a steady rotation, or the matrix is too large (one long mechanism with more
  /// than some 10⁵ coordinates).
  int negative_pivots = 0;
  double limit_point = 0.0;  ///< load factor of a limit point or branch point on the path from the start; 0: none found
  bool relaxed = false;      ///< true: Newton's method did not converge; a damped motion found the state
  /// Warnings about an unstable state, about an equilibrium that is not on the path from the start, and about section
  /// matrices that are probably not in SI units.
  std::vector<std::string> warnings = {};
};

/// Load steps s = 0 … 1 of `equilibrium`, initially of equal length. A failed step is halved. A converged step doubles
/// the next one, up to the initial length.
class LoadSteps {
 public:
  /// Starts at s = 0, with the number of steps and the smallest step of the options.
  explicit LoadSteps(EquilibriumOptions const& options)
      : full_(1.0 / std::max(options.load_steps, 1)), smallest_(options.min_load_step), part_(full_) {}

  bool done() const { return done_ >= 1.0; }  ///< true if s = 1
  double reached() const { return done_; }    ///< s at the end of the last converged step
  /// s at the end of the next load step.
  double next() const { return done_ + part_ > 1.0 - 1e-12 ? 1.0 : done_ + part_; }
  /// Moves to `next()`, after a load step that converged.
  void reach_next() {
    done_ = next();
    part_ = std::min(2.0 * part_, full_);
  }
  /// Halves the load step. Returns false if the result is shorter than `min_load_step` of the options.
  bool halve() {
    part_ *= 0.5;
    return part_ >= smallest_;
  }
  /// Returns to s = 0 and keeps the present length of the load step.
  void restart() { done_ = 0.0; }

 private:
  double full_, smallest_, part_;
  double done_ = 0.0;
};

}  // namespace polybody
