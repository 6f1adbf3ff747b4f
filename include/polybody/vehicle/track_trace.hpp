#pragma once
/// \file
/// Taut chain of rigid links, laid once around the circles of a track.
///
/// A link is the straight chord of length p between two pins. Its faces are at the distance h on either side. Pins
/// seated on the sprocket are corners of its pitch polygon, of radius p / (2 sin(π/N)). Away from the sprocket each
/// link turns inwards at its pin as far as the circles permit. It lies on a tangent of the next circle of radius R +
/// h, so that its face touches the rim, or on the line to the first seat of the sprocket. All links of a straight run
/// lie on one line. The chain is similar to a taut string around the same circles, but its arcs are polygons.
/// Theory: Eqs. 8.40, 8.41.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <polybody/math/types.hpp>

namespace polybody {

// Layout of a track: its links, the circles that it goes around, and the tensioner.
//
// The layout lies in a plane with x to the right (forward) and z up. The y axis points to the left of the vehicle,
// away from the viewer. The track moves in the direction of a positive rotation about y: forward on top, rearward
// along the ground. Points are (x, z) [m]. A rotation by b about y turns x into (cos b, −sin b) and z into (sin b,
// cos b).

/// Side of the track on which a circle lies: inside (touches the links' inner faces) or outside (touches the links'
/// outer faces).
enum class TrackSide { inside, outside };

/// Wheel, idler or roller: a circle in the plane of the track.
struct TrackCircle {
  std::string name;                    ///< name, for reference by the tensioner and in messages
  Vec2 centre;                         ///< (2) position [m]
  Required<double> radius;             ///< R, radius of the rim [m]
  TrackSide side = TrackSide::inside;  ///< selects the faces of the track that touch the circle
};

/// Driven wheel of the track. A pin is seated in each valley that the track covers.
struct TrackSprocket {
  std::string name = "sprocket";  ///< name in messages
  Vec2 centre;                    ///< (2) position [m]
  Required<int> teeth;            ///< N, number of teeth
  Required<double> valley;        ///< angle of any one valley, from z towards x [rad]
};

/// Tensioner of the track: a circle with an adjustable position.
struct TrackTensioner {
  std::string circle;      ///< name of the circle that moves
  Vec2 direction;          ///< (2) direction of motion, a vector of any positive length [1]
  Required<double> least;  ///< lower limit of the travel from the position in `TrackLayout::circles` [m]
  Required<double> most;   ///< upper limit of the travel from the position in `TrackLayout::circles` [m]
};

/// Data that determine the path of a track.
struct TrackLayout {
  Required<int> links;              ///< number of links in the closed loop
  Required<double> pitch;           ///< p, distance between two pins [m]
  Required<double> half_thickness;  ///< h, distance from the line through a link's pins to either face [m]
  TrackSprocket sprocket;           ///< driven wheel, which pulls the track
  /// Circles in the order in which the track meets them after the sprocket. A wheel that the track may touch twice is
  /// listed twice, for example a wheel that also carries the upper run. A circle that the track does not reach has no
  /// effect.
  std::vector<TrackCircle> circles = {};
  TrackTensioner tensioner;  ///< circle that moves, and limits of its travel

