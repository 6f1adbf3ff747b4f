#pragma once
/// \file
/// Tables, selections and curves of the results of a study.

#include <map>

#include <polybody/io/atomic_file.hpp>
#include <polybody/io/figure.hpp>
#include <polybody/io/table.hpp>
#include <polybody/io/text_files.hpp>
#include <polybody/study/outcome.hpp>

namespace polybody {

namespace detail {

/// Value of column j of point i, as written in a table: the name of a choice, or digits that read back exactly.
template <class = void>  // compiled where it is used
std::string column_text(Points const& points, std::size_t i, std::size_t j) {
  std::vector<std::string> const& choices = points.columns()[j].choices;
  return choices.empty() ? all_digits(points.at(i, j)) : choices[std::size_t(points.at(i, j))];
}

template <class = void>
std::string table_text(StudyResults const& found, bool with_measured) {
  bool const failures = found.failed() > 0;
  std::string text = "point";
  for (Column const& column : found.points.columns()) text += ',' + csv_text(column.head());
  for (StudyOutput const& output : found.outputs)
    if (with_measured || !output.measured) text += ',' + csv_text(output.head);
  text += failures ? ",failure\n" : "\n";
  for (std::size_t i = 0; i < found.outcomes.size(); ++i) {
    if (!found.outcomes[i]) continue;
    Outcome const& outcome = *found.outcomes[i];
    text += std::to_string(i);
    for (std::size_t j = 0; j < found.points.columns().size(); ++j) {
      std::string const value = column_text(found.points, i, j);
      text += ',' + (found.points.columns()[j].choices.empty() ? value : csv_text(value));
    }
    for (std::size_t j = 0; j < found.outputs.size(); ++j)
      if (with_measured || !found.outputs[j].measured)
        text += ',' + (outcome.failed() ? "" : all_digits(outcome.values[j]));
    if (failures) text += ',' + csv_text(outcome.failure);
    text += '\n';
  }
  return text;
}

}  // namespace detail

/// Writes the finished points of the results `found` to `file`, in the order of the points, with units in the heads.
/// Numbers read back to the same double. The row of a failed point has no outputs. If a point has failed, the column
/// "failure" contains the messages. Measured outputs are omitted, so the same study gives the same bytes. If there are
/// measured outputs, a second file contains all outputs. Its name is that of `file` with "_measured" before the
/// extension.
/// \throws IoError if a file cannot be written.
template <class = void>
void write_table(StudyResults const& found, std::filesystem::path const& file) {
  AtomicFile table(file);
  table.write(detail::table_text(found, false));
  table.close();
  if (std::ranges::none_of(found.outputs, [](StudyOutput const& o) { return o.measured; })) return;
  std::filesystem::path measured_file = file;
  measured_file.replace_filename(file.stem().string() + "_measured" + file.extension().string());
  AtomicFile all(measured_file);
  all.write(detail::table_text(found, true));
  all.close();
}

/// Results `found`, restricted to the points for which `keeps(point)` is true. The other points count as unfinished.
/// Example of use: one panel of a figure.
template <class Keeps>
StudyResults where(StudyResults found, Keeps const& keeps) {
  for (std::size_t i = 0; i < found.outcomes.size(); ++i)
    if (!keeps(found.points[i])) found.outcomes[i].reset();
  return found;
}

/// Curves of y over x for a Figure; x and y are parameters or outputs. There is one curve for each combination of
/// values of the parameters `by`, with its points in the order of the table. Failed and unfinished points are omitted.
/// \throws InvalidInput for a column that does not exist, and for a name in `by` that is not the name of a parameter.
template <class = void>
std::vector<Curve> curves_of(StudyResults const& found, std::string_view x, std::string_view y,
                             std::vector<std::string> const& by = {}) {
  std::vector<double> const of_x = found.column(x), of_y = found.column(y);
  std::vector<std::string> labels(of_x.size());
  for (std::string const& name : by) {
    found.column(name);  // throws if the column does not exist
    std::size_t const j =
        std::size_t(std::ranges::find(found.points.columns(), name, &Column::name) - found.points.columns().begin());
    if (j == found.points.columns().size())
      throw InvalidInput("study.no_column", {"study: \"", ErrorObject{name},
                                             "\" is not a parameter. Label curves by names of parameters only."});
    Column const& column = found.points.columns()[j];
    std::string const unit = column.unit.empty() ? "" : ' ' + column.unit;
    for (std::size_t i = 0, k = 0; i < found.outcomes.size(); ++i)
      if (found.outcomes[i] && !found.outcomes[i]->failed()) {
        std::string const value = detail::column_text(found.points, i, j);
        labels[k] += (labels[k].empty() ? "" : ", ") + (column.choices.empty() ? name + ' ' + value + unit : value);
        ++k;
      }
  }
  std::vector<Curve> curves;
  std::map<std::string, std::size_t> places;
  for (std::size_t k = 0; k < of_x.size(); ++k) {
    auto const [place, fresh] = places.try_emplace(labels[k], curves.size());
    if (fresh) curves.push_back({.label = labels[k], .style = "linespoints"});
    curves[place->second].x.push_back(of_x[k]);
    curves[place->second].y.push_back(of_y[k]);
  }
  return curves;
}

}  // namespace polybody
