#pragma once
// The energy of the arm once its drive stands still (thesis 2.5.4): the pin and the drive do no work then, so that
// what changes is the error of the time integrator. Shared by the example and its test.
#include "chapter2.hpp"

namespace chapter2 {

// Total energy over a window after the ramp, of its amount at the first step after the ramp.
struct EnergyDrift {
  double start = 0.0;       // energy at the start of the window [J]
  double largest = 0.0;     // largest |E/E0 - 1| in the window
  double end = 0.0;         // E/E0 - 1 at its end
  std::vector<double> t;    // times of the window [s]
  std::vector<double> off;  // E/E0 - 1
};

// The arm is driven by `angle` in `ramp` seconds and left alone for `window` seconds [s].
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
