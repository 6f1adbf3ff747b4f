#include "random_models/joint_lists.hpp"
#include "random_models/wide_types.hpp"

namespace polybody::random_models {

WideType ancf_joints() {
  return wide_type<Bodies<Rigid<>, AncfCable<>, AncfBeam<>, AncfBeam<Continuum<>>>, AllInSpace<Constraint>, AllForces>(
      "joints of ANCF bodies", {"Rigid<>", "AncfCable", "AncfBeam<ElasticLine>", "AncfBeam<Continuum>"},
      names_of_all_forces);
}

}  // namespace polybody::random_models
