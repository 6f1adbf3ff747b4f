#pragma once
/// \file
/// Tangents of a run along its steps under methods of several stages.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/gradients/stages_variant.hpp>
#include <polybody/gradients/tangent_step.hpp>
#include <polybody/gradients/variants_beside.hpp>

namespace polybody::detail {

/// What takes tangents before a step to those at its end.
template <class S, class I>
class StagesTangents {
 public:
  using V = StagesVariant<S, I>;
  using Variants = VariantsBeside<V>;

  /// Along the steps of `whole`, which must outlive it.
  [[gnu::cold]] explicit StagesTangents(V& whole) : slopes_(whole.scenario.model, whole.system, whole.method) {}

  /// The tangents of `lanes` become those at the end of a step. Returns what the last corrections changed.
  double advance(TangentStep const& step, std::span<TangentLane const> lanes, Variants& beside) {
    StepTaken const taken{step.before, step.after, step.h};
    slopes_.set(taken);
    double left = 0.0;
    beside.begin_step();
    for (std::size_t first = 0; first < lanes.size(); first += directions_.size()) {
      std::size_t const count = std::min(std::size_t(Slopes::lanes), lanes.size() - first);
      directions_.clear();
      dh_.clear();
      for (TangentLane const& lane : lanes.subspan(first, count)) {
        directions_.push_back(&lane.tangent->dx);
        dh_.push_back(lane.dh);
      }
      std::size_t places = 0;
      auto const slope = [&](EquationPlace<> const& x, std::size_t l) -> EquationSlope const& {
        if (l == 0) ++places;
        TangentLane const& lane = lanes[first + l];
        double const dt = lane.tangent->dt + (x.t - step.before.t) / step.h * lane.dh;
        beside.template of_equations<EquationPlace<>>(lane.j, {x, step.h, dt, places - 1}, by_);
        return by_;
      };
      left = std::max(left, slopes_.advance(taken, directions_, slope, dh_));
    }
    for (TangentLane const& lane : lanes) lane.tangent->dt += lane.dh;
    return left;
  }

 private:
  using Slopes = typename SlopesOfStages<I>::Type;

  Slopes slopes_;
  std::vector<State*> directions_;
  std::vector<double> dh_;
  EquationSlope by_;
};

}  // namespace polybody::detail
