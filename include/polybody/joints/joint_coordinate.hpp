#pragma once
/// \file
/// Angle or translation of a joint: geometries that have one, and the axis of the joint to which it refers.

#include <polybody/joints/joint_axis.hpp>
#include <polybody/joints/joint_motion.hpp>

namespace polybody {

/// Geometry with a joint angle: it permits one rotation about an axis of the joint, or prescribes one.
template <class G>
concept HasJointAngle = (HasFreeDirections<G> && free_turns(free_directions<G>()) == 1) || HasRotationAxis<G> ||
                        (!HasFreeDirections<G> && requires(G const g) { g.motions(); });

/// Geometry with a joint translation: it permits one translation along an axis of the joint, or prescribes one.
template <class G>
concept HasJointTranslation = (HasFreeDirections<G> && free_slides(free_directions<G>()) == 1) ||
                              (!HasFreeDirections<G> && requires(G const g) { g.motions(); }) || requires(G g) {
                                { g.axis } -> std::same_as<JointAxis&>;
                                g.law;
                              };

namespace detail {

/// Index of the axis of the one rotation or translation that a geometry permits or prescribes; −1 if there is none or
/// more than one.
template <class G>
int axis_of_motion(G const& geometry, JointMotion::Kind kind) {
  bool const turns = kind == JointMotion::Kind::turn;
  if constexpr (HasFreeDirections<G>) {
    int const first = turns ? 3 : 0;
    for (int i = 0; i < 3; ++i)
      if (free_directions<G>()[std::size_t(first + i)]) return i;
  } else if constexpr (requires { geometry.motions(); }) {
    int axis = -1, count = 0;
    for (JointMotion const& m : geometry.motions())
      if (m.kind == kind || m.kind == JointMotion::Kind::screw) axis = m.axis, ++count;
    return count == 1 ? axis : -1;
  } else {
    return 2;  // a driving constraint or a gear: the axis of the joint
  }
  return -1;
}

}  // namespace detail
}  // namespace polybody
