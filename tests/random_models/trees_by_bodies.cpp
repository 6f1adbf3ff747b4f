#include "random_models/recursive_types.hpp"
#include "random_models/wide_types.hpp"

namespace polybody::random_models {

WideType trees_by_bodies() {
  return recursive_type<joint_coordinates::ArticulatedBody, ForcesWithoutStates,
                        Bodies<Rigid<>, polybody::planar::Rigid>>("trees, ArticulatedBody",
                                                                  {"Rigid<>", "planar::Rigid"}, names_without_states);
}

}  // namespace polybody::random_models
