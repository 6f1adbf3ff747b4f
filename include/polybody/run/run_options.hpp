#pragma once
/// \file
/// Options, events and report of a run.

#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include <polybody/integrators/integrator.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/system/state.hpp>

namespace polybody {

/// Event of a run: `value` passes through zero, in either direction, and the step ends there. Two zeros within one step
/// are found if the value has a single extremum in the step, such as the top of a flight. A value that oscillates
/// within a step requires a smaller step.
struct Event {
  std::string name;                           ///< name in reports
  std::function<double(State const&)> value;  ///< event function, whose sign changes at the event
  bool terminal = false;                      ///< true if the event ends the run
  double tolerance = 1e-10;                   ///< tolerance of the time [s]
  /// Changes coordinates and velocities at the event, for example by an impact. The run restarts from the changed
  /// state. The action must satisfy the position constraints; velocities are projected onto the constraint equations
  /// afterwards, in the mass norm. If the action reverses the rate of the value, the next crossing from the same side
  /// is detected, even within the next step. If the value continues beyond zero, the next crossing from the other side
  /// is detected. At the start of a run, an event with an action and a value of zero occurs immediately, unless the
  /// value increases.
  std::function<void(State&)> action = {};
  /// Treatment of impacts that accumulate: ten repetitions, each within `tolerance` of the preceding impact, or 1000
  /// impacts within one step length. One repetition is enough if the rate of the value is zero after an impact. A ball
  /// with a restitution below one comes to rest in this way. If `rests` is false, the run then throws InvalidInput. If
  /// `rests` is true, the value is held at zero from this time on: coordinates and velocities are projected onto value
  /// = 0 after each step, in the mass norm. The value is released when a step ends with the sign that the value had
  /// before the event. Accelerations and multipliers do not include the force that holds the value.
  bool rests = false;
};

/// Progress of a run.
struct RunProgress {
  double start;     ///< initial time [s]
  double end_time;  ///< end time [s]
  double now;       ///< present time [s]
  bool done;        ///< true at `end_time` or after a terminal event
};

/// Options of a run.
struct RunOptions {
  Required<double> end_time;             ///< end time [s]
  Required<double> step;                 ///< step [s]; initial step for an integrator that controls its step
  std::optional<double> max_step = {};   ///< largest step [s]; also limits `step`
  std::vector<double> breakpoints = {};  ///< breakpoints [s], besides those of driving constraints and loads
  std::vector<Event> events = {};        ///< events that are detected in each step
  /// Limit of |Φ| at the start [m], [rad]. If the extent of an assembly of bodies is below one metre, the limit of
  /// lengths is this value times this extent in metres.
  double assembly_tolerance = 1e-8;
  /// Largest number of halvings of a step that fails with `NewtonConvergenceFailure`, or of an implicit step with an
  /// unexplained energy gain, in [0, 30]. If empty, it is 6 in `simulate`, and 0 in differentiated runs and in fixed
  /// steps of `work_precision`. If 0, a failed step ends the run. A halving whose first half succeeds does not count; a
  /// step is halved at most 30 times. The report counts halved steps.
  std::optional<int> max_step_halvings = {};
  bool minimum_norm = false;       ///< true: minimum-norm multipliers in every state; costs one factorisation per step
  PlausibilityLimits limits = {};  ///< limits at the end of a step: constraint violation, and unexplained energy
  int threads = 1;  ///< number of threads in an evaluation, for large models; results are bitwise identical
  std::function<void(RunProgress const&)> progress = {};  ///< called after each step, such as `progress_bar`

  /// `max_step_halvings`, or 6 if it is empty.
  int allowed_halvings() const { return max_step_halvings.value_or(6); }

