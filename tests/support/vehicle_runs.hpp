#pragma once
// The vehicle of m113/vehicle.hpp in motion.
#include <polybody/polybody.hpp>

#include "m113/settled_track.hpp"
#include "m113/track_checks.hpp"

namespace polybody {

// Tracks at rest, computed once.
inline m113::TrackStart const& track_at_rest() {
  static m113::TrackStart const start = m113::settled_track();
  return start;
}

// Ramp from standstill at 0.1 s to `speed` at 0.6 s.
inline Ramp quick_drive(double speed) { return {.target = speed, .duration = 0.5, .start = 0.1, .rounding = 0.1}; }

inline GeneralisedAlpha vehicle_integrator() { return {.rho_inf = 0.8, .tolerance = 1e-5}; }

// Calls see(state, system evaluated in this state) after each step.
template <class M, class See>
RunReport run_vehicle(M const& model, State& x, double end_time, double step, See&& see) {
  auto run = simulate(model, x, vehicle_integrator(), {.end_time = end_time, .step = step, .max_step_halvings = 6});
  System system(model);
  while (!run.done()) {
    run.advance();
    system.evaluate(x.q, x.v, x.t);
    see(x, system);
  }
  return run.report();
}

template <class V>
Frame<double> hull_of(V const& vehicle, State const& x) {
  return frame(vehicle.model, x, vehicle.chassis[0].at(Vec3(0, 0, 0)));
}

}  // namespace polybody
