#include "random_models/wide_types.hpp"

namespace polybody::random_models {

std::vector<WideType> all_wide_types() {
  return {rigid_joints(),       ancf_joints(),        frame_and_rotation_joints(), penalties(),     bushings(),
          policies_of_bodies(), trees_by_augmented(), trees_by_bodies(),           linear_joints(), planar_joints(),
          planar_policies()};
}

}  // namespace polybody::random_models
