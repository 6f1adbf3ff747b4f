#pragma once
/// \file
/// Results of a comparison of formulations: numbers and histories of each run, and a table of all runs.

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iomanip>
#include <limits>
#include <ostream>
#include <span>

#include <polybody/run/energy.hpp>
#include <polybody/run/observe.hpp>
#include <polybody/run/problem_size.hpp>
#include <polybody/run/run_options.hpp>

namespace polybody {

/// Results of one run, a column of the report. A failed run contains the results up to its failure.
struct ComparedRun {
  std::string name;                          ///< name of the formulation
  std::string family = {};                   ///< family of the body, see bodies/shared/family.hpp; empty: unknown
  std::string policy = {};                   ///< name of the policy of the joints; empty: unknown
  std::string failure = {};                  ///< message of the exception that ended the run; empty for a complete run
  ProblemSize problem_size;                  ///< problem size of the model
  RunReport run;                             ///< steps, iterations and other counts of the run
  double cpu = 0.0;                          ///< CPU time of the steps [s]
  Violation violation;                       ///< largest violations over the run
  double energy_start = 0.0;                 ///< total energy at the start [J]
  double energy_end = 0.0;                   ///< total energy at the end [J]
  double peak_joint_force = 0.0;             ///< largest joint force over the run [N]
  std::vector<double> times;                 ///< (n) times of the recorded states, from the start to the end [s]
  std::vector<Violation> violations;         ///< (n) largest violations at each time
  std::vector<Energy> energies;              ///< (n) energies at each time [J]
  std::vector<double> joint_forces;          ///< (n) largest force of all joints at each time [N]
  std::vector<std::string> output_names;     ///< names in the order of `outputs`
  std::vector<std::vector<double>> outputs;  ///< one history (n) for each output
  /// (outputs) Largest difference of each output from the first complete run [unit of the output]. NaN if no run is
  /// complete, or if this run failed before its first state.
  std::vector<double> difference;
};

/// Runs of one case under several formulations.
struct Comparison {
  std::vector<ComparedRun> runs;  ///< runs in the order of the formulations

  /// First complete run, with which the other runs are compared. If all runs failed, the first run. Requires at least
  /// one run.
  ComparedRun const& reference() const {
    auto const complete = [](ComparedRun const& run) { return run.failure.empty(); };
    auto const found = std::find_if(runs.begin(), runs.end(), complete);
    return found == runs.end() ? runs.front() : *found;
  }
};

/// Error of a comparison in which runs failed, thrown by `require_complete`. The message gives each failed run with its
/// reason.
class ComparisonFailed : public Error {
 public:
  /// Error with a `code`, the `parts` of a message about the failed runs, and the completed runs `others`.
  ComparisonFailed(char const* code, std::initializer_list<MessagePart> parts, Comparison others)
      : Error(code, parts), finished(std::move(others)) {}

