#include "random_models/joint_lists.hpp"
#include "random_models/wide_types.hpp"

namespace polybody::random_models {

/// All geometries with constraint functions.
template <class P>
using WithGaps = JointsBy<P, Spherical, Revolute, RevolutePin, Universal, Cylindrical, Prismatic, Screw, PlanarJoint,
                          PointOnLine, PointInPlane, ConstantOrientation, ParallelAxes, PerpendicularAxes, Weld,
                          RelativeCoordinates, Distance, Gear, RackAndPinion, Turn, Rate, Stroke, Slide>;

WideType penalties() {
  return wide_type<Bodies<Rigid<>, Rigid<EulerParameters>>,
                   Together<WithGaps<Penalty>, WithGaps<PerRow>, JointsBy<Constraint, Distance, PointInPlane>>,
                   AllForces>("penalties", {"Rigid<>", "Rigid<EulerParameters>"}, names_of_all_forces);
}

}  // namespace polybody::random_models
