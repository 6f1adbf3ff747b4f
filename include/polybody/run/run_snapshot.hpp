#pragma once
/// \file
/// A run that can be stored and resumed.

#include <polybody/math/checksum.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/run/run_options.hpp>
#include <polybody/run/step_plan.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

/// What identifies the model of a snapshot: the numbers of its unknowns in a step, and the names of bodies, joints and
/// forces in their order. Masses, lengths and loads are not compared.
struct ModelIdentity {
  Index coordinates = 0, velocities = 0, rows = 0;  ///< of a step, after elimination
  Index eliminated_equations =
      0;                    ///< eliminated, of whose multipliers a step may keep estimates behind those of the rows
  std::uint64_t names = 0;  ///< checksum

  bool operator==(ModelIdentity const&) const = default;  ///< whether counts and names are equal
};

/// \param stepped the system that a run steps: of the model, or of the unknowns that its policies leave
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

/// All that a run needs to go on, except its model, integrator and options, which must be the same.
struct RunSnapshot {
  ModelIdentity model;     ///< whose run it is
  std::string integrator;  ///< its name
  State state;             ///< as it is stepped, with the integrator's memory: without what policies eliminate
  double step = 0.0;       ///< the next one, of an integrator that controls its step [s]
  StepRow row;             ///< of the last step
  Sequence<int> sides;     ///< of zero on which the events stand
  RunReport report;        ///< of the run so far

  /// \throws InvalidInput if a number of the state is NaN or infinite.
  template <class = void>
  void require_finite_state() const {
    polybody::require_finite(state.q, "resume: the coordinates of the snapshot");
    polybody::require_finite(state.v, "resume: the speeds of the snapshot");
    polybody::require_finite(state.a, "resume: the accelerations of the snapshot");
    polybody::require_finite(state.lambda, "resume: the multipliers of the snapshot");
    polybody::require_finite(state.history, "resume: the integrator's memory in the snapshot");
  }
  /// \throws InvalidInput unless model, integrator (`by` its name) and count of events are these.
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
