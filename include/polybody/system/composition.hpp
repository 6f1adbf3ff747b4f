#pragma once
/// \file
/// Compatibility of joints and bodies: conditions of `Model::connect` for the types of a joint and its two bodies, in
/// addition to those of `Joint`. The tables in docs/joints.md are generated from these conditions.

#include <polybody/bodies/shared/body.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/kinematics/marker.hpp>

namespace polybody {

/// Geometry G and the bodies A and B are all planar or all spatial; the ground and some geometries are both.
template <class G, class A, class B>
concept SameWorld = same_world(A::world, G::world) && same_world(B::world, G::world) && same_world(A::world, B::world);

/// If policy P uses joint coordinates, geometry G provides coordinates of its free motion.
template <class P, class G>
concept JointCoordinatesIfRequired = !JointCoordinatePolicy<P> || HasMotions<G>;

/// If policy P requires constraint equations that are linear in the coordinates, those of geometry G are linear.
template <class P, class G>
concept LinearIfRequired = !LinearPolicy<P> || LinearGeometry<G>;

/// Policy P can enforce the constraint equations of geometry G.
template <class P, class G>
concept EnforceablePair = MeasurableGeometry<P, G> && EnforceableGeometry<P, G> && HolonomicOrConstrained<P, G> &&
                          JointCoordinatesIfRequired<P, G> && LinearIfRequired<P, G>;

/// If policy P uses joint coordinates, body B is a rigid body or has a floating frame or nodes with frames. Joint
/// coordinates can determine the position of these frames only. `joint_coordinates::ArticulatedBody` supports rigid
/// bodies only.
template <class P, class B>
concept CarriableBody = !JointCoordinatePolicy<P> || HasRigidLayout<B> ||
                        ((FloatingFrameBody<B> || HasFrameNodes<B>) &&
                         !std::is_same_v<P, JointCoordinatesBy<joint_coordinates::ArticulatedBody>>);

/// If policy P eliminates coordinates, it can eliminate those of body B. `JointCoordinates` requires a rigid body, a
/// floating frame or nodes with frames, and `AncfLinear` requires points that are linear in the coordinates. The ground
/// is always supported, because it has no coordinates.
template <class P, class B>
concept EliminableBody = std::is_same_v<B, Ground> || (CarriableBody<P, B> && (!LinearPolicy<P> || HasLinearPoints<B>));

/// A marker of body B provides the kinematics that joint J requires of its first marker. Linear constraint equations
/// use the body itself instead.
template <class J, class B>
concept SufficientFirstMarker =
    LinearPolicy<typename J::PolicyType> || B::observes >= needs_of_first<typename J::Measured>();

/// A marker of body B provides the kinematics that joint J requires of its second marker.
template <class J, class B>
concept SufficientSecondMarker =
    LinearPolicy<typename J::PolicyType> || B::observes >= needs_of_second<typename J::Measured>();

}  // namespace polybody
