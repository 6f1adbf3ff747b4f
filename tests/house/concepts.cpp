// Every type of the library keeps to its concept. The headers do not ask, so that programs do not compile the answers.
#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/bodies/lrvf/director_interpolation.hpp>
#include <polybody/bodies/lrvf/incremental_interpolation.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/lrvf/polar_interpolation.hpp>
#include <polybody/bodies/lrvf/rotation_interpolation.hpp>
#include <polybody/bodies/lrvf/strain_quadrature.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/bodies/rigid/rigid_euler_parameters.hpp>
#include <polybody/forces/axial_spring.hpp>
#include <polybody/forces/contact.hpp>
#include <polybody/forces/normal_force.hpp>
#include <polybody/forces/point_load.hpp>
#include <polybody/forces/spring_damper.hpp>
#include <polybody/joints/cylindrical.hpp>
#include <polybody/joints/distance.hpp>
#include <polybody/joints/gear.hpp>
#include <polybody/joints/knife_edge.hpp>
#include <polybody/joints/orientation.hpp>
#include <polybody/joints/planar/prismatic.hpp>
#include <polybody/joints/planar/revolute.hpp>
#include <polybody/joints/planar/weld.hpp>
#include <polybody/joints/plane_on_plane.hpp>
#include <polybody/joints/point_in_plane.hpp>
#include <polybody/joints/point_on_line.hpp>
#include <polybody/joints/policies/ancf_linear.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/policies/constraint.hpp>
#include <polybody/joints/policies/penalty.hpp>
#include <polybody/joints/policies/recursive.hpp>
#include <polybody/joints/prescribed_angle.hpp>
#include <polybody/joints/prescribed_distance.hpp>
#include <polybody/joints/prescribed_slide.hpp>
#include <polybody/joints/primitives.hpp>
#include <polybody/joints/prismatic.hpp>
#include <polybody/joints/rack_and_pinion.hpp>
#include <polybody/joints/relative_coordinates.hpp>
#include <polybody/joints/revolute.hpp>
#include <polybody/joints/revolute_pin.hpp>
#include <polybody/joints/rolling_disc.hpp>
#include <polybody/joints/screw.hpp>
#include <polybody/joints/spherical.hpp>
#include <polybody/joints/universal.hpp>
#include <polybody/joints/weld.hpp>
#include <polybody/math/smooth_table.hpp>
#include <polybody/solvers/block_ldlt.hpp>
#include <polybody/solvers/block_lu.hpp>
#include <polybody/solvers/dense_lu.hpp>
#include <polybody/solvers/eigen_ldlt.hpp>
#include <polybody/solvers/row_dropping.hpp>

namespace polybody {

static_assert(Body<AncfBeam<>> && Body<AncfBeam<Continuum<>>>);
static_assert(Body<AncfCable<>>);
static_assert(Body<Ffr>);
static_assert(Body<Lrvf<Objective>> && Body<Lrvf<Direct>>);
static_assert(Body<Lrvf<Objective, Full>> && Body<Lrvf<Direct, Selective>>);
static_assert(Body<planar::FullLrvf> && Body<planar::SelectiveLrvf>);
static_assert(RotationInterpolation<Objective> && RotationInterpolation<Direct>);
static_assert(Body<Lrvf<Polar>> && Body<Lrvf<Directors>>);
static_assert(RotationInterpolation<Polar> && RotationInterpolation<Directors>);
static_assert(Body<Lrvf<Incremental>> && CarriesSections<Incremental> && !FollowsNodes<Incremental>);
static_assert(StrainQuadrature<Reduced> && StrainQuadrature<Full> && StrainQuadrature<Selective>);
static_assert(Body<Rigid<>>);
static_assert(Body<Rigid<EulerParameters>> && OwnsRows<Rigid<EulerParameters>> && !OwnsRows<Rigid<>>);
static_assert(ForceElement<AxialSpring> && HasPotential<AxialSpring>);
static_assert(ForceElement<Contact<SphereOnPlane>> && HasOwnStiffness<Contact<SphereOnPlane>> &&
              HasPotential<Contact<SphereOnSphere>>);
static_assert(NormalForce<SpringDamperContact> && NormalForce<HertzContact> && NormalForce<HuntCrossleyContact>);
static_assert(ForceElement<PointForce<>> && ForceElement<PointMoment<>>);
static_assert(ForceElement<SpringDamper> && HasPotential<SpringDamper>);
static_assert(JointGeometry<Cylindrical>);
static_assert(JointGeometry<Distance>);
static_assert(JointGeometry<Gear>);
static_assert(JointGeometry<KnifeEdge>);
static_assert(JointGeometry<Orientation>);
static_assert(JointGeometry<PlaneOnPlane>);
static_assert(JointGeometry<PointInPlane>);
static_assert(JointGeometry<PointOnLine>);
static_assert(Policy<AncfLinear> && LinearInCoordinates<AncfLinear>);
static_assert(AnswersRows<Bushing, 6> && !AnswersRows<Bushing, 5> && Policy<Bushing>);
static_assert(AddsRows<Constraint> && !AddsForce<Constraint>);
static_assert(AddsForce<Penalty> && !AddsRows<Penalty>);
static_assert(AnswersRows<PenaltyPerRow<1>, 1> && !AnswersRows<PenaltyPerRow<1>, 2>);
static_assert(Policy<Recursive> && MakesJointCoordinates<Recursive>);
static_assert(JointGeometry<PrescribedAngle<Ramp>>);
static_assert(JointGeometry<PrescribedDistance<Ramp>>);
static_assert(JointGeometry<PrescribedSlide<Ramp>>);
static_assert(JointGeometry<PerpendicularAxes> && JointGeometry<ParallelAxes>);
static_assert(JointGeometry<Prismatic>);
static_assert(JointGeometry<RackAndPinion>);
static_assert(JointGeometry<RelativeCoordinates>);
static_assert(JointGeometry<Revolute>);
static_assert(JointGeometry<RevolutePin>);
static_assert(JointGeometry<RollingDisc>);
static_assert(JointGeometry<Screw>);
static_assert(JointGeometry<Spherical>);
static_assert(JointGeometry<Universal>);
static_assert(JointGeometry<Weld>);
static_assert(HasIntegral<SmoothTable> && HasCorners<SmoothTable>);
static_assert(LinearSolver<BlockLdlt>);
static_assert(LinearSolver<BlockLu> && LinearSolver<BlockSolver>);
static_assert(LinearSolver<DenseLu>);
static_assert(LinearSolver<EigenLdlt>);
static_assert(LinearSolver<RowDropping<DenseLu>> && DropsRows<RowDropping<DenseLu>>);

}  // namespace polybody

namespace polybody::planar {

static_assert(Body<AncfCable<>>);
static_assert(Body<Ffr>);
static_assert(Body<Lrvf>);
static_assert(Body<Rigid>);
static_assert(JointGeometry<Prismatic>);
static_assert(JointGeometry<Revolute>);
static_assert(JointGeometry<Weld>);

}  // namespace polybody::planar
