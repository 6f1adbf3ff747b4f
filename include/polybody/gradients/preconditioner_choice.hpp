#pragma once
/// \file
/// Choice of the approximate factorisation for the derivatives of steps, by its measured cost.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <algorithm>
#include <limits>
#include <vector>

#include <polybody/math/compiler.hpp>

namespace polybody {

/// Approximate factorisations of the matrix of a linearised step.
enum class ApproximateFactors {
  of_step,  ///< factorisation from the solution of the step itself, without further cost
  of_end,   ///< factorisation of the tangent at the end of the step
  exact,    ///< factorisation of this tangent with the terms that Newton's method omits, such as second-order terms
  turned,   ///< as `exact`, with the derivative of ⊞ in addition (gradients/increment_tangent.hpp)
};

/// Chooses the kind of factorisation with the lowest cost. The cost is the number of passes through the equations, plus
/// the cost of the factorisation. The candidates are tried one after another until one pass per group of directions is
/// sufficient. The trial is repeated every hundred steps.
class PreconditionerChoice {
 public:
  /// Candidate for the choice.
  struct Candidate {
    ApproximateFactors factors;  ///< kind of factorisation
    double cost;                 ///< cost of the factorisation [passes with their solutions]
  };

  /// \param candidates at least one, the cheapest first
  [[gnu::cold]] explicit PreconditionerChoice(std::vector<Candidate> candidates)
      : candidates_(std::move(candidates)), taken_(candidates_.size(), never) {}

  /// Begins another step. Returns its kind of factorisation.
  ApproximateFactors next() {
    if (step_ > 0) taken_[now_] = passes_ + candidates_[now_].cost + also_;
    bool const least = passes_ == directions_;  // one pass for each group
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
  /// Kind of factorisation of the current step.
  ApproximateFactors now() const { return candidates_[now_].factors; }
  /// Adds the cost of another kind, which is factorised in the same step because the chosen kind is not sufficient.
  void make(ApproximateFactors others) {
    for (Candidate const& c : candidates_)
      if (c.factors == others) also_ += c.cost;
  }
  /// Adds the passes through the equations of one group of directions of the step.
  void add(int passes) {
    passes_ += passes;
    ++directions_;
  }

 private:
  static constexpr int period = 100;  // steps
  static constexpr double never = std::numeric_limits<double>::infinity();

  std::vector<Candidate> candidates_;
  std::vector<double> taken_;  // by candidates: cost of a step [passes]
  std::size_t now_ = 0;
  double also_ = 0.0;  // cost of other factorisations in the step [passes]
  bool tries_ = true;
  int step_ = 0, passes_ = 0, directions_ = 0;
};

}  // namespace polybody
