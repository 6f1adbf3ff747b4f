#pragma once
// Cost of the pins at equal error of the force in a pin: work-precision curves of each formulation of the pins by each
// integrator. The error of a run is its difference from a converged run with the same pins. The difference between
// formulations is a result of its own: the difference of their converged runs.
#include "pins.hpp"

namespace chapter3 {

// Converged force of one formulation of the pins, by generalised-α with a quarter of the shortest step of the study.
struct ConvergedPins {
  std::string name;
  LinksOnPins links;
  double stiffness = 0.0;  // [N/m]
  Runs run = {};
  double bound = 0.0;  // difference from the run with half of the shortest step, an error bound [1]
  // Difference from a run whose preload differs in the last place [1]. Contacts amplify round-off.
  double spread = 0.0;
  double difference = 0.0;   // difference from the reference of the study, without error bounds [1]
  std::string failure = {};  // message of a run that failed; empty if there is a converged force

  // Errors below this value are not resolved [1].
  double resolution() const { return std::max(bound, spread); }
};

// A run of the study.
struct CostRun {
  double accuracy = 0.0;  // step [s], or tolerance of an integrator with step size control [1]
  RunCounts counts = {};
  std::vector<double> cpu = {};  // CPU times of the steps, ascending [s]
  double error = 0.0;            // difference from the converged run [1]
  std::string failure = {};      // message; empty if the run is complete

  double median() const { return 0.5 * (cpu[(cpu.size() - 1) / 2] + cpu[cpu.size() / 2]); }
};

// Work-precision curve of one formulation of the pins by one integrator.
struct CostCurve {
  std::size_t pins = 0;  // number of the converged pins
  Combination combination;
  std::string integrator;
  bool controlled = false;  // true: the integrator controls its step
  std::vector<CostRun> runs = {};

  std::string setting(CostRun const& run) const;  // "1 ms" or "tolerance 1e-5"
};

struct CostStudy {
  std::vector<double> errors;  // wanted errors [1]
  std::vector<ConvergedPins> pins = {};
  std::vector<CostCurve> curves = {};
  std::vector<std::string> refusals = {};  // combinations that do not exist, with their reasons

  // First pins with a converged force, from which the others differ; the first pins if there is no converged force.
  ConvergedPins const& reference() const {
    auto const found =
        std::find_if(pins.begin(), pins.end(), [](ConvergedPins const& one) { return one.failure.empty(); });
    return found == pins.end() ? pins.front() : *found;
  }
};

// Runs the study of the selected integrators, or of generalised-α, Radau and Adams, and of the selected policies, or of
// all, on rigid links. Throws InvalidInput if an integrator has fewer than three steps or tolerances.
CostStudy cost_study(Options o);
// Prints the rankings at equal error, the differences between the formulations and all runs; writes cost.csv and the
// figure "cost".
void report(Options const& o, CostStudy const& study);

}  // namespace chapter3
