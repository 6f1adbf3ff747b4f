#include "random_models/joint_lists.hpp"
#include "random_models/wide_types.hpp"

namespace polybody::random_models {

WideType rigid_joints() {
  return wide_type<Bodies<Rigid<>, Rigid<EulerParameters>>, AllInSpace<Constraint>, AllForces>(
      "joints of rigid bodies", {"Rigid<>", "Rigid<EulerParameters>"}, names_of_all_forces);
}

}  // namespace polybody::random_models
