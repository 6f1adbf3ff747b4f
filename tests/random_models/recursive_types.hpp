#pragma once
#include "random_models/joint_lists.hpp"

namespace polybody::random_models {

/// Trees of rigid bodies by one way to solve for joint coordinates, with twins by `Constraint`.
template <class Path, class F>
WideType recursive_type(char const* name, std::vector<char const*> const& forces) {
  using J =
      Together<AllWithMotions<RecursiveBy<Path>>, AllWithMotions<Constraint>, JointsBy<Constraint, Distance, Turn>>;
  return wide_type<Bodies<Rigid<>, polybody::planar::Rigid>, J, F>(name, {"Rigid<>", "planar::Rigid"}, forces);
}

}  // namespace polybody::random_models
