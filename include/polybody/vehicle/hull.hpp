#pragma once
/// \file
/// What carries a track of the vehicle of m113.hpp: its bodies and how they hang together, as data.
/// Not in polybody.hpp: of use to vehicles only.

#include <string>
#include <vector>

#include <polybody/math/so3.hpp>
#include <polybody/vehicle/m113.hpp>

namespace polybody::m113 {

/// A rigid body of one side, its axes turned about y.
struct HullBody {
  std::string name;            ///< unique in the vehicle, such as "left wheel 1"
  Solid solid;                 ///< mass and moments of inertia
  Vec3 centre = Vec3::Zero();  ///< (3) world axes [m]
  double about_y = 0.0;        ///< [rad]
};

/// A joint or a spring between two bodies.
struct HullJoint {
  /// `axle`: revolute about y; `mount`: weld; `guide`: prismatic along x; `drive`: speed about y; the others: springs.
  enum class Kind { axle, mount, guide, drive, tensioner, shock };
  Kind kind;                                      ///< which joint or spring it is
  std::size_t a, b;                               ///< places among the bodies, from 1; 0 is the chassis
  Vec3 at_a = Vec3::Zero(), at_b = Vec3::Zero();  ///< (3) in the axes of the body, from its centre [m]
  std::string name;                               ///< unique in the vehicle, such as "left drive"
};

/// One side: sprocket, tensioner, idler, then wheel and arm by turns.
struct HullSide {
  static constexpr std::size_t sprocket = 1, tensioner = 2, idler = 3;  ///< places among a side's bodies from 1
  /// Place of road wheel i, 0 in front … 4.
  static constexpr std::size_t wheel(int i) { return 4 + 2 * std::size_t(i); }
  static constexpr std::size_t arm(int i) { return wheel(i) + 1; }  ///< place of the arm that carries wheel i

  std::string name;               ///< with which all names of this side begin
  std::vector<HullBody> bodies;   ///< bodies[k − 1] has the place k
  std::vector<HullJoint> joints;  ///< joints and springs of this side
};

namespace detail {
/// A place of the world in the axes of one of the bodies, from its centre.
template <class = void>  // compiled where it is used
Vec3 in_axes(std::vector<HullBody> const& bodies, std::size_t body, Vec3 const& place) {
  if (body == 0) return place - Vec3(chassis);
  HullBody const& b = bodies[body - 1];
  Vec3 const arm = place - b.centre;
  if (b.about_y == 0.0) return arm;
  return exp_so3<double>(Vec3(0, -b.about_y, 0)) * arm;
}
}  // namespace detail

/// \param idler_x where the idler is at the start [m]
/// \param sprung the arms hang on shock absorbers; else they are welded to the chassis
template <class = void>  // compiled where it is used
HullSide hull_side(Side s, Solids const& masses, double idler_x, bool sprung) {
  using enum HullJoint::Kind;
  HullSide hull{s == Side::left ? "left " : "right ", {}, {}};
  Vec3 const axle_of_sprocket = sprocket(s), axle_of_idler = idler(s, idler_x);
  hull.bodies = {{hull.name + "sprocket", masses.sprocket, axle_of_sprocket},
                 {hull.name + "tensioner", masses.tensioner, axle_of_idler},
                 {hull.name + "idler", masses.idler, axle_of_idler}};
  auto const span = [&](HullJoint::Kind kind, std::size_t a, Vec3 const& at_a, std::size_t b, Vec3 const& at_b,
                        std::string const& name) {
    hull.joints.push_back(
        {kind, a, b, detail::in_axes(hull.bodies, a, at_a), detail::in_axes(hull.bodies, b, at_b), name});
  };
  auto const join = [&](HullJoint::Kind kind, std::size_t a, std::size_t b, Vec3 const& place,
                        std::string const& name) { span(kind, a, place, b, place, name); };
  join(axle, 0, hull.sprocket, axle_of_sprocket, hull.name + "sprocket axle");
  join(drive, 0, hull.sprocket, axle_of_sprocket, hull.name + "drive");
  join(guide, 0, hull.tensioner, axle_of_idler, hull.name + "tensioner guide");
  join(axle, hull.tensioner, hull.idler, axle_of_idler, hull.name + "idler axle");
  span(tensioner, 0, idler(s, idler_reference_x), hull.tensioner, axle_of_idler, hull.name + "tensioner spring");
  for (int i = 0; i < wheels; ++i) {
    std::string const n = hull.name + "wheel " + std::to_string(i + 1);
    Vec3 const hub = wheel(i, s), pivot = arm_pivot(i, s), lower = arm_point(i, s, shock_on_arm);
    hull.bodies.push_back({n, masses.wheel, hub});
    hull.bodies.push_back({n + " arm", masses.arm, arm(i, s), arm_angle});
    join(axle, hull.arm(i), hull.wheel(i), hub, n + " axle");
    join(sprung ? axle : mount, 0, hull.arm(i), pivot, n + (sprung ? " pivot" : " mount"));
    if (sprung) span(shock, 0, lower + Vec3(0, 0, m113::shock.length), hull.arm(i), lower, n + " shock");
  }
  return hull;
}

}  // namespace polybody::m113
