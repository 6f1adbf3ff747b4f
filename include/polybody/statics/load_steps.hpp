#pragma once
#include <algorithm>

#include <polybody/statics/equilibrium_options.hpp>

namespace polybody {

/// The way s = 0 … 1 in equal parts: a part that fails is halved, and the next one is twice as large again.
class LoadSteps {
 public:
  /// s = 0, with the number of parts and the smallest one that the options name.
  explicit LoadSteps(EquilibriumOptions const& options)
      : whole_(1.0 / std::max(options.load_steps, 1)), smallest_(options.smallest_part), part_(whole_) {}

  bool done() const { return done_ >= 1.0; }  ///< whether s = 1
  double reached() const { return done_; }    ///< s
  /// Where the next part ends.
  double next() const { return done_ + part_ > 1.0 - 1e-12 ? 1.0 : done_ + part_; }
  /// Moves to `next()`, after a part that converged.
  void reach_next() {
    done_ = next();
    part_ = std::min(2.0 * part_, whole_);
  }
  /// False where the part becomes smaller than the smallest one.
  bool halve() {
    part_ *= 0.5;
    return part_ >= smallest_;
  }
  /// Back to s = 0, with parts as they are.
  void restart() { done_ = 0.0; }

 private:
  double whole_, smallest_, part_;
  double done_ = 0.0;
};

}  // namespace polybody
