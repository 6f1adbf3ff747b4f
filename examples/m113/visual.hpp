#pragma once
/// \file
/// Visual shapes of the vehicle of vehicle.hpp.

#include <polybody/bodies/shared/family.hpp>
#include <polybody/io/visual.hpp>

#include "vehicle.hpp"

namespace polybody::m113 {

namespace detail {
/// Surface of the toothed rim of the sprocket, as two rings along y.
template <class = void>  // compiled only if it is used
Surface toothed_wheel(double width) {
  SprocketProfile const profile = sprocket_profile();
  Vec2 const corner = profile.corner();
  std::vector<Vec2> outline;  // points (z, x), from z towards x
  for (int k = 0; k < teeth; ++k) {
    double const middle = first_valley + 2.0 * std::numbers::pi * k / teeth;
    auto const add = [&](double radial, double across) {
      outline.emplace_back(radial * std::cos(middle) - across * std::sin(middle),
                           radial * std::sin(middle) + across * std::cos(middle));
    };
    add(corner[0], -corner[1]);
    for (int i = -3; i <= 3; ++i) {
      double const phi = flank * i / 3.0;
      add(profile.arc_centre() - valley_radius * std::cos(phi), valley_radius * std::sin(phi));
    }
    add(corner[0], corner[1]);
  }
  int const n = int(outline.size());
  Surface s = swept(2, n);
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < n; ++i) {
      Vec2 const& p = outline[std::size_t(i)];
      s.points[std::size_t(k * n + i)] = Vec3(p[1], (k - 0.5) * width, p[0]);
    }
  return s;
}

template <class Base>
void attach_hull(Visual& visual, BodyHandle<Base> const& chassis) {
  visual.attach(chassis.at(Vec3(0.1, 0, 0.35)), box({4.6, 1.5, 0.9}), "hull");
  visual.attach(chassis.at(Vec3(0.1, 0, 0.545)), box({4.6, 2.54, 0.49}), "sponsons");  // not coplanar with the hull
}

/// Attaches the shape of a wheel or of the idler.
template <class Base>
void attach_drum(Visual& visual, BodyHandle<Base> const& body, double radius) {
  Vec3 const y = Vec3::UnitY();
  for (double const rim : {-rim_y, rim_y})
    visual.attach(body.at(Vec3(0, rim, 0)), cylinder(radius, rim_width, y, 32), body.name);
  visual.attach(body.at(Vec3(0, 0, 0)), cylinder(0.3 * radius, 2.0 * rim_y, y), body.name + " hub");
  visual.attach(body.at(Vec3(0.6 * radius, rim_y + 0.5 * rim_width, 0)), cylinder(0.1 * radius, 0.02, y),
                body.name + " bolt");
}

template <class Base>
void attach_sprocket(Visual& visual, BodyHandle<Base> const& sprocket) {
  for (double const ring : {-tooth_y, tooth_y})
    visual.attach(sprocket.at(Vec3(0, ring, 0)), toothed_wheel(0.03), sprocket.name);
  visual.attach(sprocket.at(Vec3(0, 0, 0)), cylinder(0.12, 2.0 * tooth_y, Vec3::UnitY()), sprocket.name + " hub");
}

/// Attaches the shapes of the bodies that carry one track.
template <class Base>
void attach_carriers(Visual& visual, Carriers<Base> const& side) {
  for (auto const& wheel : side.wheels) attach_drum(visual, wheel, wheel_radius);
  attach_drum(visual, side.idler[0], idler_radius);
  for (auto const& arm : side.arms) visual.attach(arm.at(Vec3(0, 0, 0)), box({arm_length, 0.08, 0.08}), arm.name);
  attach_sprocket(visual, side.sprocket[0]);
}

/// True if `link` is a floating frame with a finite element model, without beam elements.
template <class Link>
bool without_bars(Link const& link) {
  if constexpr (requires { link.structure().beams; }) return link.structure().beams.empty();
  return false;
}

template <class Link>
void attach_link(Visual& visual, BodyHandle<Link> const& link, Marker<Link> const& middle) {
  if constexpr (formulation_family<Link> == families::rigid) {
    visual.attach(middle, box({0.9 * pitch, 2.0 * half_width, 2.0 * half_thickness}), link.name);
    visual.attach(link.at(Vec3(horn)), box(horn_size), link.name + " horn");
  } else if (without_bars(link.body())) {
    visual.attach(middle, box({pitch, cable_width, cable_height}), link.name);
  } else {
    visual.sweep(link, link_bar(), 4);
    if constexpr (Link::observes == MarkerKind::frame)
      visual.attach(link.at(0.5 * pitch + horn.x, 0.0, horn.z), box(horn_size), link.name + " horn");
  }
}
template <class Link>
void attach_links(Visual& visual, LinkParts<Link> const& side) {
  for (std::size_t i = 0; i < side.links.size(); ++i) attach_link(visual, side.links[i], side.middle[i]);
}
}  // namespace detail

/// Visual shapes of a `vehicle`: hull, wheels with their rims, arms, sprockets with their teeth, and track shoes with
/// their horns. Cables are drawn as swept sections.
template <class V>
Visual vehicle_visual(V const& vehicle) {
  Visual visual(vehicle.model);
  detail::attach_hull(visual, vehicle.chassis[0]);
  for (auto const& side : vehicle.sides) {
    detail::attach_carriers<typename V::Base>(visual, side);
    detail::attach_links<typename V::LinkType>(visual, side);
  }
  return visual;
}

}  // namespace polybody::m113
