#pragma once
/// \file
/// Checks of the tracks during a run: seating of pins in the valleys of their sprocket, penetrations, and distance of
/// the chain from its path.

#include <cmath>
#include <string>

#include <polybody/run/run_options.hpp>
#include <polybody/vehicle/track_checks.hpp>

#include "options.hpp"
#include "track_frames.hpp"
#include "tracks.hpp"

namespace polybody::m113 {

/// Deviations of a track in a state.
struct TrackDerailment {
  double depth = 0.0;   ///< penetration of the deepest contact [m]
  Index link = 0;       ///< link with the deepest contact
  std::string against;  ///< name of the part that this link touches
  /// Greatest lateral distance of a link's middle from the track's middle plane, in the chassis' axes [m]
  double sideways = 0.0;
  double off_path = 0.0;  ///< greatest distance of a pin from the initial chain, in the chassis' axes [m]
};

/// Engagement of the pins of one side with their sprocket (`sprocket_engagement`). Pin i is the front pin of link i.
template <class = void>  // compiled only if it is used
SprocketEngagement teeth_engaged(TrackedVehicle const& vehicle, State const& x, Side side) {
  Track const& track = vehicle.track(side);
  Frame<double> const sprocket = track.sprocket(x);
  return sprocket_engagement(sprocket_profile(), first_valley, links, [&](int i) -> Vec3 {
    return sprocket.A.transpose() * (track.front[std::size_t(i)](x).r - sprocket.r);
  });
}

/// Terminal event for `RunOptions::events`: the track of one side jumps a tooth or leaves its sprocket. The vehicle
/// must outlive the run.
template <class = void>
Event derailed(TrackedVehicle const& vehicle, Side side) {
  return {.name = std::string(side == Side::left ? "the left" : "the right") + " track leaves its sprocket",
          .value = [&vehicle, side](State const& x) { return teeth_engaged(vehicle, x, side).holds() ? 1.0 : -1.0; },
          .terminal = true,
          .tolerance = 1e-4};
}

/// Message with the time, side and link of a track that is not seated on its sprocket; empty if both tracks are seated.
template <class = void>
std::string track_warning(TrackedVehicle const& vehicle, State const& x) {
  std::string text;
  for (Side const side : {Side::left, Side::right}) {
    SprocketEngagement const s = teeth_engaged(vehicle, x, side);
    if (s.holds()) continue;
    if (!text.empty()) text += ' ';
    text += sentence_of({"At t = ", x.t, " s the ", (side == Side::left ? "left" : "right"), " track "});
    text += s.lost_at >= 0 ? "has jumped a tooth of its sprocket at link " + std::to_string(s.lost_at) + "."
                           : "has left its sprocket: " + std::to_string(s.seated) + " of its pins are between teeth.";
    text += " Tighten the tensioner or accelerate less.";
  }
  return text;
}

/// Deviations of the track of one side. `system` must have been evaluated at x. \param start initial positions of the
/// links
template <class = void>
TrackDerailment track_derailment(TrackedVehicle const& vehicle, System const& system, State const& x, Side side,
                                 TrackStart const& start) {
  Track const& track = vehicle.track(side);
  TrackDerailment worst;
  track.contacts(system, [&](TouchingPoint const& p) {
    if (p.depth <= worst.depth) return;
    worst.depth = p.depth;
    worst.link = p.body;
    worst.against = *p.against;
  });
  Frame<double> const hull = vehicle.hull(x);
  std::vector<Vec2> path;
  for (TrackLink const& link : start.links)
    path.push_back(link.centre + 0.5 * pitch * Vec2(std::cos(link.angle), -std::sin(link.angle)));
  path.push_back(path.front());
  for (std::size_t k = 0; k < track.front.size(); ++k) {
    Vec3 const middle = hull.A.transpose() * (track.middle[k](x).r - hull.r);
    Vec3 const pin = hull.A.transpose() * (track.front[k](x).r - hull.r);
    worst.sideways = std::max(worst.sideways, std::abs(middle.y() - sign(side) * track_y));
    Vec2 const p(pin.x() + m113::chassis.x, pin.z() + m113::chassis.z);
    worst.off_path = std::max(worst.off_path, distance_to_path(p, path));
  }
  return worst;
}

/// Warning about a `step` [s] that does not resolve the teeth at the angular velocity `speed` [rad/s] of the sprocket
/// (`tooth_step_warning`); empty for a shorter step.
inline std::string drive_warning(double speed, double step) { return tooth_step_warning(teeth, speed, step); }

}  // namespace polybody::m113
