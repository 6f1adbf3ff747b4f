#pragma once
/// \file
/// By which factors slopes of steps are solved, learnt from what they cost.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <algorithm>
#include <array>

namespace polybody {

/// Factors near the derivative of a step.
enum class NearFactors {
  of_step,  ///< those by which the step itself was solved: they cost nothing
  of_end,   ///< of its tangent at its end
  exact,    ///< of that with second-order terms
};

/// The factors that have taken the least, passes through the equations and what they cost themselves. Each are tried
/// in turn, as long as there is something to save, and again after a hundred steps.
class NearFactorsChoice {
 public:
  /// Another step begins: its factors.
  NearFactors next() {
    if (step_ > 0) cost_[std::size_t(now_)] = passes_ + own_cost[std::size_t(now_)];
    bool const least = passes_ == 2 * directions_;  // a correction, and another one that finds nothing
    if (step_ == 0 || step_ == period) {
      now_ = NearFactors::of_step;
      step_ = 0;
      cost_.fill(never);
    } else if (tries_) {
      tries_ = !least && now_ != NearFactors::exact;
      now_ = tries_ ? NearFactors(int(now_) + 1)
                    : NearFactors(int(std::min_element(cost_.begin(), cost_.end()) - cost_.begin()));
    }
    if (step_++ == 0) tries_ = true;
    passes_ = directions_ = 0;
    return now_;
  }
  /// Those of the step.
  NearFactors now() const { return now_; }
  /// Directions of the step that went through the equations together took so many passes.
  void add(int passes) {
    passes_ += passes;
    ++directions_;
  }

 private:
  static constexpr int period = 100;  // steps
  static constexpr double never = 1e9;
  static constexpr std::array<double, 3> own_cost{0.0, 0.7, 2.0};  // in passes with their solutions

  NearFactors now_ = NearFactors::of_step;
  bool tries_ = true;
  int step_ = 0, passes_ = 0, directions_ = 0;
  std::array<double, 3> cost_{never, never, never};
};

}  // namespace polybody
