#pragma once
// Energy of the arm after its drive has stopped (thesis 2.5.4). Pin and drive then do no work, so any change of the
// energy is an error of the time integrator. Shared by the example and its test.
#include "chapter2.hpp"

namespace chapter2 {

// Change of the total energy E in a time window after the ramp, relative to its value E0 at the first step after the
// ramp.
struct EnergyDrift {
  double start = 0.0;       // energy E0 at the start of the window [J]
  double largest = 0.0;     // largest |E/E0 - 1| in the window
  double end = 0.0;         // E/E0 - 1 at the end of the window
  std::vector<double> t;    // times of the window [s]
  std::vector<double> off;  // E/E0 - 1 at these times
};

// Data of a run: the drive rotates the arm by `angle` within the time `ramp` and stands still for the time `window`.
struct DriftRun {
  Stiffness stiffness = medium;
  double density = 7850.0;  // [kg/m^3]
  double ramp = 4.5;        // [s]
  double window = 20.0;     // [s]
  double step = 5e-3;       // [s]
};

template <class B, class I>
EnergyDrift energy_drift(DriftRun const& run, Index elements, I const& integrator) {
  RobotArm<B> arm(bar(run.stiffness, run.density), elements, run.ramp);
  State x = arm.model.reference_state();
  EnergyDrift out;
  for (auto const& now : simulate(arm.model, x, integrator, {.end_time = run.ramp + run.window, .step = run.step})) {
    if (now.t < run.ramp + 0.5 * run.step) continue;
    double const total = now.energy().total();
    if (out.t.empty()) out.start = total;
    out.end = total / out.start - 1.0;
    out.largest = std::max(out.largest, std::abs(out.end));
    out.t.push_back(now.t);
    out.off.push_back(out.end);
  }
  return out;
}

}  // namespace chapter2
