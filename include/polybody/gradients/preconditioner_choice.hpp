#pragma once
/// \file
/// By which factors slopes of steps are solved, learnt from what they cost.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <algorithm>
#include <limits>
#include <vector>

#include <polybody/math/compiler.hpp>

namespace polybody {

/// Factors near the derivative of a step.
enum class ApproximateFactors {
  of_step,  ///< those by which the step itself was solved: they cost nothing
  of_end,   ///< of its tangent at its end
  exact,    ///< of that with all that steps leave out, second-order terms among it
  turned,   ///< of that with what ⊞ does to its columns (gradients/increment_tangent.hpp)
};

/// The factors that have taken the least, passes through the equations and what they cost themselves. Each are tried
/// in turn, as long as there is something to save, and again after a hundred steps.
class PreconditionerChoice {
 public:
  /// Factors that may be taken.
  struct Candidate {
    ApproximateFactors factors;  ///< which
    double cost;                 ///< what they cost themselves [passes with their solutions]
  };

  /// \param candidates at least one, the cheapest first
  [[gnu::cold]] explicit PreconditionerChoice(std::vector<Candidate> candidates)
      : candidates_(std::move(candidates)), taken_(candidates_.size(), never) {}

  /// Another step begins: its factors.
  ApproximateFactors next() {
    if (step_ > 0) taken_[now_] = passes_ + candidates_[now_].cost + also_;
    bool const least = passes_ == directions_;  // one correction each
    if (step_ == 0 || step_ == period) {
      now_ = 0;
      step_ = 0;
      taken_.assign(candidates_.size(), never);
    } else if (tries_) {
      tries_ = !least && now_ + 1 < candidates_.size();
      now_ = tries_ ? now_ + 1 : std::size_t(std::min_element(taken_.begin(), taken_.end()) - taken_.begin());
    }
    if (step_++ == 0) tries_ = true;
    passes_ = directions_ = 0;
    also_ = 0.0;
    return now();
  }
  /// Those of the step.
  ApproximateFactors now() const { return candidates_[now_].factors; }
  /// Those that were taken did not do: others were made within the step.
  void make(ApproximateFactors others) {
    for (Candidate const& c : candidates_)
      if (c.factors == others) also_ += c.cost;
  }
  /// Directions of the step that went through the equations together took so many passes.
  void add(int passes) {
    passes_ += passes;
    ++directions_;
  }

 private:
  static constexpr int period = 100;  // steps
  static constexpr double never = std::numeric_limits<double>::infinity();

  std::vector<Candidate> candidates_;
  std::vector<double> taken_;  // by candidates: passes of a step
  std::size_t now_ = 0;
  double also_ = 0.0;  // what other factors in the step cost [passes]
  bool tries_ = true;
  int step_ = 0, passes_ = 0, directions_ = 0;
};

}  // namespace polybody
