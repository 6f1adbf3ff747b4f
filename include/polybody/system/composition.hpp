#pragma once
/// \file
/// What composes with what: the conditions that `Model::connect` states of the types of a joint and its two bodies,
/// beside those of `Joint` itself. The tables in docs/joints.md are read off them.

#include <polybody/bodies/shared/body.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/policies/ancf_linear.hpp>
#include <polybody/joints/policies/recursive.hpp>
#include <polybody/kinematics/marker.hpp>

namespace polybody {

/// Geometry G and the bodies A and B live in the plane together, or in space.
template <class G, class A, class B>
concept MeetInOneWorld =
    same_world(A::world, G::world) && same_world(B::world, G::world) && same_world(A::world, B::world);

/// If P makes joint coordinates, the motion that G leaves has some.
template <class P, class G>
concept HasJointCoordinates = !MakesJointCoordinates<P> || HasMotions<G>;

/// If P writes rows that are linear in coordinates, those of G are.
template <class P, class G>
concept HasLinearRows = !LinearInCoordinates<P> || LinearGeometry<G>;

/// P can hold what G stops.
template <class P, class G>
concept Holds = MeasuresGeometry<P, G> && AnswersGeometry<P, G> && HasGapToAnswer<P, G> && HasJointCoordinates<P, G> &&
                HasLinearRows<P, G>;

/// If P makes joint coordinates, a joint can carry body B: a rigid one, or one that deforms in a frame, which
/// `recursive::ArticulatedBody` does not solve for.
template <class P, class B>
concept MayBeCarried = !MakesJointCoordinates<P> || HasRigidLayout<B> ||
                       (FloatsOnFrame<B> && !std::is_same_v<P, RecursiveBy<recursive::ArticulatedBody>>);

/// If P eliminates coordinates, it can do so with those of body B: joints of `Recursive` carry bodies with a frame,
/// those of `AncfLinear` join points that are linear in the coordinates. The ground has no coordinates.
template <class P, class B>
concept MayBeEliminated =
    std::is_same_v<B, Ground> || (MayBeCarried<P, B> && (!LinearInCoordinates<P> || HasLinearPoints<B>));

/// A marker of body B tells as much as joint J asks of its first marker. Linear rows are read off the body itself.
template <class J, class B>
concept TellsEnoughFirst = LinearInCoordinates<typename J::PolicyType> || B::observes >= J::Measured::needs;

/// A marker of body B tells as much as joint J asks of its second marker.
template <class J, class B>
concept TellsEnoughSecond =
    LinearInCoordinates<typename J::PolicyType> || B::observes >= needs_of_second<typename J::Measured>();

}  // namespace polybody
