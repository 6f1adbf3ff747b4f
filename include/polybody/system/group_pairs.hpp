#pragma once
/// \file
/// Pairs of a force group that may interact in the present state.

#include <concepts>

#include <polybody/math/sequence.hpp>
#include <polybody/system/data.hpp>
#include <polybody/system/pools.hpp>

namespace polybody::detail {

/// Frames of a force group's markers in doubles, from which the group selects its active pairs. operator()(k) returns
/// the frame of marker k of the group.
template <class F, StateScalar T>
class PairFrames {
 public:
  PairFrames(ForceEntry<F> const& e, Data<T> const& data) : e_(e), data_(data) {
    if constexpr (!std::same_as<T, double>)
      for (Index const at : e.markers) values_.push_back(values_of(data.markers[std::size_t(at)].frame));
  }
  Frame<double> const& operator()(Index k) const {
    if constexpr (std::same_as<T, double>)
      return data_.markers[std::size_t(e_.markers[std::size_t(k)])].frame;
    else
      return values_[std::size_t(k)];
  }

 private:
  ForceEntry<F> const& e_;
  Data<T> const& data_;
  Sequence<Frame<double>> values_;
};

/// Calls visit(i, j, law) for the pairs of a group that may interact in the present positions, with the indices i, j of
/// the markers in the group. A group with a search uses the pairs that it has found, and searches only after sufficient
/// motion.
template <class F, StateScalar T, class Visit>
void for_each_pair_of(ForceEntry<F> const& e, Data<T> const& data, Visit&& visit) {
  PairFrames<F, T> const frame(e, data);
  if constexpr (SearchingForceGroup<F>) {
    for (auto const& found : data.found_pairs)
      if (!e.markers.empty() && found.marker == e.markers[0])
        return e.force.for_each_pair(*static_cast<typename F::Search*>(found.search.get()), frame, visit);
  }
  e.force.for_each_pair(frame, visit);
}

}  // namespace polybody::detail
