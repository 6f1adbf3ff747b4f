#include "random_models/joint_lists.hpp"
#include "random_models/wide_types.hpp"

namespace polybody::random_models {

template <class P>
using InPlane = JointsBy<P, PlanarRevolute, PlanarPrismatic, PlanarWeld, PointInPlane>;

WideType planar_policies() {
  return wide_type<
      Bodies<polybody::planar::Rigid, polybody::planar::AncfCable<>, polybody::planar::Lrvf, polybody::planar::Ffr>,
      Together<InPlane<Penalty>, InPlane<PerRow>, InPlane<Bushing>, InPlane<detail::Laws>,
               JointsBy<AncfLinear, PlanarRevolute, PlanarWeld>,
               JointsBy<Constraint, PlanarRevolute, PlanarWeld, Distance>>,
      AllForces>("policies in the plane", {"planar::Rigid", "planar::AncfCable", "planar::Lrvf", "planar::Ffr"},
                 names_of_all_forces);
}

}  // namespace polybody::random_models
