// Every type of the library satisfies its concept. The headers do not check it, so that programs compile faster.
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/ancf/ancf_coupled_line.hpp>
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
#include <polybody/bodies/se3/se3_beam.hpp>
#include <polybody/forces/belt.hpp>
#include <polybody/forces/bristle_friction.hpp>
#include <polybody/forces/contact.hpp>
#include <polybody/forces/contact_set.hpp>
#include <polybody/forces/differential.hpp>
#include <polybody/forces/limits.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/forces/motors.hpp>
#include <polybody/forces/normal_force.hpp>
#include <polybody/forces/reaction_friction.hpp>
#include <polybody/forces/servo.hpp>
#include <polybody/forces/shapes/box_contact.hpp>
#include <polybody/forces/shapes/capsule_contact.hpp>
#include <polybody/forces/shapes/compound.hpp>
#include <polybody/forces/shapes/shapes_on_plane.hpp>
#include <polybody/forces/spherical_friction.hpp>
#include <polybody/forces/spring_laws.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/forces/tyre.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/gears.hpp>
#include <polybody/joints/nonholonomic.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/policies/penalty.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/joints/relative_coordinates.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/math/smooth_table.hpp>
#include <polybody/solvers/block_factor.hpp>
#include <polybody/solvers/dense_lu.hpp>
#include <polybody/solvers/eigen_ldlt.hpp>
#include <polybody/solvers/redundancy_dropping.hpp>
#include <polybody/vehicle/wheel.hpp>

