#pragma once
/// \file
/// What a run is asked for, and what it reports.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <polybody/integrators/integrator.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/run/event.hpp>

namespace polybody {

/// How far a run has come [s].
struct RunProgress {
  double start;     ///< [s]
  double end_time;  ///< [s]
  double now;       ///< [s]
  bool done;        ///< at `end_time`, or stopped by an event
};

/// What a run is asked for.
struct RunOptions {
  Required<double> end_time;             ///< [s]
  Required<double> step;                 ///< [s]; the first one for an integrator that controls its step
  std::optional<double> max_step = {};   ///< [s], for an integrator that controls its step
  std::vector<double> breakpoints = {};  ///< times at which a step must end, beside those of the drives and loads [s]
  std::vector<Event> events = {};        ///< looked for in each step
  /// |Φ| of the start [m], [rad]. Lengths in an assembly of bodies smaller than one metre are relative to its extent.
  double assembly_tolerance = 1e-8;
  /// Number of times that a step which fails with `NewtonConvergenceFailure` is halved, in [0, 30]; empty: 6 in
  /// `simulate`, and 0 in runs that are differentiated. The report counts halved steps. 0: such a step ends the run.
  std::optional<int> max_step_halvings = {};
  bool minimum_norm = false;       ///< every state gets the multipliers of `MinimumNorm`; costs a factorisation each
  PlausibilityLimits limits = {};  ///< of a step's end: constraint violation, and energy that no work explains
  int threads = 1;  ///< that share the loops of an evaluation; for large models, results stay the same bits
  std::function<void(RunProgress const&)> progress = {};  ///< told after each step; `progress_bar` of io makes one

  /// `max_step_halvings`, or its default.
  int allowed_halvings() const { return max_step_halvings.value_or(6); }

  /// \throws InvalidInput for a run from `start` [s] that cannot be meant.
  [[gnu::cold]] void check(double start) const {
    require_positive(step, "simulate: the step");
    if (max_step) require_positive(*max_step, "simulate: the largest step");
    require_positive(assembly_tolerance, "simulate: assembly_tolerance");
    if (!(end_time >= start) || !std::isfinite(end_time))
      throw InvalidInput("run.end_time", {ErrorObject{"simulate"}, ": the end time ", ErrorValue{end_time},
                                          " s lies before the start ", start, " s."});
    double const latest = std::max(std::abs(start), std::abs(end_time)),
                 resolved = std::nextafter(latest, std::numeric_limits<double>::infinity()) - latest;
    if (step < 32.0 * resolved)
      throw InvalidInput("run.clock", {ErrorObject{"simulate"}, ": the clock resolves ", resolved,
                                       " s at t = ", ErrorTime{end_time}, " s, which is too coarse for steps of ",
                                       ErrorValue{step}, " s. Count the time of the run from a start near zero."});
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
        throw InvalidInput("run.option", {ErrorObject{"simulate"}, ": a breakpoint must be a time [s], but is nan."});
    for (Event const& event : events) {
      if (!event.value)
        throw InvalidInput("event.no_value", {"simulate: the event \"", ErrorObject{event.name}, "\" has no value."});
      require_positive(event.tolerance, "simulate: the tolerance of the event \"" + event.name + "\"");
    }
  }
};

/// The cost of a run so far in numbers. Failed attempts count if a shorter step succeeds; a step that ends the run by
/// an exception does not count.
struct RunCounts {
  long steps = 0;           ///< taken
  long iterations = 0;      ///< of Newton's method
  long factorisations = 0;  ///< of tangents and masses
  long evaluations = 0;     ///< of the forces
  long rejected = 0;        ///< trial steps, and steps that were halved
  long halved = 0;          ///< steps that failed and were repeated by halves
  long over_budget = 0;     ///< steps that ended at Newton's budget
  double left = 0.0;        ///< the largest correction that one of them ended with, relative to what is tolerated
  StepReport last = {};     ///< the last step's

  /// Counts the cost of a step.
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

/// The cost of a run so far, and the events that it met.
struct RunReport : RunCounts {
  /// An event that the run met, and when.
  struct EventRecord {
    std::string name;  ///< the event's
    double time;       ///< [s]
  };
  Sequence<EventRecord> events = {};  ///< in the order of time
  bool stopped = false;               ///< by an event before `end_time`
  /// Joints with rows that repeat those of others at the last start: the motion is right, but how the reactions share
  /// the load is not determined.
  std::vector<std::string> redundant = {};
  /// In sentences: of the start, a singular position in which its speeds do not tell a branch of the motion, and a step
  /// beyond the limit of an explicit integrator; of a step, a singular position at which the speeds jumped to another
  /// branch; of the end, energy that no work explains.
  std::vector<std::string> warnings = {};

  /// Adds a sentence, if it has words.
  void add_warning(std::string sentence) {
    if (!sentence.empty()) warnings.push_back(std::move(sentence));
  }
  /// A warning begins with these words.
  bool warns(char const* words) const {
    return std::any_of(warnings.begin(), warnings.end(), [&](std::string const& w) { return w.starts_with(words); });
  }
  /// Sentences for the message of an exception that ends the run: number of halved steps, and the warnings. Empty if
  /// there are none.
  [[gnu::cold]] std::string warned() const {
    std::string all;
    if (halved > 0) all = sentence_of({"Before, ", halved, halved == 1 ? " step was halved." : " steps were halved."});
    for (std::string const& warning : warnings)
      all += (all.empty() ? "Warning of the run: " : " Warning of the run: ") + warning;
    return all;
  }
  /// Times of a run [s], and how many of its steps were halved.
  struct Course {
    double start, now;  ///< [s]
    long halved;        ///< steps
  };
  /// Adds a warning where more than the share `limit` of the energy that moved has no explanation.
  [[gnu::cold]] void warn_of_energy(Unexplained const& found, double limit, Course const& run) {
    if (!found.known) return;
    if (found.worst > 0.4 * found.scale)
      add_warning(
          sentence_of({"The work of a force over one step is uncertain by ", found.worst, " J, of ", found.scale,
                       " J that moved: the steps do not resolve it. Compare the run with one of half the step."}));
    else if (std::abs(found.energy) > limit * found.scale + found.doubt)
      add_warning(
          sentence_of({"From t = ", run.start, " s to ", run.now, " s the motion ",
                       found.energy > 0.0 ? "gains " : "loses ", std::abs(found.energy), " J that no work explains, ",
                       std::abs(found.energy) / found.scale, " of the energy that moved (", found.scale, " J); ",
                       run.halved, " steps were halved. Compare the run with one of half the step."}));
  }
};

}  // namespace polybody
