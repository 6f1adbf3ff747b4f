#include "random_models/joint_lists.hpp"
#include "random_models/wide_types.hpp"

namespace polybody::random_models {

WideType planar_joints() {
  return wide_type<
      Bodies<polybody::planar::Rigid, polybody::planar::AncfCable<>, polybody::planar::Lrvf, polybody::planar::Ffr>,
      JointsBy<Constraint, PlanarRevolute, PlanarPrismatic, PlanarWeld, PointInPlane, RelativeCoordinates, Distance,
               Gear, RackAndPinion, KnifeEdge, Turn, Rate, Stroke, Slide>,
      AllForces>("joints in the plane", {"planar::Rigid", "planar::AncfCable", "planar::Lrvf", "planar::Ffr"},
                 names_of_all_forces);
}

}  // namespace polybody::random_models
