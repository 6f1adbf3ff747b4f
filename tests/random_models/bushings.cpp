#include "random_models/joint_lists.hpp"
#include "random_models/wide_types.hpp"

namespace polybody::random_models {

/// All geometries of space that name their freedoms.
template <class P>
using WithFreedoms = JointsBy<P, Spherical, Revolute, Cylindrical, Prismatic, PlanarJoint, PointOnLine, PointInPlane,
                              ConstantOrientation, ParallelAxes, Weld, RelativeCoordinates>;

WideType bushings() {
  return wide_type<
      Bodies<Rigid<>, Rigid<EulerParameters>>,
      Together<WithFreedoms<Bushing>, WithFreedoms<detail::Laws>, JointsBy<Constraint, Distance, PointInPlane>>,
      AllForces>("bushings", {"Rigid<>", "Rigid<EulerParameters>"}, names_of_all_forces);
}

}  // namespace polybody::random_models
