#pragma once
/// \file
/// Checks of a track during a run: engagement of the pins with their sprocket, time step for the teeth, and distance of
/// a point from a path.
/// Theory: Eqs. 8.45 to 8.47.

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <numbers>
#include <span>
#include <string>

#include <polybody/vehicle/pin_sprocket_contact.hpp>

namespace polybody {

/// Pins of a track on their sprocket.
struct SprocketEngagement {
  int seated = 0;  ///< number of pins within the tip radius
  /// First seated pin that is not in the valley after that of the previous pin; −1 if there is none.
  int lost_at = -1;
  /// True if at least two pins are seated and `lost_at` is −1.
  bool holds() const { return seated >= 2 && lost_at < 0; }
};

/// Engagement of the `pins` pins of a closed track with a sprocket. A pin counts as seated if its distance from the
/// axle is less than the tip radius of the teeth. Each seated pin is assigned to a valley; consecutive pins must be in
/// consecutive valleys.
/// \param valley angle of any one valley in the sprocket's axes, from z towards x [rad]
/// \param position returns the position of pin k [m], in the sprocket's axes from the sprocket's centre. Pins are
/// numbered 0 … pins − 1 in the track's direction.
template <std::invocable<int> F>
SprocketEngagement sprocket_engagement(SprocketProfile const& profile, double valley, int pins, F const& position) {
  auto const within = [&](Vec3 const& p) { return std::hypot(p.x(), p.z()) < profile.tip_radius; };
  int first = 0;
  while (first < pins && within(position(first))) ++first;  // begin outside of the sprocket
  SprocketEngagement found;
  int const teeth = profile.teeth;
  long before = 0;
  bool follows = false;
  for (int k = first; k < first + pins; ++k) {
    Vec3 const p = position(k % pins);
    if (!within(p)) {
      follows = false;
      continue;
    }
    long const now = std::lround((std::atan2(p.x(), p.z()) - valley) * teeth / (2.0 * std::numbers::pi));
    if (follows && found.lost_at < 0 && ((now - before) % teeth + teeth) % teeth != 1) found.lost_at = k % pins;
    ++found.seated;
    before = now;
    follows = true;
  }
  return found;
}

/// Warning about a `step` longer than a sixth of the time in which a tooth passes, 2π/(N ω): such a step does not
/// resolve the teeth. Empty for a shorter step.
/// \param teeth N, number of teeth of the sprocket
/// \param speed ω, greatest angular velocity of the sprocket [rad/s]
/// \param step time step of the run [s]
inline std::string tooth_step_warning(int teeth, double speed, double step) {
  double const passing = 2.0 * std::numbers::pi / (teeth * std::abs(speed));
  if (step <= passing / 6.0) return {};
  return sentence_of({"At ", speed, " rad/s a tooth passes in ", 1e3 * passing, " ms, which steps of ", 1e3 * step,
                      " ms do not resolve. Take steps of ", 1e3 * passing / 6.0, " ms or less."});
}

/// Distance from p to the nearest point of the straight lines between consecutive corners [m]. Corners may coincide. A
/// closed path must repeat its first corner at the end.
/// \throws InvalidInput for a path without corners.
template <class = void>  // compiled only if it is used
double distance_to_path(Vec2 const& p, std::span<Vec2 const> corners) {
  if (corners.empty())
    throw InvalidInput("path.empty",
                       {ErrorObject{"distance_to_path"}, ": the path has no corner. Give at least one corner."});
  double nearest = (p - corners.front()).squaredNorm();
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    Vec2 const along = corners[i + 1] - corners[i], to = p - corners[i];
    double const share =
        std::clamp(to.dot(along) / std::max(along.squaredNorm(), std::numeric_limits<double>::min()), 0.0, 1.0);
    nearest = std::min(nearest, (to - share * along).squaredNorm());
  }
  return std::sqrt(nearest);
}

}  // namespace polybody
