#pragma once
/// \file
/// Bodies that carry a track of the vehicle of m113.hpp, and the joints and springs between them, as data. For
/// vehicles; not included by polybody.hpp.

#include <string>
#include <vector>

#include <polybody/math/so3.hpp>
#include <polybody/vehicle/m113.hpp>

namespace polybody::m113 {

/// Rigid body of one side of the vehicle. Its axes may be rotated about y.
struct HullBody {
  std::string name;            ///< unique in the vehicle, such as "left wheel 1"
  Solid solid;                 ///< mass and moments of inertia
  Vec3 centre = Vec3::Zero();  ///< (3) world axes [m]
  double about_y = 0.0;        ///< rotation about y [rad]
};

/// Joint or spring between two bodies.
struct HullJoint {
  /// `axle`: revolute joint about y; `mount`: weld; `guide`: prismatic joint along x; `drive`: prescribed speed about
  /// y; the other kinds: springs.
  enum class Kind { axle, mount, guide, drive, tensioner, shock };
  Kind kind;                                      ///< kind of joint or spring
  std::size_t a, b;                               ///< numbers of the two bodies, from 1; 0 is the chassis
  Vec3 at_a = Vec3::Zero(), at_b = Vec3::Zero();  ///< (3) in the axes of the body, from its centre [m]
  std::string name;                               ///< unique in the vehicle, such as "left drive"
};

/// One side of the vehicle. Its bodies are sprocket, tensioner and idler, then a wheel and its arm for each road wheel.
struct HullSide {
  static constexpr std::size_t sprocket = 1, tensioner = 2, idler = 3;  ///< numbers of bodies of a side, from 1
  /// Number of road wheel i; i = 0 is in front, i = 4 at the rear.
  static constexpr std::size_t wheel(int i) { return 4 + 2 * std::size_t(i); }
  static constexpr std::size_t arm(int i) { return wheel(i) + 1; }  ///< number of the arm that carries wheel i

  std::string name;               ///< prefix of all names of this side
  std::vector<HullBody> bodies;   ///< bodies[k − 1] has the number k
  std::vector<HullJoint> joints;  ///< joints and springs of this side
};

namespace detail {
/// Point given in world axes, as a vector from the centre of one of the bodies, in the body's axes.
template <class = void>  // compiled only if it is used
Vec3 in_axes(std::vector<HullBody> const& bodies, std::size_t body, Vec3 const& place) {
  if (body == 0) return place - Vec3(chassis);
  HullBody const& b = bodies[body - 1];
  Vec3 const arm = place - b.centre;
  if (b.about_y == 0.0) return arm;
  return exp_so3<double>(Vec3(0, -b.about_y, 0)) * arm;
}
}  // namespace detail

/// \param idler_x initial position of the idler along x [m]
/// \param sprung true: shock absorbers support the arms; false: the arms are welded to the chassis
template <class = void>  // compiled only if it is used
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
