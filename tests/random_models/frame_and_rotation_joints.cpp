#include "random_models/joint_lists.hpp"
#include "random_models/wide_types.hpp"

namespace polybody::random_models {

WideType frame_and_rotation_joints() {
  return wide_type<Bodies<Rigid<>, Lrvf<>, Lrvf<Direct>, Ffr>, AllInSpace<Constraint>, AllForces>(
      "joints of floating frames and rotation fields", {"Rigid<>", "Lrvf<RelativeRotation>", "Lrvf<Direct>", "Ffr"},
      names_of_all_forces);
}

}  // namespace polybody::random_models
