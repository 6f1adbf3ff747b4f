#include "random_models/recursive_types.hpp"
#include "random_models/wide_types.hpp"

namespace polybody::random_models {

WideType trees_by_augmented() {
  return recursive_type<joint_coordinates::Augmented, AllForces, Framed>("trees, Augmented", names_of_framed,
                                                                         names_of_all_forces);
}

}  // namespace polybody::random_models
