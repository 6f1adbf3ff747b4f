#pragma once
/// \file
/// Snapshot of a run in memory, from which the run can be resumed.

#include <polybody/math/checksum.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/run/run_options.hpp>
#include <polybody/run/step_plan.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

/// Identity of the model of a snapshot: numbers of its unknowns in a step, and names of bodies, joints and forces in
/// order. Masses, lengths and loads are not compared.
struct ModelIdentity {
  Index coordinates = 0, velocities = 0, rows = 0;  ///< sizes of a step, after elimination
  Index eliminated_equations = 0;                   ///< eliminated equations with estimated multipliers in the state
  std::uint64_t names = 0;                          ///< checksum of the names

  bool operator==(ModelIdentity const&) const = default;  ///< true if counts and names are equal
};

/// Identity of a model. \param stepped integrated system: of the model or of its reduced coordinates
template <class = void>
ModelIdentity identity_of(System const& stepped) {
  std::string names;
  for (BodyLayout const& b : stepped.layout().bodies) (names += b.name) += '\n';
  names += '\n';
  for (JointLayout const& j : stepped.layout().joints) (names += j.name) += '\n';
  names += '\n';
  for (ForceLayout const& f : stepped.layout().forces) (names += f.name) += '\n';
  Index const rows = stepped.rows();
  return {stepped.coordinates(), stepped.velocities(), rows, multipliers_of(stepped) - rows, checksum(names)};
}

/// Data from which a run continues with the same model, integrator and options.
struct RunSnapshot {
  ModelIdentity model;     ///< identity of the model
  std::string integrator;  ///< name of the integrator
  State state;             ///< integrated state, reduced if policies eliminate unknowns, with its history
  double step = 0.0;       ///< next step of an integrator that controls its step [s]
  StepRow row;             ///< steps of equal length, up to the last step
  Sequence<int> sides;     ///< signs of the event values, as from `EventDetector::sides`
  RunReport report;        ///< report of the run so far

  /// \throws InvalidInput if a number of the state is NaN or infinite.
  template <class = void>
  void require_finite_state() const {
    polybody::require_finite(state.q, "resume: the coordinates of the snapshot");
    polybody::require_finite(state.v, "resume: the velocities of the snapshot");
    polybody::require_finite(state.a, "resume: the accelerations of the snapshot");
    polybody::require_finite(state.lambda, "resume: the multipliers of the snapshot");
    polybody::require_finite(state.history, "resume: the integrator history of the snapshot");
  }
  /// \throws InvalidInput unless the snapshot has this model, integrator (with the name `by`) and number of events.
  template <class = void>
  void require(ModelIdentity const& of, std::string const& by, std::size_t events) const {
    auto const counts = [](ModelIdentity const& m) {
      return sentence_of({m.coordinates, " coordinates, ", m.velocities, " generalised velocities and ", m.rows,
                          " constraint equations"});
    };
    if (model.coordinates != of.coordinates || model.velocities != of.velocities || model.rows != of.rows)
      throw InvalidInput("resume.model", {ErrorObject{"resume"}, ": the snapshot belongs to another model. It has ",
                                          counts(model), "; this model has ", counts(of), "."});
    if (model != of)
      throw InvalidInput("resume.model",
                         {ErrorObject{"resume"},
                          ": the snapshot belongs to another model, with other names of bodies, joints or forces."});
    if (integrator != by)
      throw InvalidInput("resume.integrator", {ErrorObject{"resume"}, ": the snapshot belongs to a run by ", integrator,
                                               ", not by ", by, "."});
    if (sides.size() != events)
      throw InvalidInput("resume.events", {ErrorObject{"resume"}, ": the snapshot belongs to a run with ",
                                           ErrorValue{sides.size()}, " events, but the options have ", events, "."});
  }
};

}  // namespace polybody
