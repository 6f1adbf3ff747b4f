#pragma once
/// \file
/// Results of a study at its points.

#include <optional>

#include <polybody/study/points.hpp>

namespace polybody {

/// Output of a study: a number computed at each point.
struct StudyOutput {
  std::string head;       ///< name with unit: "error [m]"
  bool measured = false;  ///< true: the number differs between runs, such as a time

  /// Conversion of a head to an output.
  StudyOutput(char const* name) : head(name) {}  // NOLINT(google-explicit-constructor)
  /// Conversion of a head to an output.
  StudyOutput(std::string name) : head(std::move(name)) {}  // NOLINT(google-explicit-constructor)
  /// Output with the head `name`; `is_measured` marks a number that differs between runs.
  StudyOutput(std::string name, bool is_measured) : head(std::move(name)), measured(is_measured) {}
};

/// Output with this `head` whose number differs between runs, such as a time. Records and figures include this output.
/// `write_table` omits it, so that the table is bitwise identical for each run.
inline StudyOutput measured(std::string head) { return {std::move(head), true}; }

/// List of outputs with these `heads`, as in `outputs("error [m]", measured("cpu [s]"))`.
template <class... Heads>
std::vector<StudyOutput> outputs(Heads&&... heads) {
  return {StudyOutput(std::forward<Heads>(heads))...};
}

/// Result of a point: a number for each output, or the reason of a failure.
struct Outcome {
  std::vector<double> values{};  ///< values of the outputs, each in the unit of its head; empty after a failure
  std::string failure{};         ///< reason of a failure, one line; empty: no failure

  bool failed() const { return !failure.empty(); }  ///< true if the point failed
};

/// Results of a study; complete, or partial if points are unfinished.
struct StudyResults {
  Points points;                                   ///< points of the study
  std::vector<StudyOutput> outputs;                ///< outputs of the study
  std::vector<std::optional<Outcome>> outcomes{};  ///< outcomes in the order of the points; none if unfinished
  std::size_t resumed = 0;                         ///< number of points with an outcome of an earlier run
  bool torn = false;                               ///< true if an earlier run was killed while it wrote a line

  /// Number of points that have an outcome, including failures.
  std::size_t finished() const {
    return std::size_t(std::ranges::count_if(outcomes, [](auto const& o) { return o.has_value(); }));
  }
  /// Number of points whose outcome is a failure.
  std::size_t failed() const {
    return std::size_t(std::ranges::count_if(outcomes, [](auto const& o) { return o && o->failed(); }));
  }
  /// Returns true if every point has an outcome.
  bool complete() const { return finished() == points.size(); }

  /// Values of the parameter or output `name` at the points that are finished and not failed, in the order of the
  /// points. `name` is the name or the head of a parameter, or the head of an output.
  /// \throws InvalidInput if there is no such column.
  std::vector<double> column(std::string_view name) const {
    std::vector<double> values;
    auto const take = [&](auto const& value) {
      for (std::size_t i = 0; i < outcomes.size(); ++i)
        if (outcomes[i] && !outcomes[i]->failed()) values.push_back(value(i));
      return values;
    };
    for (std::size_t j = 0; j < points.columns().size(); ++j)
      if (points.columns()[j].name == name || points.columns()[j].head() == name)
        return take([&](std::size_t i) { return points.at(i, j); });
    for (std::size_t j = 0; j < outputs.size(); ++j)
      if (outputs[j].head == name) return take([&](std::size_t i) { return outcomes[i]->values[j]; });
    std::string all;
    for (Column const& column : points.columns()) all += '"' + column.head() + "\", ";
    for (StudyOutput const& output : outputs) all += '"' + output.head + "\", ";
    throw InvalidInput("study.no_column", {"study: no column \"", ErrorObject{name}, "\"; the columns are ",
                                           all.substr(0, all.size() - 2), "."});
  }
};

}  // namespace polybody
