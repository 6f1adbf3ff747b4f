#pragma once
/// \file
/// Force elements that act along the coordinate of a joint, between the markers of the joint.

#include <tuple>

#include <polybody/joints/joint_coordinate.hpp>
#include <polybody/system/connections.hpp>

namespace polybody {

/// Force element of two markers that acts along a joint's angle or translation: along or about the third axis of its
/// first marker.
template <class F>
concept JointForce = requires {
  requires F::markers == 2;
  { F::Coordinate::motion } -> std::convertible_to<JointMotion::Kind>;
};

namespace detail {

/// True if H is a handle of one of the joints Js.
template <class H, class... Js>
inline constexpr bool is_joint_handle = (std::is_same_v<H, ElementHandle<Js>> || ...);

/// Refuses at compile time a joint whose geometry G has no coordinate of this kind.
template <JointMotion::Kind kind, class G>
constexpr void require_joint_coordinate() {
  static_assert(
      kind != JointMotion::Kind::turn || HasJointAngle<G>,
      "A force on an angle needs a joint that permits or prescribes exactly one rotation, such as Revolute or "
      "Cylindrical. Apply it to two markers instead; their angle is about the third axis of the first one.");
  static_assert(kind != JointMotion::Kind::slide || HasJointTranslation<G>,
                "A force on a translation needs a joint that permits or prescribes exactly one translation, such as "
                "Prismatic or Cylindrical. Apply it to two markers instead; their translation is along the third axis "
                "of the first one.");
}

/// Refuses at compile time a force F that follows another type of joint than J, or multipliers in a model that
/// `eliminates` unknowns. Returns true if F follows J.
template <class F, class J, bool eliminates>
constexpr bool require_followed() {
  constexpr bool follows = std::is_same_v<typename F::FollowedJoint, J>;
  static_assert(follows,
                "This friction follows the reaction of another type of joint. Its first template argument must be the "
                "type of the joint to which it is applied.");
  static_assert(
      !eliminates || F::multipliers == 0,
      "Friction that follows multipliers needs a model without eliminated unknowns: use Constraint instead of "
      "JointCoordinates and AncfLinear in all joints of the model.");
  return follows;
}

/// Axis of a joint's coordinate among the axes of its markers. \throws InvalidInput naming the force if the joint has
/// no such coordinate, or several.
template <class J>
[[gnu::cold]] int axis_of_coordinate(JointEntry<J> const& joint, JointMotion::Kind kind, std::string const& force) {
  int const axis = axis_of_motion(joint.joint.geometry, kind);
  if (axis < 0)
    throw InvalidInput("joint.no_angle",
                       {"\"", ErrorObject{force}, "\": joint \"", joint.name, "\" does not permit exactly one ",
                        kind == JointMotion::Kind::turn ? "rotation" : "translation",
                        ". Apply the force to two markers whose third axis is the axis of the motion."});
  return axis;
}

/// Entry of the marker number `published`, or null. The numbers of a pool ascend.
template <class Markers>
auto const* find_marker(Markers const& markers, Index published) {
  auto const at = std::lower_bound(markers.begin(), markers.end(), published,
                                   [](auto const& m, Index n) { return m.published < n; });
  return at != markers.end() && at->published == published ? &*at : nullptr;
}

/// Requires that the marker number `published` of a body of type B provides the kinematics `needs`. \throws
/// InvalidInput naming the force.
template <class B>
void require_observed(BodyPool<B> const& pool, Index published, MarkerKind needs, std::string const& force) {
  MarkerEntry<B> const* const m = find_marker(pool.markers, published);
  if (!m) return;
  MarkerKind kind = B::observes;
  if constexpr (requires { B::observes_at(m->point); }) kind = B::observes_at(m->point);
  if (kind < needs)
    throw InvalidInput("marker.no_axes",
                       {"\"", ErrorObject{force},
                        "\" needs the axes of both markers of the joint, but one of them has none (a cable, or a point "
                        "that slides along a body)."});
}

/// Adds a marker at the marker number `published` of a body of type B, whose third axis is axis k of that marker.
template <class B>
void turn_marker(ModelParts& parts, BodyPool<B>& pool, Index published, int k) {
  MarkerEntry<B> const* const found = find_marker(pool.markers, published);
  if (!found) return;
  MarkerEntry<B> const m = *found;
  Mat3 axes;
  for (int i = 0; i < 3; ++i) axes.col(i) = m.axes.col((k + 1 + i) % 3);
  parts.jacobian_size += BodyKernels<B, double>::add_marker(
      pool, {pool.entries[std::size_t(m.body)].made_in, m.body, m.point}, axes, parts.markers);
}
/// Overload for a marker on the ground.
inline void turn_marker(ModelParts& parts, Index published, int k) {
  GroundMarker const* const found = find_marker(parts.ground, published);
  if (!found) return;
  Placement turned = found->placement;
  for (int i = 0; i < 3; ++i) turned.axes.col(i) = found->placement.axes.col((k + 1 + i) % 3);
  parts.ground.push_back({turned, parts.markers});
}

/// Markers of a joint, and the index of the axis to which its coordinate refers.
struct JointAxisMarkers {
  std::array<Index, 2> markers;
  int axis;
};

/// Adds a force element on the markers of a joint, along or about their axis. \throws InvalidInput for a duplicate name
/// and for invalid parameters or markers; the message names the force.
template <JointForce F, class... Bs>
ElementHandle<F> add_joint_force(ModelParts& parts, Sequence<ForceEntry<F>>& pool, F const& force, std::string name,
                                 std::tuple<BodyPool<Bs>...>& bodies, JointAxisMarkers joint) {
  name = checked_force_name(parts, pool, force, std::move(name));
  (require_observed(std::get<BodyPool<Bs>>(bodies), joint.markers[0], F::needs, name), ...);
  (require_observed(std::get<BodyPool<Bs>>(bodies), joint.markers[1], needs_of_second<F>(), name), ...);
  parts.origin.change();
  if (joint.axis != 2)
    for (Index& marker : joint.markers) {
      (turn_marker(parts, std::get<BodyPool<Bs>>(bodies), marker, joint.axis), ...);
      turn_marker(parts, marker, joint.axis);
      marker = parts.markers++;
    }
  return enter_force(parts, pool, force, std::move(name), joint.markers);
}

}  // namespace detail
}  // namespace polybody