  Comparison finished;  ///< completed runs
};

/// Returns the comparison if all runs are complete. \throws ComparisonFailed otherwise, with the complete runs.
template <class = void>  // compiled where it is used
Comparison require_complete(Comparison c) {
  std::string failures;
  for (ComparedRun const& run : c.runs)
    if (!run.failure.empty()) failures += sentence_of({" \"", run.name, "\": ", run.failure});
  if (failures.empty()) return c;
  std::erase_if(c.runs, [](ComparedRun const& run) { return !run.failure.empty(); });
  throw ComparisonFailed("compare.failed", {"compare: runs failed.", failures}, std::move(c));
}

/// Number with name and unit.
struct Quantity {
  std::string name;  ///< name with unit
  double value;      ///< value in the unit of `name`
};

/// History of a quantity at the times of a run.
struct History {
  std::string name;            ///< name with unit
  std::vector<double> values;  ///< values in the unit of `name`, one for each time of the run
};

/// Column of the report for one run. The CPU ratio is relative to the `first` run. Outputs that a failed run has not
/// computed are NaN.
template <class = void>  // compiled where it is used
std::vector<Quantity> quantities(ComparedRun const& run, ComparedRun const& first) {
  double const steps = double(std::max(run.run.steps, 1L));
  std::vector<Quantity> column{{"coordinates", double(run.problem_size.coordinates)},
                               {"constraints", double(run.problem_size.constraints)},
                               {"degrees of freedom", double(run.problem_size.degrees_of_freedom)},
                               {"multiplier rows", double(run.problem_size.rows)},
                               {"steps", double(run.run.steps)},
                               {"Newton iterations per step", double(run.run.iterations) / steps},
                               {"factorisations per step", double(run.run.factorisations) / steps},
                               {"CPU time [s]", run.cpu},
                               {"CPU ratio to the first", run.cpu / std::max(first.cpu, 1e-9)},
                               {"position violation", run.violation.position},
                               {"velocity violation", run.violation.velocity},
                               {"acceleration violation", run.violation.acceleration},
                               {"energy at the end - at the start [J]", run.energy_end - run.energy_start},
                               {"peak joint force [N]", run.peak_joint_force}};
  for (std::size_t i = 0; i < run.outputs.size(); ++i) {
    column.push_back({"end: " + run.output_names[i],
                      run.outputs[i].empty() ? std::numeric_limits<double>::quiet_NaN() : run.outputs[i].back()});
    column.push_back({"largest difference from the first: " + run.output_names[i], run.difference[i]});
  }
  return column;
}

/// Histories of a run: violations, energies and the largest joint force, then the outputs. An output with the name of
/// one of these histories replaces this history.
template <class = void>
std::vector<History> histories(ComparedRun const& run) {
  std::vector<History> all;
  for (char const* name : {"position violation", "velocity violation", "acceleration violation", "kinetic energy [J]",
                           "strain energy [J]", "gravity energy [J]", "energy of joints [J]", "energy of forces [J]",
                           "total energy [J]", "peak joint force [N]"})
    all.push_back({name, {}});
  for (std::size_t k = 0; k < run.times.size(); ++k) {
    Violation const& v = run.violations[k];
    Energy const& e = run.energies[k];
    double const now[] = {v.position, v.velocity, v.acceleration, e.kinetic, e.strain,
                          e.gravity,  e.joints,   e.forces,       e.total(), run.joint_forces[k]};
    for (std::size_t i = 0; i < all.size(); ++i) all[i].values.push_back(now[i]);
  }
  for (std::size_t i = 0; i < run.outputs.size(); ++i) {
    std::erase_if(all, [&](History const& h) { return h.name == run.output_names[i]; });
    all.push_back({run.output_names[i], run.outputs[i]});
  }
  return all;
}

namespace detail {

/// Interpolates y(t) in a history with increasing times, by the cubic through two times before t and two after it. Near
/// an end of the history, the cubic passes through its first or last four points. Beyond an end, the result is the
/// value at this end. Points closer to their neighbour than a tenth of the interval around t are omitted, because their
/// differences are mainly round-off.
template <class = void>
double interpolate(std::span<double const> times, std::span<double const> y, double t) {
  auto const after = std::lower_bound(times.begin(), times.end(), t);
  if (after == times.begin()) return y.front();
  if (after == times.end()) return y.back();
  std::size_t hi = std::size_t(after - times.begin()), lo = hi - 1, place[4] = {lo, hi}, count = 2;
  double const apart = 0.1 * (times[hi] - times[lo]);
  auto const one_before = [&] {
    for (std::size_t k = lo; k-- > 0 && count < 4;)
      if (times[lo] - times[k] >= apart) {
        place[count++] = lo = k;
        return;
      }
  };
  auto const one_behind = [&] {
    for (std::size_t k = hi; ++k < times.size() && count < 4;)
      if (times[k] - times[hi] >= apart) {
        place[count++] = hi = k;
        return;
      }
  };
  one_before();
  one_behind();
  one_before();
  one_behind();
  double sum = 0.0;
  for (std::size_t a = 0; a < count; ++a) {
    double weight = 1.0;
    for (std::size_t b = 0; b < count; ++b)
      if (b != a) weight *= (t - times[place[b]]) / (times[place[a]] - times[place[b]]);
    sum += weight * y[place[a]];
  }
  return sum;
}

}  // namespace detail

/// Prints the report as a table with one line per quantity and one column per formulation. The failures and the
/// warnings of the runs follow.
template <class = void>
std::ostream& operator<<(std::ostream& out, Comparison const& c) {
  if (c.runs.empty()) return out;
  std::vector<std::vector<Quantity>> columns;
  std::size_t wide = 14, label = 0;
  for (ComparedRun const& run : c.runs) {
    columns.push_back(quantities(run, c.reference()));
    wide = std::max(wide, run.name.size() + 2);
    for (Quantity const& q : columns.back()) label = std::max(label, q.name.size() + 1);
  }
  std::ios state(nullptr);
  state.copyfmt(out);
  out << std::left << std::setw(int(label)) << "" << std::right;
  for (ComparedRun const& run : c.runs) out << std::setw(int(wide)) << run.name;
  for (std::size_t i = 0; i < columns.front().size(); ++i) {
    out << '\n' << std::left << std::setw(int(label)) << columns.front()[i].name << std::right;
    for (auto const& column : columns) {
      double const x = column[i].value;
      bool const full = x == std::round(x) && std::abs(x) < 1e9;
      out << std::setw(int(wide)) << (full ? std::to_string(long(x)) : number(x, 4));
    }
  }
  out.copyfmt(state);
  for (ComparedRun const& run : c.runs) {
    if (!run.failure.empty()) {
      out << '\n' << run.name << " failed";
      if (!run.times.empty()) out << " after t = " << number(run.times.back(), 6) << " s";
      out << ": " << run.failure;
      continue;  // the message contains the warnings
    }
    for (std::string const& warning : run.run.warnings) out << '\n' << run.name << ": " << warning;
  }
  return out << '\n';
}

}  // namespace polybody
