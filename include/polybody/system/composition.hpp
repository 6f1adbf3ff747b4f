#pragma once
/// \file
/// What composes with what: the conditions that `Model::connect` states of the types of a joint and its two bodies,
/// beside those of `Joint` itself. The tables in docs/joints.md are read off them.

#include <polybody/bodies/shared/body.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/policies/ancf_linear.hpp>
#include <polybody/joints/policies/joint_coordinates.hpp>
#include <polybody/kinematics/marker.hpp>

namespace polybody {

/// Geometry G and the bodies A and B live in the plane together, or in space.
template <class G, class A, class B>
concept SameWorld = same_world(A::world, G::world) && same_world(B::world, G::world) && same_world(A::world, B::world);

/// If P makes joint coordinates, the motion that G leaves has some.
template <class P, class G>
concept JointCoordinatesIfRequired = !JointCoordinatePolicy<P> || HasMotions<G>;

/// If P writes rows that are linear in coordinates, those of G are.
template <class P, class G>
concept LinearIfRequired = !LinearPolicy<P> || LinearGeometry<G>;

/// P can hold what G stops.
template <class P, class G>
concept EnforceablePair = MeasurableGeometry<P, G> && EnforceableGeometry<P, G> && HolonomicOrConstrained<P, G> &&
                          JointCoordinatesIfRequired<P, G> && LinearIfRequired<P, G>;

/// If P makes joint coordinates, a joint can carry body B: a rigid one, or one that deforms in a frame, which
/// `joint_coordinates::ArticulatedBody` does not solve for.
template <class P, class B>
concept CarriableBody =
    !JointCoordinatePolicy<P> || HasRigidLayout<B> ||
    (FloatingFrameBody<B> && !std::is_same_v<P, JointCoordinatesBy<joint_coordinates::ArticulatedBody>>);

/// If P eliminates coordinates, it can do so with those of body B: joints of `JointCoordinates` carry bodies with a
/// frame, those of `AncfLinear` join points that are linear in the coordinates. The ground has no coordinates.
template <class P, class B>
concept EliminableBody = std::is_same_v<B, Ground> || (CarriableBody<P, B> && (!LinearPolicy<P> || HasLinearPoints<B>));

/// A marker of body B tells as much as joint J asks of its first marker. Linear rows are read off the body itself.
template <class J, class B>
concept SufficientFirstMarker = LinearPolicy<typename J::PolicyType> || B::observes >= J::Measured::needs;

/// A marker of body B tells as much as joint J asks of its second marker.
template <class J, class B>
concept SufficientSecondMarker =
    LinearPolicy<typename J::PolicyType> || B::observes >= needs_of_second<typename J::Measured>();

}  // namespace polybody
