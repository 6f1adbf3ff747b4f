#pragma once
/// \file
/// Initial positions of the links of a track: a closed and taut chain that penetrates no wheel.
///
/// The length of the chain that track_trace.hpp lays around the circles depends on the position of the tensioner's
/// circle. The root of
///   track_length(layout, travel) = links
/// is the travel at which the loop is closed.
/// Theory: Eqs. 8.42 to 8.44.

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <polybody/kinematics/frame.hpp>
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

/// Frame of a link: x from its rear pin to its front pin, z to the inner face.
struct TrackLink {
  static constexpr int none = -1;  ///< value of `touches` for a link without contact

  Vec2 centre;         ///< (2) point midway between the pins [m]
  double angle;        ///< b, rotation about y [rad], −π ≤ b ≤ π
  int touches = none;  ///< first circle in the list that touches a face

  /// Placement in space, in the plane y = `y`.
  Placement placement(double y) const { return Placement::at(Vec3(centre[0], y, centre[1]), Vec3(0.0, angle, 0.0)); }
};

/// Closed track. Pin i is the front pin of link i and the rear pin of link i − 1. Pins and links are numbered along the
/// track's direction from the first pin that is seated on the sprocket.
struct TrackPath {
  TrackLayout layout;                 ///< layout with the tensioner's circle at the position that closes the loop
  double travel;                      ///< travel of the tensioner's circle from its given position [m]
  std::vector<Vec2> pins = {};        ///< links × (2) positions of the pins [m]
  std::vector<TrackLink> links = {};  ///< frames of the links
  int seated = 0;                     ///< number of pins on the sprocket, pins 0 … seated − 1
  int first_valley = 0;               ///< number of the valley (see `TrackLayout::seat`) of pin 0
  /// (2) Force on the tensioner's circle due to a unit tension of the track. If the tensioner's force along its
  /// direction, the unit vector d, is F, then the tension is F / (−pull · d).
  Vec2 pull = Vec2::Zero();

  /// Value of `pin_on` for a pin that is seated on the sprocket.
  static constexpr int sprocket = -2;
  /// Support of pin i: `sprocket`, the index of the circle that both adjacent links touch, or `TrackLink::none`.
  int pin_on(int i) const {
    if (i < seated) return sprocket;
    int const ahead = links[i].touches, behind = links[i - 1].touches;
    return ahead == behind ? ahead : TrackLink::none;
  }
};

/// Frames of the links of a closed chain with the given `pins` (x, z) [m]; pin i is in front of link i. A face touches
/// a rim if their distance is less than 1e-6 times the pitch.
inline std::vector<TrackLink> track_links(TrackLayout const& layout, std::span<Vec2 const> pins) {
  std::vector<TrackLink> links;
  for (std::size_t i = 0; i < pins.size(); ++i) {
    Vec2 const &front = pins[i], &rear = pins[(i + 1) % pins.size()];
    Vec2 const x = front - rear;
    links.push_back({.centre = 0.5 * (front + rear), .angle = std::atan2(-x[1], x[0])});
    for (std::size_t k = layout.circles.size(); k-- > 0;)
      if (std::abs(detail::track_gap(front, rear, layout.half_thickness, layout.circles[k])) < 1e-6 * layout.pitch)
        links.back().touches = int(k);
  }
  return links;
}

/// Clearances of a track in its layout, above the ground z = `ground` [m].
inline TrackClearances clearances(TrackPath const& path, double ground = -std::numeric_limits<double>::infinity()) {
  return clearances(path.layout, path.pins, ground);
}

