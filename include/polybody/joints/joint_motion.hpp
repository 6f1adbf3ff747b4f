#pragma once
/// \file
/// Relative motion that a joint permits, in coordinates: a sequence of elementary motions from frame a to frame b.
/// Translations come before rotations.

#include <array>

#include <polybody/joints/constraint_terms.hpp>

namespace polybody {

/// Elementary motion along or about an axis of the frame that results from the preceding motions.
struct JointMotion {
  /// Type of motion and its coordinates.
  enum class Kind : unsigned char {
    slide,  ///< along the axis, one coordinate [m]
    turn,   ///< about the axis, one coordinate [rad]
    screw,  ///< about and along the axis, one coordinate [rad]
    ball    ///< about all axes, a unit quaternion; generalised velocities in the axes of frame b [rad/s]
  };
  Kind kind = Kind::slide;  ///< type of motion
  int axis = 2;             ///< index of the axis: 0, 1 or 2
  double pitch = 0.0;       ///< pitch of a screw: translation per radian [m/rad]

  int coordinates() const { return kind == Kind::ball ? 4 : 1; }
  int velocities() const { return kind == Kind::ball ? 3 : 1; }
};

/// Motions of a joint, from frame a to frame b.
struct JointMotions {
  /// Motions in the order from a to b; only the first `count` are valid.
  std::array<JointMotion, 4> list = {};
  int count = 0;  ///< number of motions, 0 to 4

  /// Appends a motion; four at most.
  constexpr void add(JointMotion const& m) { list[std::size_t(count++)] = m; }
  auto begin() const { return list.begin(); }        ///< first motion
  auto end() const { return list.begin() + count; }  ///< end of the motions
  int coordinates() const {
    int n = 0;
    for (JointMotion const& m : *this) n += m.coordinates();
    return n;
  }
  int velocities() const {
    int n = 0;
    for (JointMotion const& m : *this) n += m.velocities();
    return n;
  }
};

/// Geometry whose motion has coordinates: it defines `motions()`, or its free directions contain zero, one or three
/// rotations.
template <class G>
concept HasMotions = requires(G const g) {
  { g.motions() } -> std::same_as<JointMotions>;
} || (HasFreeDirections<G> && free_turns(free_directions<G>()) != 2);

/// Motions that a geometry permits, in joint coordinates.
template <HasMotions G>
JointMotions motions_of(G const& geometry) {
  if constexpr (requires { geometry.motions(); }) {
    return geometry.motions();
  } else {
    JointMotions out;
    constexpr FreeDirections free = free_directions<G>();
    for (int i = 0; i < 3; ++i)
      if (free[std::size_t(i)]) out.add({JointMotion::Kind::slide, i});
    if (free_turns(free) == 3) {
      out.add({JointMotion::Kind::ball, 0});
    } else {
      for (int i = 0; i < 3; ++i)
        if (free[std::size_t(3 + i)]) out.add({JointMotion::Kind::turn, i});
    }
    return out;
  }
}

/// Motions of a free frame in space, or in the plane if `in_plane`. Their coordinates and velocities are those of a
/// rigid body.
template <class = void>  // compiled only if used
JointMotions free_motions(bool in_plane) {
  JointMotions out;
  for (int i = 0; i < (in_plane ? 2 : 3); ++i) out.add({JointMotion::Kind::slide, i});
  out.add({in_plane ? JointMotion::Kind::turn : JointMotion::Kind::ball, in_plane ? 2 : 0});
  return out;
}

/// Selects the `motions` of a joint that stay in the plane: translations perpendicular to the normal, and the rotation
/// about the normal. The normal is one of the joint's axes.
/// \param axes (3×3) columns are the joint's axes in world axes
template <class = void>  // compiled only if used
JointMotions in_plane(JointMotions const& motions, Mat3 const& axes) {
  auto const is_normal = [&](int axis) { return std::abs(axes(2, axis)) > 0.5; };
  JointMotions out;
  for (JointMotion const& m : motions)
    for (int i = 0; i < 3; ++i) {
      bool const ball = m.kind == JointMotion::Kind::ball;
      if (!ball && i != m.axis) continue;
      if (is_normal(i) != (m.kind == JointMotion::Kind::slide))
        out.add({ball ? JointMotion::Kind::turn : m.kind, i, m.pitch});
    }
  return out;
}

}  // namespace polybody
