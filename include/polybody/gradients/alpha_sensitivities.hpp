#pragma once
/// \file
/// Propagation of forward sensitivities over the steps of integrators of the generalised-α family.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <polybody/gradients/perturbed_model.hpp>
#include <polybody/gradients/perturbed_models.hpp>
#include <polybody/gradients/sensitivity_step.hpp>

namespace polybody::detail {

/// Propagates the forward sensitivities of a run over its steps.
template <class S, class I>
class AlphaSensitivities {
 public:
  using V = PerturbedModel<S, I>;
  using Variants = PerturbedModels<V>;

  /// \param full model of the run; must outlive this object
  [[gnu::cold]] explicit AlphaSensitivities(V& full)
      : full_(&full), slope_(full.scenario.model, full.system, full.method) {}

  /// Replaces the sensitivities in `columns` before a step by sensitivities at its end. Returns an upper estimate of
  /// the next relative correction.
  double advance(SensitivityStep const& step, std::span<TangentColumn const> columns, Variants& perturbed) {
    auto const& [before, after, h, searched] = step;
    V& spare = perturbed.itself();
    bool const corrects = spare.method.start_step(spare.system, before, h, spare.work);
    State corrected;
    if (corrects) {
      corrected = before;
      corrected.v = spare.work.v0;
    }
    own_before_ = spare.work.a0;
    own_after_ = after.history.head(after.v.size());
    for (TangentColumn const& column : columns) start_step(before, h, column, corrects, perturbed);
    StepEnds const ends{corrects ? corrected : before, after, own_before_, own_after_, h};
    slope_.set(ends, searched ? nullptr : full_->factors(h));
    perturbed.begin_step();
    constexpr std::size_t most = std::size_t(AlphaLinearisedStep<>::max_directions);
    directions_.resize(std::min(columns.size(), most));
    double left = 0.0;
    for (std::size_t first = 0, count; first < columns.size(); first += count) {
      count = std::min(first == 0 ? most - 1 : most, columns.size() - first);
      for (std::size_t l = 0; l < count; ++l) {
        TangentColumn const& column = columns[first + l];
        column.tangent->dt += column.dh;
        perturbed.template of_equations<State>(column.j, {after, h, column.tangent->dt, 0}, directions_[l].by);
        directions_[l].dx = &column.tangent->dx;
        directions_[l].dh = column.dh;
      }
      left = std::max(left, slope_.advance(ends, std::span(directions_).first(count)));
    }
    for (TangentColumn const& column : columns) push_length(*column.tangent, column.dh);
    return left;
  }

 private:
  /// Adds the derivative of the start correction, which changes velocities and algorithmic accelerations before a step
  /// from x.
  static void start_step(State const& x, double h, TangentColumn const& column, bool corrects, Variants& perturbed) {
    RunSensitivity& tangent = *column.tangent;
    double const shifted = x.history[x.history.size() - 1];
    if (!corrects && (shifted == 0.0 || column.dh == tangent.lengths[StepHistory::lengths - 1])) return;
    Index const nv = x.v.size();
    std::optional<bool> const decided = V::decided(x, h, corrects);
    State const change = perturbed.of_map(column.j, x, tangent, {h, column.dh},
                                          [&](V& v, State& y, double length) { v.set_out_change(y, length, decided); });
    tangent.dx.v += change.v;
    tangent.dx.history.head(nv) += change.history.head(nv);
  }
  /// Appends the derivative of a step length, as `StepHistory::push` appends the length.
  static void push_length(RunSensitivity& tangent, double dh) {
    constexpr Index last = StepHistory::lengths - 1;
    for (Index i = 0; i + 1 < last; ++i) tangent.lengths[i] = tangent.lengths[i + 1];
    tangent.lengths[last - 1] = tangent.lengths[last] = dh;
  }

  V* full_;
  AlphaLinearisedStep<> slope_;
  VecX own_before_, own_after_;  // algorithmic accelerations before and after the step
  std::vector<StepDirection> directions_;
};

}  // namespace polybody::detail