  /// Radius of the sprocket's pitch circle, which contains the corners of the pitch polygon [m].
  double pitch_radius() const { return 0.5 * pitch / std::sin(std::numbers::pi / sprocket.teeth); }
  /// Position of a pin seated in valley k [m]. Valleys are counted in the track's direction from the valley at the
  /// angle `valley`.
  Vec2 seat(int k) const {
    double const a = sprocket.valley + 2.0 * std::numbers::pi * k / sprocket.teeth;
    return sprocket.centre + pitch_radius() * Vec2(std::sin(a), std::cos(a));
  }
  /// Layout with the tensioner's circle moved by `travel` [m].
  TrackLayout tensioned(double travel) const {
    TrackLayout moved = *this;
    for (TrackCircle& c : moved.circles)
      if (c.name == tensioner.circle) c.centre += travel * tensioner.direction.normalized();
    return moved;
  }
};

namespace detail {

inline std::string track_name(TrackCircle const& c) { return sentence_of({"\"", c.name, "\""}); }

/// Checks a layout for overlapping circles and repeated names. \throws InvalidInput if two circles overlap, or if two
/// different wheels have the same name. The sprocket is represented by its pitch circle. Overlaps of the tensioner's
/// circle are checked only if `placed` is true.
inline void check_track_overlaps(TrackLayout const& layout, bool placed) {
  std::vector<TrackCircle> all = layout.circles;
  all.push_back({layout.sprocket.name, layout.sprocket.centre, layout.pitch_radius()});
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      TrackCircle const &a = all[j], &b = all[i];
      double const apart = (a.centre - b.centre).norm();
      if (a.name == b.name) {
        if (apart > 0.0 || a.radius != b.radius)
          throw InvalidInput("track.circle",
                             {"Track: duplicate circle name ", ErrorObject{track_name(a)},
                              ". Give each wheel a different name. The centre and radius of a wheel that "
                              "is listed twice must be the same both times."});
      } else if (double const deep = a.radius + b.radius - apart;
                 deep > 0.0 && (placed || (a.name != layout.tensioner.circle && b.name != layout.tensioner.circle))) {
        throw InvalidInput("track.overlap",
                           {"Track: ", ErrorObject{track_name(a)}, " and ", track_name(b), " overlap by ",
                            ErrorValue{deep}, " m. Move them apart or make them smaller."});
      }
    }
}

/// \throws InvalidInput if a number is outside of its allowed range.
inline void check_track(TrackLayout const& layout) {
  require_positive(layout.links, "Track: the number of links");
  require_positive(layout.pitch, "Track: the pitch");
  require_not_negative(layout.half_thickness, "Track: the links' half thickness");
  TrackSprocket const& s = layout.sprocket;
  require_finite(s.centre, "Track: the centre of \"" + s.name + "\"");
  if (s.teeth < 4 || !std::isfinite(s.valley))
    throw InvalidInput("sprocket.teeth", {"Track: \"", ErrorObject{s.name},
                                          "\" needs at least four teeth and a finite angle of a valley, but has ",
                                          s.teeth, " teeth and the angle ", s.valley, " rad."});
  bool found = false;
  for (TrackCircle const& c : layout.circles) {
    require_positive(c.radius, "Track: the radius of " + track_name(c));
    require_finite(c.centre, "Track: the centre of " + track_name(c));
    found = found || c.name == layout.tensioner.circle;
  }
  TrackTensioner const& t = layout.tensioner;
  if (!found)
    throw InvalidInput("track.tensioner", {"Track: the tensioner's circle \"", ErrorObject{t.circle},
                                           "\" is not a circle of the track. Use the name of a circle in `circles`."});
  if (!(t.direction.norm() > 0.0) || !t.direction.allFinite() || !(t.least <= t.most) ||
      !std::isfinite(t.most - t.least))
    throw InvalidInput("track.tensioner",
                       {"Track: the tensioner's circle \"", ErrorObject{t.circle},
                        "\" needs a direction and a finite range of travel, least ≤ most, but has the range ", t.least,
                        " m to ", t.most, " m and a direction of length ", t.direction.norm(), "."});
  check_track_overlaps(layout, false);
}

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
  std::vector<Vec2> pins;  ///< pins from seat `start` to the beginning of the straight run that ends at seat `first`
  double length = 0.0;     ///< length of the whole loop in links; a whole number only if the loop closes
};

/// Number of the seat whose direction from the sprocket's centre is away from the mean centre of the circles.
inline int track_start(TrackLayout const& layout) {
  Vec2 away = layout.sprocket.centre;
  for (TrackCircle const& c : layout.circles) away -= c.centre / double(layout.circles.size());
  double const angle = std::atan2(away[0], away[1]) - layout.sprocket.valley;
  return int(std::lround(angle * layout.sprocket.teeth / (2.0 * std::numbers::pi)));
}

/// First seat that the track meets, among `start` and the seats before `start`. All other seats are to the right of the
/// line from `pin` to this seat. The direction of the line is written to `sight`.
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

/// Target of the link behind the last pin of `walk`. The result is the index of a circle at or after `at`, −1 if the
/// target is the next seat of the sprocket, or the number of circles if it is the seat at the end of the chain. Sets
/// `heading` to the link's direction.
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
  double const unbounded = std::numeric_limits<double>::infinity();
  double const same = 1e-9;  // bounds with a smaller difference are equal and belong to the earlier circle
  int const count = int(layout.circles.size());
  Vec2 const pin = walk.pins.back();
  Bound right{{heading, -unbounded}, count}, left{{heading, unbounded}, count};
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
