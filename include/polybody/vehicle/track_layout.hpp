#pragma once
/// \file
/// The layout of a track: its links, the circles that it goes around, and the tensioner.
/// Not in polybody.hpp: of use to vehicles only.
///
/// Everything lies in a plane with x forward and z up; y points left, away from the reader who sees x to the right. The
/// track runs as a positive rotation about y does: forward on top, rearward along the ground. Places are (x, z) [m]; an
/// angle b about y turns x into (cos b, −sin b) and z into (sin b, cos b).

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <polybody/math/types.hpp>

namespace polybody {

/// Whether the track goes around a circle, which its inner faces touch, or passes by it with its outer faces.
enum class TrackSide { inside, outside };

/// A wheel, idler or roller: a circle in the plane of the track.
struct TrackCircle {
  std::string name;                    ///< by which the tensioner and messages name it
  Vec2 centre;                         ///< (2) [m]
  Required<double> radius;             ///< R, of the rim [m]
  TrackSide side = TrackSide::inside;  ///< which faces of the track touch it
};

/// The driven wheel; a pin sits in each valley that the track covers.
struct TrackSprocket {
  std::string name = "sprocket";  ///< by which messages name it
  Vec2 centre;                    ///< (2) [m]
  Required<int> teeth;            ///< N
  Required<double> valley;        ///< angle of any one valley, from z towards x [rad]
};

/// How the track is tightened.
struct TrackTensioner {
  std::string circle;      ///< the name of the circle that moves
  Vec2 direction;          ///< (2) where to, a unit vector or longer
  Required<double> least;  ///< its travel from the place in the list [m]
  Required<double> most;   ///< [m]
};

/// All that decides how a track lies.
struct TrackLayout {
  Required<int> links;              ///< how many links close the loop
  Required<double> pitch;           ///< p [m]
  Required<double> half_thickness;  ///< h, from the line through a link's pins to either face [m]
  TrackSprocket sprocket;           ///< the driven wheel, which pulls the track
  /// In the order in which the track meets them after the sprocket. A wheel that the track may touch twice, such as one
  /// that carries the upper run too, is listed twice; one that it does not reach does no harm.
  std::vector<TrackCircle> circles = {};
  TrackTensioner tensioner;  ///< which circle moves, and how far

  /// The radius of the pitch polygon's corners [m].
  double pitch_radius() const { return 0.5 * pitch / std::sin(std::numbers::pi / sprocket.teeth); }
  /// The place of valley number k, counted in the track's direction from the named one.
  Vec2 seat(int k) const {
    double const a = sprocket.valley + 2.0 * std::numbers::pi * k / sprocket.teeth;
    return sprocket.centre + pitch_radius() * Vec2(std::sin(a), std::cos(a));
  }
  /// The same with the tensioner's circle moved by `travel` [m].
  TrackLayout tensioned(double travel) const {
    TrackLayout moved = *this;
    for (TrackCircle& c : moved.circles)
      if (c.name == tensioner.circle) c.centre += travel * tensioner.direction.normalized();
    return moved;
  }
};

namespace detail {

inline std::string track_name(TrackCircle const& c) { return sentence_of({"'", c.name, "'"}); }

/// \throws InvalidInput where two circles overlap, or two wheels have one name. The sprocket counts with its pitch
/// circle; the tensioner's circle only if `placed`.
inline void check_track_overlaps(TrackLayout const& layout, bool placed) {
  std::vector<TrackCircle> all = layout.circles;
  all.push_back({layout.sprocket.name, layout.sprocket.centre, layout.pitch_radius()});
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      TrackCircle const &a = all[j], &b = all[i];
      double const apart = (a.centre - b.centre).norm();
      if (a.name == b.name) {
        if (apart > 0.0 || a.radius != b.radius)
          throw InvalidInput{"Track: two circles are called ", track_name(a),
                             ". Give each wheel a name of its own; one that ",
                             "is listed twice has the same centre and radius both times."};
      } else if (double const deep = a.radius + b.radius - apart;
                 deep > 0.0 && (placed || (a.name != layout.tensioner.circle && b.name != layout.tensioner.circle))) {
        throw InvalidInput{"Track: ",
                           track_name(a),
                           " and ",
                           track_name(b),
                           " overlap by ",
                           deep,
                           " m. Move them apart or make them smaller."};
      }
    }
}

/// \throws InvalidInput for numbers that cannot be meant.
inline void check_track(TrackLayout const& layout) {
  require_positive(layout.links, "Track: the number of links");
  require_positive(layout.pitch, "Track: the pitch");
  require_not_negative(layout.half_thickness, "Track: the links' half thickness");
  TrackSprocket const& s = layout.sprocket;
  require_finite(s.centre, "Track: the centre of '" + s.name + "'");
  if (s.teeth < 4 || !std::isfinite(s.valley))
    throw InvalidInput{"Track: '", s.name, "' needs at least four teeth and a finite angle of a valley."};
  bool found = false;
  for (TrackCircle const& c : layout.circles) {
    require_positive(c.radius, "Track: the radius of " + track_name(c));
    require_finite(c.centre, "Track: the centre of " + track_name(c));
    found = found || c.name == layout.tensioner.circle;
  }
  TrackTensioner const& t = layout.tensioner;
  if (!found) throw InvalidInput{"Track: the tensioner's circle '", t.circle, "' is none of the circles of the track."};
  if (!(t.direction.norm() > 0.0) || !t.direction.allFinite() || !(t.least <= t.most) ||
      !std::isfinite(t.most - t.least))
    throw InvalidInput{"Track: the tensioner's circle '", t.circle,
                       "' needs a direction and a finite range of travel, least ≤ most."};
  check_track_overlaps(layout, false);
}

}  // namespace detail
}  // namespace polybody