namespace polybody {

static_assert(Body<AncfBeam<>> && Body<AncfBeam<CoupledLine>> && Body<AncfBeam<Continuum<>>>);
static_assert(Body<AncfCable<>>);
static_assert(Body<Ffr>);
static_assert(Body<Lrvf<RelativeRotation>> && Body<Lrvf<Direct>>);
static_assert(Body<Lrvf<RelativeRotation, FullQuadrature>> && Body<Lrvf<Direct, SelectiveQuadrature>>);
static_assert(Body<planar::FullLrvf> && Body<planar::SelectiveLrvf>);
static_assert(RotationInterpolation<RelativeRotation> && RotationInterpolation<Direct>);
static_assert(Body<Lrvf<Polar>> && Body<Lrvf<Directors>>);
static_assert(RotationInterpolation<Polar> && RotationInterpolation<Directors>);
static_assert(Body<Lrvf<Incremental>> && PathDependentInterpolation<Incremental> && !NodalInterpolation<Incremental>);
static_assert(StrainQuadrature<ReducedQuadrature> && StrainQuadrature<FullQuadrature> &&
              StrainQuadrature<SelectiveQuadrature>);
static_assert(Body<Rigid<>>);
static_assert(Body<Se3Beam>);
static_assert(Body<Rigid<EulerParameters>> && HasOwnEquations<Rigid<EulerParameters>> && !HasOwnEquations<Rigid<>>);
static_assert(ForceElement<AxialSpring> && HasPotential<AxialSpring>);
static_assert(ForceElement<Contact<SphereOnPlane>> && HasOwnStiffness<Contact<SphereOnPlane>> &&
              HasPotential<Contact<SphereOnSphere>>);
static_assert(ContactGeometry<BoxOnPlane> && ContactGeometry<CapsuleOnPlane> && ContactGeometry<PolyhedronOnPlane<>>);
static_assert(ContactGeometry<SphereOnBox> && ContactGeometry<CapsuleOnBox> && ContactGeometry<BoxOnBox>);
static_assert(ContactGeometry<CapsuleOnSphere> && ContactGeometry<CapsuleOnCapsule>);
static_assert(ContactGeometry<Compound<BoxOnPlane, CapsuleOnPlane>>);
static_assert(SearchingForceGroup<ContactSet<Shapes<Sphere, Capsule, Box, Plane>>> && !BoundedShape<Plane>);
static_assert(HasStatePotential<Contact<SphereOnPlane, SpringDamperContact, BristleFriction>>);
static_assert(ScalarLaw<DryFriction> && ScalarLaw<LuGreFriction>);
static_assert(ForceElement<SphericalFriction> && HasStatePotential<SphericalBristleFriction>);
static_assert(FollowsReaction<BearingFriction<Joint<Revolute, Constraint>>> &&
              !FollowsReaction<BearingFriction<Joint<Revolute, Penalty>>>);
static_assert(NormalForce<SpringDamperContact> && NormalForce<HertzContact> && NormalForce<HuntCrossleyContact>);
static_assert(ForceElement<BeltAndPulley<2>> && HasStates<BeltAndPulley<2>>);
static_assert(ForceElement<Differential> && HasStatePotential<Differential>);
static_assert(ScalarLaw<LinearSpring> && ScalarLaw<TwoSlopeSpring> && ScalarLaw<TableSpring> && ScalarLaw<TableDamper>);
static_assert(ScalarLaw<Rope> && ScalarLaw<Winch<Ramp>> && ScalarLaw<FunctionSpring<LinearLaw>>);
static_assert(ScalarLaw<Limit> && ScalarLaw<Backlash> && ScalarLaw<BumpStop>);
static_assert(ForceElement<JointLimit> && HasPotential<JointLimit> && HasStatePotential<TorsionalSpringDamper>);
static_assert(ScalarLaw<Servo<>> && ScalarLaw<PidServo<>> && ScalarLaw<RateLimited<PidServo<>>>);
static_assert(ScalarLaw<DcMotor<>> && ScalarLaw<TorqueSpeedCurve<>>);
static_assert(ForceElement<PointForce<>> && ForceElement<PointMoment<>>);
static_assert(ForceElement<SpringDamper> && HasPotential<SpringDamper>);
static_assert(TyreLaw<LinearTyre> && TyreLaw<MagicFormula>);
static_assert(ForceElement<Wheel<LinearTyre>> && HasStatePotential<Wheel<MagicFormula, HeightField>>);
static_assert(JointGeometry<Cylindrical>);
static_assert(JointGeometry<Distance>);
static_assert(JointGeometry<Gear>);
static_assert(JointGeometry<KnifeEdge>);
static_assert(JointGeometry<ConstantOrientation>);
static_assert(JointGeometry<PlanarJoint>);
static_assert(JointGeometry<PointInPlane>);
static_assert(JointGeometry<PointOnLine>);
static_assert(Policy<AncfLinear> && LinearPolicy<AncfLinear>);
static_assert(CompliantLaw<Bushing, 6> && !CompliantLaw<Bushing, 5> && Policy<Bushing>);
static_assert(ConstrainingPolicy<Constraint> && !CompliantPolicy<Constraint>);
static_assert(CompliantPolicy<Penalty> && !ConstrainingPolicy<Penalty>);
static_assert(CompliantLaw<PenaltyPerEquation<1>, 1> && !CompliantLaw<PenaltyPerEquation<1>, 2>);
static_assert(Policy<JointCoordinates> && JointCoordinatePolicy<JointCoordinates>);
static_assert(JointGeometry<PrescribedAngle<Ramp>>);
static_assert(JointGeometry<PrescribedDistance<Ramp>>);
static_assert(JointGeometry<PrescribedTranslation<Ramp>>);
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
static_assert(HasIntegral<SmoothTable> && HasBreakpoints<SmoothTable>);
static_assert(LinearSolver<BlockLdlt>);
static_assert(LinearSolver<BlockLu> && LinearSolver<BlockSolver>);
static_assert(LinearSolver<DenseLu>);
static_assert(LinearSolver<EigenLdlt>);
static_assert(LinearSolver<RedundancyDropping<DenseLu>> && RedundancyAwareSolver<RedundancyDropping<DenseLu>>);

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
