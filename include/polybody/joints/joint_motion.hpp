#pragma once
/// \file
/// The motion that a joint leaves, in coordinates: elementary motions made one after another that lead from frame a to
/// frame b. Slides come before turns.

#include <array>

#include <polybody/joints/constraint_terms.hpp>

namespace polybody {

/// One elementary motion, along or about an axis of the frame as the earlier ones have left it.
struct JointMotion {
  /// What moves along or about the axis, and by which coordinates.
  enum class Kind : unsigned char {
    slide,  ///< along the axis, one coordinate [m]
    turn,   ///< about the axis, one coordinate [rad]
    screw,  ///< about and along the axis, one coordinate [rad]
    ball    ///< about all axes, a unit quaternion; speeds in the axes of frame b [rad/s]
  };
  Kind kind = Kind::slide;  ///< slide, turn, screw or ball
  int axis = 2;             ///< 0, 1 or 2
  double pitch = 0.0;       ///< of a screw: slide for each radian [m/rad]

  int coordinates() const { return kind == Kind::ball ? 4 : 1; }
  int velocities() const { return kind == Kind::ball ? 3 : 1; }
};

/// The motions of a joint, from a to b.
struct JointMotions {
  /// In the order in which they lead from a to b; only the first `count` are meant.
  std::array<JointMotion, 4> list = {};
  int count = 0;  ///< how many motions, 0 to 4

  /// Appends a motion, the fourth at most.
  constexpr void add(JointMotion const& m) { list[std::size_t(count++)] = m; }
  auto begin() const { return list.begin(); }        ///< first motion
  auto end() const { return list.begin() + count; }  ///< behind the last one
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

/// A geometry whose motion has coordinates: it says which (`motions()`), or what it leaves free has one turn, all or
/// none.
template <class G>
concept HasMotions = requires(G const g) {
  { g.motions() } -> std::same_as<JointMotions>;
} || (HasFreeDirections<G> && detail::free_turns(G::free) != 2);

/// The motion that a geometry leaves, in joint coordinates.
template <HasMotions G>
JointMotions motions_of(G const& geometry) {
  if constexpr (requires { geometry.motions(); }) {
    return geometry.motions();
  } else {
    JointMotions out;
    for (int i = 0; i < 3; ++i)
      if (G::free[std::size_t(i)]) out.add({JointMotion::Kind::slide, i});
    if (detail::free_turns(G::free) == 3) {
      out.add({JointMotion::Kind::ball, 0});
    } else {
      for (int i = 0; i < 3; ++i)
        if (G::free[std::size_t(3 + i)]) out.add({JointMotion::Kind::turn, i});
    }
    return out;
  }
}

/// Those that stay in the plane, of a joint of both worlds: slides across the normal and the turn about it, which is
/// one of the joint's axes. \param axes (3×3) of the joint
template <class = void>  // compiled where it is used
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
