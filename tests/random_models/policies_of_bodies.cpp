#include "random_models/joint_lists.hpp"
#include "random_models/wide_types.hpp"

namespace polybody::random_models {

WideType policies_of_bodies() {
  return wide_type<Bodies<Rigid<>, Rigid<EulerParameters>, AncfCable<>, AncfBeam<>, AncfBeam<Continuum<>>, Lrvf<>,
                          Lrvf<Direct>, Ffr>,
                   Together<JointsBy<Penalty, Spherical, Revolute>, JointsBy<PerRow, Spherical, Revolute>,
                            JointsBy<Bushing, Spherical, Weld>, JointsBy<detail::Laws, Spherical, Weld>,
                            JointsBy<Constraint, Spherical, Distance>>,
                   AllForces>("policies of bodies in space",
                              {"Rigid<>", "Rigid<EulerParameters>", "AncfCable", "AncfBeam<ElasticLine>",
                               "AncfBeam<Continuum>", "Lrvf<RelativeRotation>", "Lrvf<Direct>", "Ffr"},
                              names_of_all_forces);
}

}  // namespace polybody::random_models
