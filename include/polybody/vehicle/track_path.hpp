#pragma once
/// \file
/// Where the links of a track lie at the start: closed, taut, and through no wheel. Not in polybody.hpp: of use to
/// vehicles only.
///
/// The length of the chain of track_walk.hpp depends on the place of the tensioner's circle; the root of
///   track_length(layout, travel) = links
/// closes the loop.

#include <algorithm>
#include <span>

#include <polybody/kinematics/frame.hpp>
#include <polybody/vehicle/track_clearances.hpp>

namespace polybody {

/// A link's frame: x from its rear pin to its front pin, z to the inner face.
struct TrackLink {
  static constexpr int none = -1;  ///< in place of a circle: it touches none

  Vec2 centre;         ///< (2) midway between the pins [m]
  double angle;        ///< b, about y [rad], −π ≤ b ≤ π
  int touches = none;  ///< the first circle in the list that a face touches

  /// In the plane y = `y` of space.
  Placement placement(double y) const { return Placement::at(Vec3(centre[0], y, centre[1]), Vec3(0.0, angle, 0.0)); }
};

/// A closed track. Pin i is the front pin of link i and the rear pin of link i − 1; both are numbered along the track's
/// direction from the first pin that sits on the sprocket.
struct TrackPath {
  TrackLayout layout;                 ///< with the tensioner's circle where it closes the loop
  double travel;                      ///< how far that is from the place given [m]
  std::vector<Vec2> pins = {};        ///< links × (2) [m]
  std::vector<TrackLink> links = {};  ///< one for each pin
  int seated = 0;                     ///< pins 0 … seated − 1 sit on the sprocket
  int first_valley = 0;               ///< the valley (see `TrackLayout::seat`) of pin 0
  /// (2) The force of a unit tension on the tensioner's circle. A force F of the tensioner along its direction d gives
  /// the track the tension F / (−pull · d).
  Vec2 pull = Vec2::Zero();

  /// In place of a circle: the pin sits on the sprocket.
  static constexpr int sprocket = -2;
  /// What pin i sits on: `sprocket`, the circle that the links on both of its sides touch, or `TrackLink::none`.
  int pin_on(int i) const {
    if (i < seated) return sprocket;
    int const ahead = links[i].touches, behind = links[i - 1].touches;
    return ahead == behind ? ahead : TrackLink::none;
  }
};

/// The frames of a closed chain's links, of its `pins` (x, z) [m]; pin i is in front of link i. A face touches a rim
/// that it is nearer to than 1e-6 p.
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

/// How well a track fits its layout, above the ground z = `ground` [m].
inline TrackClearances clearances(TrackPath const& path, double ground = -std::numeric_limits<double>::infinity()) {
  return clearances(path.layout, path.pins, ground);
}

namespace detail {

/// `place` is within the polygon of the pins: a ray from it in the direction of x crosses the chain an odd number of
/// times.
inline bool track_encloses(std::vector<Vec2> const& pins, Vec2 const& place) {
  bool within = false;
  for (std::size_t i = 0; i < pins.size(); ++i) {
    Vec2 const a = pins[i] - place, b = pins[(i + 1) % pins.size()] - place;
    if ((a[1] > 0.0) != (b[1] > 0.0) && a[1] * (b[0] - a[0]) / (a[1] - b[1]) + a[0] > 0.0) within = !within;
  }
  return within;
}

/// \throws InvalidInput where a chain that closes leaves a circle on its wrong side, or is none that can be built.
inline void check_wrapped(TrackPath const& path) {
  TrackLayout const& layout = path.layout;
  std::size_t const n = path.pins.size();
  for (TrackCircle const& c : layout.circles)
    if (bool const inside = c.side == TrackSide::inside; inside != track_encloses(path.pins, c.centre))
      throw InvalidInput{"Track: ", track_name(c), " is to lie ", (inside ? "inside" : "outside"),
                         " the track, which passes it on its other side. List the circles in the order in which the "
                         "track meets them, each with its side."};
  for (std::size_t i = 0; i < n; ++i) {
    Vec2 const before = path.pins[i] - path.pins[(i + n - 1) % n], after = path.pins[(i + 1) % n] - path.pins[i];
    double const turn = std::atan2(track_cross(before, after), before.dot(after));
    if (int(i) < path.seated && turn > 1e-9)
      throw InvalidInput{"Track: no pin can sit on '", layout.sprocket.name,
                         "', which lies inside the run that passes it. Move it outwards."};
    if (std::abs(turn) > 0.5 * std::numbers::pi + 1e-9) {
      int const on = std::max(path.links[i].touches, path.links[(i + n - 1) % n].touches);
      throw InvalidInput{"Track: the pitch ",
                         layout.pitch,
                         " m is too long for ",
                         (on < 0 ? "'" + layout.sprocket.name + "'" : track_name(layout.circles[on])),
                         ": there two links make an angle of ",
                         std::abs(turn) * 180.0 / std::numbers::pi,
                         " deg, more than a right one."};
    }
  }
  TrackClearances const gaps = clearances(path);
  if (gaps.circles < -1e-9 * layout.pitch)
    throw InvalidInput{"Track: link ",
                       gaps.link,
                       " passes ",
                       -gaps.circles,
                       " m deep through ",
                       track_name(layout.circles[gaps.circle]),
                       ". List a wheel wherever the track meets it, with its side, and leave room for the links "
                       "between it and its neighbours."};
}

/// The travel at which `links` links close the loop, of several the one nearest to zero: a scan in steps of p/16, then
/// bisection.
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
    std::string const name = sentence_of({"'", tensioner.circle, "'"});
    if (range > 0.0 && longest - shortest < 1e-9)
      throw InvalidInput{"Track: it does not touch ", name,
                         ", which therefore cannot tighten it. List the circles in the order in which the track meets "
                         "them, a wheel that it meets above and below twice."};
    bool const few = layout.links <= shortest;
    throw InvalidInput{"Track: ",
                       layout.links,
                       " links are too ",
                       (few ? "few" : "many"),
                       ". With ",
                       name,
                       " within its travel the path takes ",
                       shortest,
                       " to ",
                       longest,
                       " links. Change their number, or the tensioner's travel."};
  }
  for (int i = 0; i < 60; ++i) {
    double const middle = 0.5 * (below + above);
    (track_length(layout, middle) < layout.links ? below : above) = middle;
  }
  return above;
}

/// The runs pull where contact with the tensioner's circle begins and where it ends.
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

/// Lays the track around its circles. \throws InvalidInput, naming the circle, for circles that overlap or come in an
/// order that no track can take, too few or too many links for the tensioner's travel, and a pitch too long for a
/// wheel.
inline TrackPath wrap_track(TrackLayout const& layout) {
  detail::check_track(layout);
  double const travel = detail::track_travel(layout);
  TrackPath path{.layout = layout.tensioned(travel), .travel = travel};
  TrackLayout const& l = path.layout;
  detail::check_track_overlaps(l, true);

  detail::TrackWalk const walk = detail::track_walk(l);
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
