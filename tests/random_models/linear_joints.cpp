#include "random_models/joint_lists.hpp"
#include "random_models/wide_types.hpp"

namespace polybody::random_models {

template <class P>
using Linear = JointsBy<P, Spherical, Revolute, Weld, RelativeCoordinates, PlanarRevolute, PlanarWeld>;

WideType linear_joints() {
  return wide_type<Bodies<Rigid<>, polybody::planar::Rigid, AncfCable<>, AncfBeam<>, AncfBeam<Continuum<>>,
                          polybody::planar::AncfCable<>, polybody::planar::Lrvf>,
                   Together<Linear<AncfLinear>, Linear<Constraint>, JointsBy<Constraint, Distance>>, AllForces>(
      "linear joints",
      {"Rigid<>", "planar::Rigid", "AncfCable", "AncfBeam<ElasticLine>", "AncfBeam<Continuum>", "planar::AncfCable",
       "planar::Lrvf"},
      names_of_all_forces);
}

}  // namespace polybody::random_models
