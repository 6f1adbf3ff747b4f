#pragma once
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

}  // namespace polybody::detail
