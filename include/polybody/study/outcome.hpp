#pragma once
/// \file
/// What a study finds at its points.
///
/// Not in polybody.hpp: of use to studies only.

#include <optional>

#include <polybody/study/points.hpp>

namespace polybody {

/// A number that a study finds at each point.
struct StudyOutput {
  std::string head;       ///< with its unit: "error [m]"
  bool measured = false;  ///< such as a time: another run finds another number

  /// A head is an output.
  StudyOutput(char const* name) : head(name) {}  // NOLINT(google-explicit-constructor)
  /// The same.
  StudyOutput(std::string name) : head(std::move(name)) {}  // NOLINT(google-explicit-constructor)
  /// An output that may be measured: `is_measured`.
  StudyOutput(std::string name, bool is_measured) : head(std::move(name)), measured(is_measured) {}
};

/// A number under `head` that another run of the same point would not find again, as a time. It is recorded and drawn
/// like the others; the table that is the same bit for bit leaves it out.
inline StudyOutput measured(std::string head) { return {std::move(head), true}; }

/// An output for each of `heads`: outputs("error [m]", measured("cpu [s]"))
template <class... Heads>
std::vector<StudyOutput> outputs(Heads&&... heads) {
  return {StudyOutput(std::forward<Heads>(heads))...};
}

/// What a point gave: a number for each output, or why there is none.
struct Outcome {
  std::vector<double> values{};  ///< of the outputs, each in the unit of its head; none where it failed
  std::string failure{};         ///< one line; empty: none

  bool failed() const { return !failure.empty(); }  ///< there are no values
};

/// All that a study found so far.
struct StudyResults {
  Points points;                                   ///< of the study
  std::vector<StudyOutput> outputs;                ///< of the study
  std::vector<std::optional<Outcome>> outcomes{};  ///< in the order of the points; nothing where it is not finished
  std::size_t taken_over = 0;                      ///< points that an earlier run had finished
  bool torn = false;                               ///< an earlier run was killed while it wrote

  /// Points that have an outcome, be it a failure.
  std::size_t finished() const {
    return std::size_t(std::ranges::count_if(outcomes, [](auto const& o) { return o.has_value(); }));
  }
  /// Points whose outcome is a failure.
  std::size_t failed() const {
    return std::size_t(std::ranges::count_if(outcomes, [](auto const& o) { return o && o->failed(); }));
  }
  /// Every point has an outcome.
  bool complete() const { return finished() == points.size(); }

  /// The values of a parameter (by its name or its head) or an output at the points that have outputs, in their order.
  /// \throws InvalidInput where there is none.
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
    for (Column const& column : points.columns()) all += '\'' + column.head() + "', ";
    for (StudyOutput const& output : outputs) all += '\'' + output.head + "', ";
    throw InvalidInput{"study: it has no column '", name, "'; there are ", all.substr(0, all.size() - 2), "."};
  }
};

}  // namespace polybody
