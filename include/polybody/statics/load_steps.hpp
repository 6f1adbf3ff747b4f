#pragma once
#include <algorithm>

#include <polybody/statics/equilibrium_options.hpp>

namespace polybody {

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
