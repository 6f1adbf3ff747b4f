#pragma once
/// \file
/// Propagation of forward sensitivities over the steps of Runge–Kutta methods.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <polybody/gradients/perturbed_models.hpp>
#include <polybody/gradients/perturbed_stage_model.hpp>
#include <polybody/gradients/sensitivity_step.hpp>

namespace polybody::detail {

/// Propagates forward sensitivities over a step.
template <class S, class I>
class StageSensitivities {
 public:
  using V = PerturbedStageModel<S, I>;
  using Variants = PerturbedModels<V>;

  /// \param full model of the run; must outlive this object
  [[gnu::cold]] explicit StageSensitivities(V& full) : derivatives_(full.scenario.model, full.system, full.method) {}

  /// Converts, in place, the sensitivities in `columns` before a step to sensitivities at its end. Returns the largest
  /// relative change in the last corrections.
  double advance(SensitivityStep const& step, std::span<TangentColumn const> columns, Variants& perturbed) {
    StepTaken const taken{step.before, step.after, step.h};
    derivatives_.set(taken);
    double left = 0.0;
    perturbed.begin_step();
    for (std::size_t first = 0; first < columns.size(); first += directions_.size()) {
      std::size_t const count = std::min(std::size_t(Slopes::max_directions), columns.size() - first);
      directions_.clear();
      dh_.clear();
      for (TangentColumn const& column : columns.subspan(first, count)) {
        directions_.push_back(&column.tangent->dx);
        dh_.push_back(column.dh);
      }
      std::size_t places = 0;
      auto const slope = [&](EvaluationPoint<> const& x, std::size_t l) -> EquationDerivative const& {
        if (l == 0) ++places;
        TangentColumn const& column = columns[first + l];
        double const dt = column.tangent->dt + (x.t - step.before.t) / step.h * column.dh;
        perturbed.template of_equations<EvaluationPoint<>>(column.j, {x, step.h, dt, places - 1}, by_);
        return by_;
      };
      left = std::max(left, derivatives_.advance(taken, directions_, slope, dh_));
    }
    for (TangentColumn const& column : columns) column.tangent->dt += column.dh;
    return left;
  }

 private:
  using Slopes = typename StageDerivatives<I>::Type;

  Slopes derivatives_;
  std::vector<State*> directions_;
  std::vector<double> dh_;
  EquationDerivative by_;
};

}  // namespace polybody::detail