  /// \throws InvalidInput for invalid options of a run from `start` [s].
  [[gnu::cold]] void check(double start) const {
    require_positive(step, "simulate: the step");
    if (max_step) require_positive(*max_step, "simulate: the largest step");
    require_positive(assembly_tolerance, "simulate: assembly_tolerance");
    if (!(end_time >= start) || !std::isfinite(end_time))
      throw InvalidInput("run.end_time",
                         {ErrorObject{"simulate"}, ": the end time must be finite and not before the start ", start,
                          " s, but is ", ErrorValue{end_time}, " s."});
    double const latest = std::max(std::abs(start), std::abs(end_time)),
                 resolved = std::nextafter(latest, std::numeric_limits<double>::infinity()) - latest;
    if (step < 32.0 * resolved)
      throw InvalidInput("run.clock", {ErrorObject{"simulate"}, ": double precision resolves ", resolved,
                                       " s at t = ", ErrorTime{end_time}, " s, which is too coarse for steps of ",
                                       ErrorValue{step}, " s. Start the run at a time near zero."});
    if (allowed_halvings() < 0 || allowed_halvings() > 30)
      throw InvalidInput("run.option", {ErrorObject{"simulate"}, ": max_step_halvings must lie in [0, 30], but is ",
                                        ErrorValue{allowed_halvings()}, "."});
    if (!(limits.violation > 0.0) || !(limits.energy >= 1.0))
      throw InvalidInput(
          "run.option",
          {ErrorObject{"simulate"}, ": limits.violation must be positive and limits.energy at least one, but they are ",
           limits.violation, " and ", limits.energy, "."});
    require_positive(limits.warning, "simulate: limits.warning");
    for (double const t : breakpoints)
      if (std::isnan(t))
        throw InvalidInput("run.option", {ErrorObject{"simulate"}, ": a breakpoint must be a time in s, but is nan."});
    for (Event const& event : events) {
      if (!event.value)
        throw InvalidInput("event.no_value", {"simulate: the event \"", ErrorObject{event.name},
                                              "\" has no value function. Set `value`."});
      require_positive(event.tolerance, "simulate: the tolerance of the event \"" + event.name + "\"");
    }
  }
};

/// Cost of a run so far. Failed attempts are included if a shorter step succeeds. A step that ends the run by an
/// exception is not included.
struct RunCounts {
  long steps = 0;           ///< number of steps
  long iterations = 0;      ///< iterations of Newton's method
  long factorisations = 0;  ///< factorisations of tangents and mass matrices
  long evaluations = 0;     ///< evaluations of the forces
  long rejected = 0;        ///< rejected trial steps, and steps that were halved
  long halved = 0;          ///< steps that failed and were repeated by halves
  long over_budget = 0;     ///< steps that ended at the iteration budget of Newton's method
  double left = 0.0;        ///< largest final correction of `over_budget` steps, relative to the tolerance
  StepReport last = {};     ///< report of the last step

  /// Adds the cost of a step.
  void add(StepReport const& step) {
    ++steps;
    iterations += step.iterations;
    factorisations += step.factorisations;
    evaluations += step.evaluations;
    rejected += step.rejected;
    halved += step.halved;
    if (step.left > 0.0) ++over_budget;
    left = std::max(left, step.left);
    last = step;
  }
};

/// Cost, events and warnings of a run so far.
struct RunReport : RunCounts {
  /// Event of a run and its time.
  struct EventRecord {
    std::string name;  ///< name of the event
    double time;       ///< time of the event [s]
  };
  Sequence<EventRecord> events = {};  ///< events in the order of time
  bool stopped = false;               ///< true if an event ended the run before `end_time`
  /// Joints with redundant constraint equations at the last start. The motion is determined, but the distribution of
  /// the load over the reactions is not.
  std::vector<std::string> redundant = {};
  /// Warnings as text. At the start: section matrices that are probably not in SI units, a singular configuration whose
  /// velocities do not determine a branch of the motion, and a step beyond the stability limit of an explicit
  /// integrator for the compliant joints. In a step: a singular configuration at which the velocities jumped, and axial
  /// forces of at least 5 % of the buckling load that a beam neglects. At the end: energy that no work explains.
  std::vector<std::string> warnings = {};

