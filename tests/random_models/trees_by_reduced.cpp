#include "random_models/recursive_types.hpp"
#include "random_models/wide_types.hpp"

namespace polybody::random_models {

WideType trees_by_reduced() {
  return recursive_type<joint_coordinates::DenseMatrix, AllForces, Framed>("trees, Reduced", names_of_framed,
                                                                           names_of_all_forces);
}

}  // namespace polybody::random_models
