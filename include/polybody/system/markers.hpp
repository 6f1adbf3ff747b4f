#pragma once
/// \file
/// Checks of markers and joints that are added to a model. The checks do not depend on the model's type.

#include <utility>

#include <polybody/joints/joint_axis.hpp>
#include <polybody/system/pools.hpp>

namespace polybody::detail {

/// Returns the name, or "kind n" with n = `before` + 1 if the name is empty.
inline std::string name_or_next(std::string name, char const* kind, std::size_t before) {
  return name.empty() ? kind + (" " + std::to_string(before + 1)) : std::move(name);
}

/// Joint axes (3×3) from the parameters of the joint, which are checked first. If the rotation axis of a planar joint
/// is not given, it is the normal of the plane. \throws InvalidInput naming the joint for invalid parameters.
template <bool in_plane, class J>
Mat3 checked_triad(J const& joint, std::string const& name) {
  std::string const quoted = sentence_of({"\"", name, "\""});
  if constexpr (requires { joint.geometry.check(name); }) joint.geometry.check(quoted);
  if constexpr (CompliantPolicy<typename J::PolicyType>) joint.policy.check(quoted);
  try {
    if constexpr (in_plane && HasRotationAxis<typename J::Geometry>)
      if (!joint.geometry.axis.given()) {
        typename J::Geometry about_z = joint.geometry;
        about_z.axis = Vec3(0.0, 0.0, 1.0);
        return about_z.triad();
      }
    return joint.geometry.triad();
  } catch (InvalidInput const& e) {
    throw InvalidInput({ErrorObject{quoted}, ": ", ErrorCause{e}});
  }
}

/// Requires that the marker's point provides the kinematics `needs`. \throws InvalidInput for a point without axes.
template <class B>
void require_observed(Marker<B> const& m, MarkerKind needs, std::string const& what) {
  if constexpr (requires { B::observes_at(m.point); })
    if (B::observes_at(m.point) < needs)
      throw InvalidInput("marker.no_axes", {"\"", ErrorObject{what},
                                            "\" needs axes, but a sliding point has none. Use a joint or force that "
                                            "needs a point only, such as Spherical or planar::Revolute."});
}

/// Requires markers that can move relative to each other. \throws InvalidInput if both are on the ground, or on the
/// same rigid body.
template <class A, class B>
void require_apart([[maybe_unused]] Marker<A> const& a, [[maybe_unused]] Marker<B> const& b,
                   [[maybe_unused]] std::string const& name) {
  if constexpr (std::is_same_v<A, Ground> && std::is_same_v<B, Ground>)
    throw InvalidInput("joint.same_body",
                       {"\"", ErrorObject{name}, "\" joins the ground to itself. Give it a marker of a body."});
  else if constexpr (std::is_same_v<A, B> && HasRigidLayout<A>)
    if (a.body == b.body)
      throw InvalidInput("joint.same_body",
                         {"\"", ErrorObject{name}, "\" joins a rigid body to itself. Give it markers of two bodies."});
}

/// Requires a tangent parallel to the joint's axis at a second marker without axes. \throws InvalidInput naming the
/// joint if the sine of the angle between them exceeds 1e-6.
inline void require_along_tangent(Mat3 const& axes, Mat3 const& triad, std::string const& name) {
  if (axes.col(0).cross(triad.col(2)).norm() > 1e-6)
    throw InvalidInput("joint.axis_not_tangent",
                       {"\"", ErrorObject{name},
                        "\": the second marker has a tangent but no axes, so the joint's axis must be parallel to the "
                        "tangent in the reference configuration."});
}

/// Refuses a marker or handle of another model. \throws InvalidInput naming `what`.
[[noreturn, gnu::cold]] inline void refuse_marker_of_another_model(std::string const& what) {
  throw InvalidInput("model.foreign_handle",
                     {"\"", ErrorObject{what},
                      "\" was given a marker or handle of another model. Use a marker or handle of this model."});
}

}  // namespace polybody::detail