namespace detail {

/// Checks that the point `place` is inside the polygon of the pins. In this case, a ray from the point along x crosses
/// the chain an odd number of times.
inline bool track_encloses(std::vector<Vec2> const& pins, Vec2 const& place) {
  bool within = false;
  for (std::size_t i = 0; i < pins.size(); ++i) {
    Vec2 const a = pins[i] - place, b = pins[(i + 1) % pins.size()] - place;
    if ((a[1] > 0.0) != (b[1] > 0.0) && a[1] * (b[0] - a[0]) / (a[1] - b[1]) + a[0] > 0.0) within = !within;
  }
  return within;
}

/// Checks a closed chain. \throws InvalidInput if the chain passes a circle on the wrong side or cannot be built.
inline void check_wrapped(TrackPath const& path) {
  TrackLayout const& layout = path.layout;
  std::size_t const n = path.pins.size();
  for (TrackCircle const& c : layout.circles)
    if (bool const inside = c.side == TrackSide::inside; inside != track_encloses(path.pins, c.centre))
      throw InvalidInput("track.side",
                         {"Track: ", ErrorObject{track_name(c)}, " must lie ", (inside ? "inside" : "outside"),
                          " the track, but the track passes it on the other side. List the circles in the order in "
                          "which the track meets them, each with its side."});
  for (std::size_t i = 0; i < n; ++i) {
    Vec2 const before = path.pins[i] - path.pins[(i + n - 1) % n], after = path.pins[(i + 1) % n] - path.pins[i];
    double const turn = std::atan2(track_cross(before, after), before.dot(after));
    if (int(i) < path.seated && turn > 1e-9)
      throw InvalidInput(
          "track.sprocket",
          {"Track: no pin can sit on \"", ErrorObject{layout.sprocket.name},
           "\". The sprocket lies inside the straight line between the previous and the next wheel of the track. "
           "Move the sprocket outwards."});
    if (std::abs(turn) > 0.5 * std::numbers::pi + 1e-9) {
      int const on = std::max(path.links[i].touches, path.links[(i + n - 1) % n].touches);
      throw InvalidInput("track.pitch",
                         {"Track: the pitch ", ErrorValue{layout.pitch}, " m is too long for ",
                          ErrorObject{on < 0 ? "\"" + layout.sprocket.name + "\"" : track_name(layout.circles[on])},
                          ": two links make an angle of ", std::abs(turn) * 180.0 / std::numbers::pi,
                          " deg there; the limit is 90 deg."});
    }
  }
  TrackClearances const gaps = clearances(path);
  if (gaps.circles < -1e-9 * layout.pitch)
    throw InvalidInput("track.overlap",
                       {"Track: link ", gaps.link, ", counted from 0, lies ", ErrorValue{-gaps.circles}, " m inside ",
                        ErrorObject{track_name(layout.circles[gaps.circle])},
                        ". List a wheel once for each contact with the track, with its side, and "
                        "leave room for the links between neighbouring wheels."});
}

/// Travel of the tensioner at which the links of the layout close the loop, by a scan in steps of at most p/16 and
/// bisection. If there are several solutions, the solution nearest to zero is returned.
inline double track_travel(TrackLayout const& layout) {
  TrackTensioner const& tensioner = layout.tensioner;
  double const range = tensioner.most - tensioner.least;
  int const steps = std::max(1, int(std::ceil(16.0 * range / layout.pitch)));
  double best = std::numeric_limits<double>::infinity(), shortest = best, longest = 0.0, below = 0.0, above = 0.0,
         before = 0.0;
  for (int i = 0; i <= steps; ++i) {
    double const travel = tensioner.least + range * i / steps, length = track_length(layout, travel);
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
    bool const long_enough = length >= layout.links;
    double const last = travel - range / steps;
    if (i > 0 && long_enough != (before >= layout.links) && std::abs(travel) < best) {
      best = std::abs(travel);
      below = long_enough ? last : travel;
      above = long_enough ? travel : last;
    }
    before = length;
  }
  if (!std::isfinite(best)) {
    std::string const name = sentence_of({"\"", tensioner.circle, "\""});
    if (range > 0.0 && longest - shortest < 1e-9)
      throw InvalidInput(
          "track.tensioner",
          {"Track: the track does not touch ", ErrorObject{name},
           ", so this circle cannot tighten the track. List the circles in the order in which the track meets "
           "them; list a wheel twice if the track meets it above and below."});
    bool const few = layout.links <= shortest;
    throw InvalidInput("track.links",
                       {ErrorObject{"Track"}, ": ", ErrorValue{layout.links}, " links are too ", (few ? "few" : "many"),
                        ". With ", name, " within its travel the path needs ", shortest, " to ", longest,
                        " links. Change the number of links, or the tensioner's travel."});
  }
  for (int i = 0; i < 60; ++i) {
    double const middle = 0.5 * (below + above);
    (track_length(layout, middle) < layout.links ? below : above) = middle;
  }
  return above;
}

/// Force on the tensioner's circle due to a unit tension of the track. The straight runs pull at the two ends of the
/// contact with the circle.
inline Vec2 track_pull(TrackPath const& path) {
  std::size_t const n = path.links.size();
  auto const tightened = [&](std::size_t i) {
    int const on = path.links[i % n].touches;
    return on >= 0 && path.layout.circles[on].name == path.layout.tensioner.circle;
  };
  Vec2 pull = Vec2::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    Vec2 const along = (path.pins[(i + 1) % n] - path.pins[i]) / path.layout.pitch;
    if (tightened(i) && !tightened(i + n - 1)) pull -= along;
    if (tightened(i) && !tightened(i + 1)) pull += along;
  }
  return pull;
}

}  // namespace detail

/// Computes the path of a track around its circles. \throws InvalidInput if a number of the layout is outside of its
/// range, and, naming the circle, if circles overlap, if their order is impossible for a track, if the pitch is too
/// long for a wheel, or if no travel of the tensioner closes the loop.
inline TrackPath wrap_track(TrackLayout const& layout) {
  detail::check_track(layout);
  double const travel = detail::track_travel(layout);
  TrackPath path{.layout = layout.tensioned(travel), .travel = travel};
  TrackLayout const& l = path.layout;
  detail::check_track_overlaps(l, true);

  detail::TrackTrace const walk = detail::track_walk(l);
  path.first_valley = walk.first;
  path.seated = walk.last - walk.first + 1;
  for (int k = walk.first; k < walk.start; ++k) path.pins.push_back(l.seat(k));
  path.pins.insert(path.pins.end(), walk.pins.begin(), walk.pins.end());
  Vec2 const from = path.pins.back(), to = path.pins.front();
  for (int i = 1, run = l.links + 1 - int(path.pins.size()); i < run; ++i)
    path.pins.push_back(from + (double(i) / run) * (to - from));
  path.links = track_links(l, path.pins);

  detail::check_wrapped(path);
  path.pull = detail::track_pull(path);
  return path;
}

}  // namespace polybody
