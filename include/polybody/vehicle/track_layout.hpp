#pragma once
/// \file
/// Layout of a track: its links, the circles that it goes around, and the tensioner. For vehicles; not included by
/// polybody.hpp.
///
/// The layout lies in a plane with x to the right (forward) and z up. The y axis points to the left of the vehicle,
/// away from the viewer. The track moves in the direction of a positive rotation about y: forward on top, rearward
/// along the ground. Points are (x, z) [m]. A rotation by b about y turns x into (cos b, −sin b) and z into (sin b,
/// cos b).

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <polybody/math/types.hpp>

namespace polybody {

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
  Required<double> least;  ///< lower limit of the travel from the listed position [m]
  Required<double> most;   ///< upper limit of the travel from the listed position [m]
};

/// Data that determine the path of a track.
struct TrackLayout {
  Required<int> links;              ///< number of links in the closed loop
  Required<double> pitch;           ///< p, distance between two pins [m]
  Required<double> half_thickness;  ///< h, from the line through a link's pins to either face [m]
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
/// wheels have one name. The sprocket is represented by its pitch circle. Overlaps of the tensioner's circle are
/// checked only if `placed` is true.
inline void check_track_overlaps(TrackLayout const& layout, bool placed) {
  std::vector<TrackCircle> all = layout.circles;
  all.push_back({layout.sprocket.name, layout.sprocket.centre, layout.pitch_radius()});
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      TrackCircle const &a = all[j], &b = all[i];
      double const apart = (a.centre - b.centre).norm();
      if (a.name == b.name) {
        if (apart > 0.0 || a.radius != b.radius)
          throw InvalidInput("track.circle", {"Track: duplicate circle name ", ErrorObject{track_name(a)},
                                              ". Give each wheel another name. The centre and radius of a wheel that "
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
                                          "\" needs at least four teeth and a finite angle of a valley."});
  bool found = false;
  for (TrackCircle const& c : layout.circles) {
    require_positive(c.radius, "Track: the radius of " + track_name(c));
    require_finite(c.centre, "Track: the centre of " + track_name(c));
    found = found || c.name == layout.tensioner.circle;
  }
  TrackTensioner const& t = layout.tensioner;
  if (!found)
    throw InvalidInput("track.tensioner",
                       {"Track: the tensioner's circle \"", ErrorObject{t.circle}, "\" is not a circle of the track."});
  if (!(t.direction.norm() > 0.0) || !t.direction.allFinite() || !(t.least <= t.most) ||
      !std::isfinite(t.most - t.least))
    throw InvalidInput("track.tensioner", {"Track: the tensioner's circle \"", ErrorObject{t.circle},
                                           "\" needs a direction and a finite range of travel, least ≤ most."});
  check_track_overlaps(layout, false);
}

}  // namespace detail
}  // namespace polybody
