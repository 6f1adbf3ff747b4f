#pragma once
/// \file
/// Links of a track in each body formulation.

#include <algorithm>

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/bodies/rigid/rigid_euler_parameters.hpp>
#include <polybody/kinematics/marker.hpp>

#include "data.hpp"

namespace polybody::m113 {

/// Faces of a link: the inner face touches the wheels, the outer face touches the ground.
enum class Face { wheels, ground };

namespace detail {
inline Mat3 principal(Vec3Storage const& moments) { return Vec3(moments).asDiagonal(); }
}  // namespace detail

/// Steel link with the section of [Wallin 2016, §3.6], cable_width × cable_height, with x from the rear pin to the
/// front pin. `placement` is the placement of the link's centre. Wallin 2016 does not give the height of the section.
/// With the default `height` [m] the link has the mass of a rigid link. Another `young` [Pa] keeps Poisson's ratio.
inline Bar link_bar(Placement placement = {}, double height = cable_height, double young = youngs_modulus) {
  placement.origin -= placement.axes.col(0) * (0.5 * pitch);
  return {
      .length = pitch,
      .section = Rectangle{.height = cable_width, .width = height},
      .material = Material{.density = density, .young = young, .poisson = 0.5 * youngs_modulus / shear_modulus - 1.0},
      .placement = placement};
}

/// Copy of `masses` in which a link has the mass and inertia of `link_bar` with the height h [m], like flexible links.
/// The inertia in Table 3.1 of Wallin 2016 is the inertia of a box 1.7 times as high.
inline Solids with_steel_links(Solids masses = wallin_2016, double h = cable_height) {
  double const w = cable_width, m = density * w * h * pitch, twelfth = m / 12.0;
  masses.link = {m, {twelfth * (w * w + h * h), twelfth * (pitch * pitch + h * h), twelfth * (pitch * pitch + w * w)}};
  return masses;
}

/// Creates links as bodies of type B, and their markers: pins, middle, and points of action of contact forces on the
/// middle line. `at` is the placement of the link's centre, with x to the front pin and z to the wheels. `elements` is
/// the number of elements of a flexible link; 0 selects the smallest number that the formulation permits.
///
/// Beams extend from the rear pin to the front pin, by default with one element. The mass of a `Solid` has no effect:
/// the mass follows from the section, whose height can differ from the height of a link.
template <Body B>
struct LinkOf {
  static_assert(!requires { B::frame_layout; }, "Links with a floating frame are in m113/modal_links.hpp.");

  double height = cable_height;   ///< height of the section [m]
  double young = youngs_modulus;  ///< Young's modulus [Pa]

  /// Link of `elements` elements with its centre at `at`. The mass follows from section and density, not from the
  /// `Solid`.
  B make(Solid const&, Placement const& at, int elements) const {
    return B::from(link_bar(at, height, young), std::max(elements, 1));
  }
  static auto front(BodyHandle<B> const& link) { return link.at(link.body().length()); }  ///< front pin
  static auto rear(BodyHandle<B> const& link) { return link.at(0.0); }                    ///< rear pin
  /// Point midway between the pins.
  static auto middle(BodyHandle<B> const& link) { return link.at(0.5 * link.body().length()); }
  /// Point of action of contact forces, at the distance `x` [m] in front of the link's centre.
  static auto under(BodyHandle<B> const& link, double x, Face) { return link.at(0.5 * pitch + x); }
};

/// Rigid link with mass and inertia of Wallin 2016, and markers at its pins.
template <class RotationCoordinates>
struct LinkOf<Rigid<RotationCoordinates>> {
  using Body = Rigid<RotationCoordinates>;  ///< type of a link's body
  /// Link with the mass and inertia `solid` and its centre of mass at `at`. A rigid link has no elements.
  static Body make(Solid const& solid, Placement const& at, int) {
    return Body(solid.mass, detail::principal(solid.inertia), at);
  }
  static auto front(BodyHandle<Body> const& link) { return link.at(Vec3(0.5 * pitch, 0, 0)); }  ///< front pin
  static auto rear(BodyHandle<Body> const& link) { return link.at(Vec3(-0.5 * pitch, 0, 0)); }  ///< rear pin
  static auto middle(BodyHandle<Body> const& link) { return link.at(Vec3(0, 0, 0)); }           ///< centre of mass
  /// Point of action of contact forces, at the distance `x` [m] in front of the link's centre.
  static auto under(BodyHandle<Body> const& link, double x, Face) { return link.at(Vec3(x, 0, 0)); }
};

}  // namespace polybody::m113
