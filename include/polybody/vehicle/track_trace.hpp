#pragma once
/// \file
/// Taut chain of rigid links, laid once around the circles of a track. For vehicles; not included by polybody.hpp.
///
/// A link is the straight chord of length p between two pins. Its faces are at the distance h on either side. Pins
/// seated on the sprocket are corners of its pitch polygon, of radius p / (2 sin(π/N)). Away from the sprocket each
/// link turns inwards at its pin as far as the circles permit. It lies on a tangent of the next circle of radius R +
/// h, so that its face touches the rim, or on the line to the first seat of the sprocket. All links of a straight run
/// lie on one line. The chain is similar to a taut string around the same circles, but its arcs are polygons.

#include <algorithm>
#include <limits>

#include <polybody/vehicle/track_layout.hpp>

namespace polybody {
namespace detail {

inline double track_cross(Vec2 const& a, Vec2 const& b) { return a[0] * b[1] - a[1] * b[0]; }

/// Possible direction of a link, and the left turn from the previous link to this direction.
struct TrackSight {
  Vec2 direction = Vec2::Zero();  ///< (2) unit vector
  double turn;                    ///< turn to the left [rad], −3π/2 < turn ≤ π/2
};

inline TrackSight track_sight(Vec2 const& heading, Vec2 const& direction) {
  double const turn = std::atan2(track_cross(heading, direction), heading.dot(direction));
  return {direction, turn > 0.5 * std::numbers::pi ? turn - 2.0 * std::numbers::pi : turn};
}

/// Tangent from `pin` to the circle of radius r = R + h (negative for a circle outside of the track). The tangent that
/// has the circle on its right is (t c + r c⊥)/c² with t² = c² − r². c is the vector to the centre; c⊥ is c turned left
/// by 90°.
inline TrackSight track_tangent(TrackLayout const& layout, TrackCircle const& circle, Vec2 const& pin,
                                Vec2 const& heading) {
  Vec2 const c = circle.centre - pin;
  double const r = (circle.radius + layout.half_thickness) * (circle.side == TrackSide::inside ? 1.0 : -1.0);
  double const t = std::sqrt(std::max(0.0, c.squaredNorm() - r * r));
  return track_sight(heading, Vec2(t * c[0] - r * c[1], t * c[1] + r * c[0]).normalized());
}

/// Chain of one revolution: from a seat that the track certainly covers, over the circles, back to the first seat that
/// the track meets.
struct TrackTrace {
  int start;               ///< seat at which the chain begins
  int last;                ///< last seat covered by the track, ≥ start
  int first = 0;           ///< first seat covered by the track, ≤ start
  std::vector<Vec2> pins;  ///< pins from seat `start` to the pin from which a straight run leads to seat `first`
  double length = 0.0;     ///< length of the whole loop in links; a whole number only if the loop closes
};

/// Number of the seat that points from the sprocket's centre away from the mean centre of the circles.
inline int track_start(TrackLayout const& layout) {
  Vec2 away = layout.sprocket.centre;
  for (TrackCircle const& c : layout.circles) away -= c.centre / double(layout.circles.size());
  double const angle = std::atan2(away[0], away[1]) - layout.sprocket.valley;
  return int(std::lround(angle * layout.sprocket.teeth / (2.0 * std::numbers::pi)));
}

/// First seat that the track meets, among `start` and the seats in front of it. All other seats are
/// to the right of the line from `pin` to this seat, whose direction is written to `sight`.
inline int track_first_seat(TrackLayout const& layout, int start, Vec2 const& pin, Vec2 const& heading,
                            TrackSight& sight) {
  int first = start;
  sight.turn = -std::numeric_limits<double>::infinity();
  for (int k = start; k >= start - layout.sprocket.teeth / 2; --k) {
    Vec2 const chord = layout.seat(k) - pin;
    if (chord.norm() < 1e-9 * layout.pitch) continue;
    TrackSight const to = track_sight(heading, chord.normalized());
    if (to.turn > sight.turn) {
      sight = to;
      first = k;
    }
  }
  return first;
}

/// Target of the link behind the last pin of `walk`. The result is the index of a circle at or after `at`. It is −1
/// for the next seat while the chain is on the sprocket. It is the number of circles for the seat at the end of the
/// chain. Sets `heading` to the link's direction.
///
/// Circles inside the track bound a link's turn to the right, and circles outside bound it to the left. They are
/// visited in their order until a bound crosses the bound of the other side. Then the link runs to the circle of this
/// other bound. If no bounds cross, for example without circles outside, the link runs to the target furthest to the
/// left.
inline int track_target(TrackLayout const& layout, int at, Vec2& heading, TrackTrace& walk) {
  struct Bound {
    TrackSight sight;
    int by;
  };
  double const endless = std::numeric_limits<double>::infinity();
  double const same = 1e-9;  // bounds with a smaller difference are equal and belong to the earlier circle
  int const count = int(layout.circles.size());
  Vec2 const pin = walk.pins.back();
  Bound right{{heading, -endless}, count}, left{{heading, endless}, count};
  if (at < 0 && walk.last - walk.start < layout.sprocket.teeth)
    right = {track_sight(heading, (layout.seat(walk.last + 1) - pin).normalized()), -1};

  Bound* nearest = &right;
  for (int k = std::max(at, 0); k <= count; ++k) {
    bool const inside = k == count || layout.circles[k].side == TrackSide::inside;
    TrackSight sight;
    if (k < count)
      sight = track_tangent(layout, layout.circles[k], pin, heading);
    else
      walk.first = track_first_seat(layout, walk.start, pin, heading, sight);
    Bound &mine = inside ? right : left, &other = inside ? left : right;
    double const sign = inside ? 1.0 : -1.0, tighter = sign * (sight.turn - mine.sight.turn);
    if (sign * (sight.turn - other.sight.turn) > 0.0) {
      nearest = &other;
      break;
    }
    if (tighter > same) mine.by = k;
    if (tighter > 0.0) mine.sight = sight;
  }
  heading = nearest->sight.direction;
  return nearest->by;
}

inline TrackTrace track_walk(TrackLayout const& layout) {
  int const start = track_start(layout), end = int(layout.circles.size());
  TrackTrace walk{.start = start, .last = start, .pins = {layout.seat(start)}};
  Vec2 heading = (layout.seat(start) - layout.seat(start - 1)).normalized();
  for (int at = -1; at = track_target(layout, at, heading, walk), at != end;) {
    if (at < 0) ++walk.last;
    walk.pins.push_back(at < 0 ? layout.seat(walk.last) : Vec2(walk.pins.back() + layout.pitch * heading));
    if (walk.pins.size() > 100000)
      throw InvalidInput("track.sprocket",
                         {"Track: the track does not return to \"", ErrorObject{layout.sprocket.name},
                          "\". List the circles in the order in which the track meets them, each with its side."});
  }
  double const run = (layout.seat(walk.first) - walk.pins.back()).norm() / layout.pitch;
  walk.length = double(walk.pins.size() - 1) + run + double(start - walk.first);
  return walk;
}

}  // namespace detail

/// Length of the chain around `layout` with the tensioner's circle at `travel` [m], in links; rarely a whole number.
inline double track_length(TrackLayout const& layout, double travel) {
  return detail::track_walk(layout.tensioned(travel)).length;
}

}  // namespace polybody
