#pragma once
/// \file
/// Clearances between a closed chain of pins and its sprocket and circles. For vehicles; not included by polybody.hpp.

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <polybody/vehicle/track_trace.hpp>

namespace polybody {

/// Clearances of a chain of pins in its layout. A negative gap is a penetration.
struct TrackClearances {
  double stretch = 0.0;  ///< greatest error of a link's length | |rᵢ₊₁ − rᵢ| − p | [m]
  double circles = std::numeric_limits<double>::infinity();  ///< least gap between a link's faces and a rim [m]
  int link = 0, circle = 0;                                  ///< link and circle of the least gap
  double sprocket =
      std::numeric_limits<double>::infinity();  ///< distance of the innermost pin outwards from the pitch circle [m]
  double ground = std::numeric_limits<double>::infinity();  ///< least height of a link's corner above the ground [m]
};

namespace detail {

/// Gap between `circle` and the faces of the link with pins `front` and `rear`; the link is a rectangle of p × 2h.
inline double track_gap(Vec2 const& front, Vec2 const& rear, double half_thickness, TrackCircle const& circle) {
  Vec2 const chord = front - rear, arm = circle.centre - 0.5 * (front + rear);
  double const pitch = chord.norm();
  double const along = std::max(0.0, std::abs(chord.dot(arm)) / pitch - 0.5 * pitch);
  double const across = std::max(0.0, std::abs(track_cross(chord, arm)) / pitch - half_thickness);
  return std::hypot(along, across) - circle.radius;
}

}  // namespace detail

/// Clearances of a closed chain of `pins` (x, z) [m] in its `layout`, and its height above the ground z = `ground`.
inline TrackClearances clearances(TrackLayout const& layout, std::span<Vec2 const> pins,
                                  double ground = -std::numeric_limits<double>::infinity()) {
  TrackClearances found;
  for (std::size_t i = 0; i < pins.size(); ++i) {
    Vec2 const &front = pins[i], &rear = pins[(i + 1) % pins.size()];
    double const chord = (front - rear).norm(), corner = layout.half_thickness * std::abs(front[0] - rear[0]) / chord;
    found.stretch = std::max(found.stretch, std::abs(chord - layout.pitch));
    found.sprocket = std::min(found.sprocket, (front - layout.sprocket.centre).norm() - layout.pitch_radius());
    found.ground = std::min(found.ground, std::min(front[1], rear[1]) - corner - ground);
    for (std::size_t k = 0; k < layout.circles.size(); ++k)
      if (double const gap = detail::track_gap(front, rear, layout.half_thickness, layout.circles[k]);
          gap < found.circles) {
        found.circles = gap;
        found.link = int(i);
        found.circle = int(k);
      }
  }
  return found;
}

}  // namespace polybody
