#pragma once
/// \file
/// Checks of the tracks during a run: seating of pins in the valleys of their sprocket, penetrations, and
/// distance of the chain from its path. For vehicles; not included by polybody.hpp.

#include <cmath>
#include <string>

#include <polybody/run/run_options.hpp>
#include <polybody/vehicle/distance_to_path.hpp>
#include <polybody/vehicle/tracked_vehicle.hpp>
#include <polybody/vehicle/vehicle_options.hpp>

namespace polybody::m113 {

/// Pins of one side on their sprocket.
struct SprocketEngagement {
  int seated = 0;  ///< number of pins between the teeth
  /// First link whose front pin is not in the valley next to the previous pin's valley; −1 if there is none.
  int lost_at = -1;
  /// True if two or more pins are between the teeth and no pin has jumped.
  bool holds() const { return seated >= 2 && lost_at < 0; }
};

/// Deviations of a track in a state.
struct TrackDerailment {
  double depth = 0.0;   ///< penetration of the deepest contact [m]
  Index link = 0;       ///< link with the deepest contact
  std::string against;  ///< name of the part that this link touches
  /// Greatest lateral distance of a link's middle from the track's middle plane, in the chassis' axes [m]
  double sideways = 0.0;
  double off_path = 0.0;  ///< greatest distance of a pin from the initial chain, in the chassis' axes [m]
};

/// Seating of the pins of one side. A pin counts if its distance from the axle is less than the radius of the tips of
/// the teeth. Each such pin is assigned to a valley, and consecutive links must be in consecutive valleys.
template <class = void>  // compiled only if it is used
SprocketEngagement teeth_engaged(TrackedVehicle const& vehicle, State const& x, Side side) {
  Track const& track = vehicle.track(side);
  Frame<double> const sprocket = track.sprocket(x);
  SprocketEngagement found;
  long before = 0;
  bool follows = false;
  auto const pin_of = [&](int i) -> Vec3 {
    return sprocket.A.transpose() * (track.front[std::size_t(i % links)](x).r - sprocket.r);
  };
  auto const within = [](Vec3 const& p) { return std::hypot(p.x(), p.z()) < tip_radius; };
  int first = 0;
  while (first < links && within(pin_of(first))) ++first;  // begin outside of the sprocket
  for (int k = first; k < first + links; ++k) {
    Vec3 const p = pin_of(k);
    if (!within(p)) {
      follows = false;
      continue;
    }
    long const valley = std::lround((std::atan2(p.x(), p.z()) - first_valley) * teeth / (2.0 * std::numbers::pi));
    if (follows && found.lost_at < 0 && ((valley - before) % teeth + teeth) % teeth != 1) found.lost_at = k % links;
    ++found.seated;
    before = valley;
    follows = true;
  }
  return found;
}

/// Event for `RunOptions::events`: zero if a track jumps a tooth or leaves its sprocket. The vehicle must outlive the
/// run.
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

/// Warning about a `step` longer than a sixth of the time in which a tooth passes, 2π/(N ω): such a step does not
/// resolve the teeth. Empty for a shorter step. \param speed ω, greatest angular velocity of the sprocket [rad/s]
inline std::string drive_warning(double speed, double step) {
  double const passing = 2.0 * std::numbers::pi / (teeth * std::abs(speed));
  if (step <= passing / 6.0) return {};
  return sentence_of({"At ", speed, " rad/s a tooth passes in ", 1e3 * passing, " ms, which steps of ", 1e3 * step,
                      " ms do not resolve. Take steps of ", 1e3 * passing / 6.0, " ms or less."});
}

}  // namespace polybody::m113