  /// Adds the warning `sentence` if it is not empty.
  void add_warning(std::string sentence) {
    if (!sentence.empty()) warnings.push_back(std::move(sentence));
  }
  /// True if a warning begins with these words.
  bool warns(char const* words) const {
    return std::any_of(warnings.begin(), warnings.end(), [&](std::string const& w) { return w.starts_with(words); });
  }
  /// Text for the message of an exception that ends the run: number of halved steps, and the warnings. Empty if there
  /// are neither halved steps nor warnings.
  [[gnu::cold]] std::string warned() const {
    std::string all;
    if (halved > 0) all = sentence_of({halved, halved == 1 ? " step" : " steps", " of the run had to be halved."});
    for (std::string const& warning : warnings)
      all += (all.empty() ? "Warning of the run: " : " Warning of the run: ") + warning;
    return all;
  }
  /// Times of a run [s] and number of its halved steps.
  struct Course {
    double start, now;  ///< initial and present time [s]
    long halved;        ///< number of halved steps
  };
  /// Adds a warning if the unexplained energy exceeds the fraction `limit` of the exchanged energy, if the steps do not
  /// resolve the work of a force, or if steps were halved for their energy gain.
  [[gnu::cold]] void warn_of_energy(Unexplained const& found, double limit, Course const& run) {
    if (!found.known) return;
    char const* const were_halved = run.halved == 1 ? " step was halved" : " steps were halved";
    if (found.worst > 0.4 * found.scale)
      add_warning(sentence_of({"The work of a force over one step is uncertain by ", found.worst,
                               " J, more than 40 % of the exchanged energy (", found.scale,
                               " J). The steps do not resolve this force. Repeat the run with half the step."}));
    else if (std::abs(found.energy) > limit * found.scale + found.doubt)
      add_warning(
          sentence_of({"From t = ", run.start, " s to ", run.now, " s the motion ",
                       found.energy > 0.0 ? "gains " : "loses ", std::abs(found.energy), " J that no work explains, ",
                       std::abs(found.energy) / found.scale, " of the exchanged energy (", found.scale, " J); ",
                       run.halved, were_halved, ". Repeat the run with half the step and compare."}));
    else if (found.peak > 2.0 * limit * found.scale)
      add_warning(sentence_of({"From t = ", run.start, " s to ", run.now, " s the motion gains up to ", found.peak,
                               " J that no work explains, ", found.peak / found.scale, " of the exchanged energy (",
                               found.scale, " J), and loses energy later; ", run.halved, were_halved,
                               ". Repeat the run with half the step and compare."}));
    else if (found.halved > 0)
      add_warning(sentence_of({"From t = ", run.start, " s to ", run.now, " s ", found.halved,
                               found.halved == 1 ? " step" : " steps", " gained energy that no work explains; ",
                               run.halved, were_halved, ". Repeat the run with half the step and compare."}));
  }
};

/// Writes the report as one paragraph: cost, events, redundant joints and warnings.
template <class = void>
std::ostream& operator<<(std::ostream& out, RunReport const& r) {
  auto const counted = [](long n, char const* one, char const* many) {
    return std::to_string(n) + ' ' + (n == 1 ? one : many);
  };
  std::string text = sentence_of({counted(r.steps, "step", "steps"), " with ",
                                  counted(r.iterations, "Newton iteration", "Newton iterations"), ", ",
                                  counted(r.factorisations, "factorisation", "factorisations"), " and ",
                                  counted(r.evaluations, "evaluation", "evaluations"), " of the forces."});
  if (r.rejected > 0)
    text += sentence_of({" ", counted(r.rejected, "trial step was", "trial steps were"), " rejected, ",
                         std::to_string(r.halved), " of them halved."});
  if (r.over_budget > 0)
    text += sentence_of({" ", counted(r.over_budget, "step", "steps"),
                         " reached the budget of Newton's method; the largest last correction is ", r.left,
                         " times its tolerance."});
  for (RunReport::EventRecord const& event : r.events)
    text += sentence_of({" Event \"", event.name, "\" at t = ", event.time, " s."});
  if (r.stopped) text += " The last event ended the run.";
  for (std::string const& joint : r.redundant)
    text += sentence_of({" Joint \"", joint, "\" has redundant constraint equations."});
  for (std::string const& warning : r.warnings) text += " Warning: " + warning;
  return out << text;
}

}  // namespace polybody
