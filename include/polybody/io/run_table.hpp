#pragma once
/// \file
/// Outputs of a run as a table, a file and a figure:
///
///     Table const table = tabulate(simulate(model, x, integrator, {.end_time = 2.0, .step = 1e-3}),
///                                  {{"energy [J]", [](auto const& now) { return now.energy().total(); }}});
///     plot(table, "out/pendulum");   // out/pendulum.csv, .dat, .gp, .png

#include <functional>

#include <polybody/io/csv.hpp>
#include <polybody/io/plot.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/sampling.hpp>

namespace polybody {

/// Output of a run: a number that is a function of the state.
struct TableColumn {
  std::string name;                                   ///< name with unit: "tip height [m]"
  std::function<double(ObservedState const&)> value;  ///< value, in the unit of `name`
};

namespace detail {

/// Checks that columns have values and different names, and that no name is "t [s]".
/// \throws InvalidInput otherwise.
template <class = void>  // compiled where it is used
void check(std::vector<TableColumn> const& columns) {
  std::vector<std::string> names{"t [s]"};
  for (TableColumn const& c : columns) {
    if (c.name.empty() || !c.value)
      throw InvalidInput("table.columns", {ErrorObject{"tabulate"}, ": column ", names.size(),
                                           ", counted from 1, lacks a name or a value function."});
    names.push_back(c.name);
  }
  std::ranges::sort(names);
  if (auto const twice = std::ranges::adjacent_find(names); twice != names.end())
    throw InvalidInput("table.columns",
                       {ErrorObject{"tabulate"}, ": duplicate column \"", *twice,
                        "\". Names must differ from each other and from \"t [s]\", the name of the first column."});
}

/// Unit at the end of a column's head: "m/s" of "speed [m/s]"; empty if the head has no unit.
template <class = void>
std::string unit_of(std::string const& head) {
  std::size_t const begin = head.rfind('[');
  bool const has_unit = begin != head.npos && head.ends_with(']');
  return has_unit ? head.substr(begin + 1, head.size() - begin - 2) : "";
}

/// Figures of the columns over the first column, with one figure for each unit, in the order of the columns. A column
/// without a unit has a separate figure.
template <class = void>
std::vector<Figure> figures_of(Table const& table) {
  std::vector<Figure> figures;
  std::vector<std::string> units;
  std::vector<double> const x = table.column(table.columns.front());
  for (std::size_t j = 1; j < table.columns.size(); ++j) {
    std::string const &head = table.columns[j], unit = unit_of(head);
    auto const found = unit.empty() ? units.end() : std::ranges::find(units, unit);
    std::size_t const place = std::size_t(found - units.begin());
    if (found == units.end()) {
      units.push_back(unit);
      figures.push_back({.x_label = table.columns.front(), .y_label = head, .width_px = 900, .height_px = 560});
    }
    figures[place].curves.push_back({.x = x, .y = table.column(head), .label = head});
  }
  for (std::size_t i = 0; i < figures.size(); ++i) {
    figures[i].legend = figures[i].curves.size() > 1;
    if (figures[i].legend) figures[i].y_label = '[' + units[i] + ']';
  }
  return figures;
}

}  // namespace detail

/// Completes a run and returns a table of `columns`. The rows are the first state, the first state at or after each
/// multiple of the time `sampling` [s] after the start, and the last state. If `sampling` is zero, every state is a
/// row. The first column is "t [s]".
/// \throws InvalidInput for columns without a name or a value, for equal names, and for a negative sampling.
/// \throws NonFiniteValue for a value that is not finite, and the exceptions of the run.
template <class Run>
Table tabulate(Run&& run, std::vector<TableColumn> const& columns, double sampling = 0.0) {
  detail::check(columns);
  require_not_negative(sampling, "tabulate: the sampling of ", "the table");
  Table table{{"t [s]"}, {}};
  for (TableColumn const& c : columns) table.columns.push_back(c.name);
  RunSampling samples(run.state().t, sampling);
  for (ObservedState const& x : run) {
    if (!samples.takes(x.t) && !table.rows.empty() && !run.done()) continue;
    auto& row = table.rows.emplace_back(1, x.t);
    for (TableColumn const& c : columns) {
      row.push_back(c.value(x));
      if (!std::isfinite(row.back()))
        throw NonFiniteValue("output.not_finite", {"tabulate: \"", ErrorObject{c.name}, "\"",
                                                   non_finite_suffix(row.back()), " at t = ", ErrorTime{x.t}, " s."});
    }
  }
  return table;
}

/// Writes a table to `file`. `read_csv` returns the same doubles. Throws InvalidInput for empty or equal heads and for
/// numbers that are not finite; IoError if the file cannot be written.
template <class = void>
void write_csv(Table const& table, std::filesystem::path const& file) {
  Csv csv(file, table.columns, Csv::Keeps::full_table);
  for (auto const& row : table.rows) csv.row(row);
  csv.close();
}

/// Writes `stem`.csv, and figures of all columns over the first one to `stem`.dat, .gp and, if `draw` is true and
/// gnuplot is on PATH, .png. Columns with the same unit ("… [m]") share a panel. Throws InvalidInput for a table
/// without rows or with less than two columns, and like `write_csv` and `write_panels`.
template <class = void>
DrawResult plot(Table const& table, std::filesystem::path const& stem, bool draw = true) {
  if (table.rows.empty() || table.columns.size() < 2)
    throw InvalidInput("figure.content",
                       {"plot: the table for \"", ErrorObject{stem.string()}, "\" has ", table.rows.size(), " rows of ",
                        table.columns.size(), " columns; it needs at least one row and two columns."});
  std::vector<Figure> const figures = detail::figures_of(table);
  write_csv(table, detail::with_ending(stem, ".csv"));
  return write_panels(figures, figures.size() < 4 ? 1 : 2, stem, draw);
}

}  // namespace polybody
