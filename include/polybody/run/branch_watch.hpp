#pragma once
/// \file
/// Warns of singular configurations at which the motion may have changed to another branch.

#include <string>
#include <vector>

#include <polybody/integrators/forward_dynamics.hpp>
#include <polybody/integrators/integrator.hpp>

namespace polybody {

/// Compares a measure of near redundancy at the ends of steps with its value at the start of the run.
class BranchWatch {
 public:
  /// Stores a measure of near redundancy of the constraint equations at x, which is taken as a regular configuration.
  template <class Solver>
  [[gnu::cold]] void begin(System& system, ForwardDynamics<Solver>& forward, State const& x) {
    if (system.rows() > 0) usual_ = forward.constraint_gain(system, x.q, x.v, x.t);
  }

  /// Adds a warning if the step ends at a state x near a singular configuration. Only the first warning of a run is
  /// added. Steps are examined only if they changed the velocities by more than a tenth of their norm and factorised a
  /// matrix.
  /// \param v velocities before the step
  /// \param warnings warnings of the run
  template <class Solver>
  void look(System& system, ForwardDynamics<Solver>& forward, StepReport const& taken, VecX const& v, State const& x,
            std::vector<std::string>& warnings) {
    if (taken.factorisations == 0 || system.rows() == 0) return;
    SimdSum change;
    for_each_simd_block(x.v.size(), [&](auto at) {
      auto const by = at(x.v) - at(v);
      change.add(by * by);
    });
    if (change.total() > 0.01 * squares(v)) ask(system, forward, x, warnings);
  }

 private:
  template <class Solver>
  [[gnu::cold]] void ask(System& system, ForwardDynamics<Solver>& forward, State const& x,
                         std::vector<std::string>& warnings) {
    char const* const what = "The constraint equations lose rank near t = ";
    for (std::string const& warning : warnings)
      if (warning.starts_with(what)) return;
    if (!forward.is_singular(system, {x.q, x.v, x.t}, usual_)) return;
    warnings.push_back(
        what + number(x.t) +
        " s, and the velocities jump in the step that ends at this time. At this singular configuration the motion can "
        "change to another branch, and the step and the integrator select the branch. Compare the run with a run of "
        "another step length.");
  }

  ConstraintGain usual_;
};

}  // namespace polybody
