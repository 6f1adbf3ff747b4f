#pragma once
#include "random_models/joint_lists.hpp"

namespace polybody::random_models {

/// Trees of these bodies with one solution method for joint coordinates, and the same models with `Constraint`.
template <class Path, class F, class Bs>
WideType recursive_type(char const* name, std::vector<char const*> const& bodies,
                        std::vector<char const*> const& forces) {
  using J = Together<AllWithMotions<JointCoordinatesBy<Path>>, AllWithMotions<Constraint>,
                     JointsBy<Constraint, Distance, Turn>>;
  return wide_type<Bs, J, F>(name, bodies, forces);
}

using Framed = Bodies<Rigid<>, polybody::planar::Rigid, Ffr, polybody::planar::Ffr>;
inline std::vector<char const*> const names_of_framed{"Rigid<>", "planar::Rigid", "Ffr", "planar::Ffr"};

}  // namespace polybody::random_models
