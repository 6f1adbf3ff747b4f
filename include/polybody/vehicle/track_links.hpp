#pragma once
/// \file
/// The links of a track under each body formulation. Not in polybody.hpp: of use to vehicles only.

#include <algorithm>

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/bodies/rigid/rigid_euler_parameters.hpp>
#include <polybody/kinematics/marker.hpp>
#include <polybody/vehicle/m113.hpp>

namespace polybody::m113 {

/// The sides of a link that touch something: the inner one the wheels, the outer one the ground.
enum class Face { wheels, ground };

namespace detail {
inline Mat3 principal(Triple const& moments) { return Vec3(moments).asDiagonal(); }
}  // namespace detail

/// A link of steel with the section of §3.6: [m113::cable_width × cable_height], x from the rear pin to the front pin.
/// `placement` is that of its centre. The thesis does not give the section: that height has the mass of a rigid link,
/// and `height` is another [m].
inline Bar link_bar(Placement placement = {}, double height = cable_height) {
  placement.origin -= placement.axes.col(0) * (0.5 * pitch);
  return {
      .length = pitch,
      .section = Rectangle{.height = cable_width, .width = height},
      .material =
          Material{.density = density, .young = youngs_modulus, .poisson = 0.5 * youngs_modulus / shear_modulus - 1.0},
      .placement = placement};
}

/// `masses` with links of the mass and inertia of that bar, of height h [m], as flexible links have them; T3.1 has the
/// inertia of a box 1.7 times as high.
inline Solids with_steel_links(Solids masses = thesis, double h = cable_height) {
  double const w = cable_width, m = density * w * h * pitch, twelfth = m / 12.0;
  masses.link = {m, {twelfth * (w * w + h * h), twelfth * (pitch * pitch + h * h), twelfth * (pitch * pitch + w * w)}};
  return masses;
}

/// How a link is made as a body of type B, and which points of it are its pins, its middle, and the places on its
/// middle line where what touches a face acts. `at` is the placement of the link's centre, x to the front pin, z to the
/// wheels; `elements` how many it has if it is flexible, 0 for as few as its formulation does with.
///
/// Beams lie from the rear pin to the front pin, one element unless more are asked for. The mass of a `Solid` is in the
/// section, whose height may be another than a link's.
template <Body B>
struct LinkOf {
  static_assert(!requires { B::frame_layout; }, "Links with a floating frame are in vehicle/modal_links.hpp.");

  double height = cable_height;  ///< of the section [m]

  /// A link of `elements` with its centre at `at`; its mass follows from section and density, not from the `Solid`.
  B make(Solid const&, Placement const& at, int elements) const {
    return B::from(link_bar(at, height), std::max(elements, 1));
  }
  static auto front(BodyHandle<B> const& link) { return link.at(link.body().length()); }  ///< the front pin
  static auto rear(BodyHandle<B> const& link) { return link.at(0.0); }                    ///< the rear pin
  /// Midway between the pins.
  static auto middle(BodyHandle<B> const& link) { return link.at(0.5 * link.body().length()); }
  /// Where what touches a face acts, `x` [m] ahead of the link's centre.
  static auto under(BodyHandle<B> const& link, double x, Face) { return link.at(0.5 * pitch + x); }
};

/// A rigid link: mass and inertia of the thesis, markers at its pins.
template <class RotationCoordinates>
struct LinkOf<Rigid<RotationCoordinates>> {
  using Body = Rigid<RotationCoordinates>;  ///< what a link is made as
  /// A link with its centre of mass at `at`; a rigid one has no elements.
  static Body make(Solid const& solid, Placement const& at, int) {
    return Body(solid.mass, detail::principal(solid.inertia), at);
  }
  static auto front(BodyHandle<Body> const& link) { return link.at(Vec3(0.5 * pitch, 0, 0)); }  ///< the front pin
  static auto rear(BodyHandle<Body> const& link) { return link.at(Vec3(-0.5 * pitch, 0, 0)); }  ///< the rear pin
  static auto middle(BodyHandle<Body> const& link) { return link.at(Vec3(0, 0, 0)); }           ///< the centre of mass
  /// Where what touches a face acts, `x` [m] ahead of the link's centre.
  static auto under(BodyHandle<Body> const& link, double x, Face) { return link.at(Vec3(x, 0, 0)); }
};

}  // namespace polybody::m113
