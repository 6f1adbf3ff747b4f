#pragma once
/// \file
/// Tables, histories and figures of comparisons and work-precision studies, written to files. Failed runs of a
/// comparison are omitted.

#include <polybody/compare/work_precision.hpp>
#include <polybody/io/comparison_figures.hpp>
#include <polybody/io/csv.hpp>
#include <polybody/io/plot.hpp>

namespace polybody {

namespace detail {

/// Returns the comparison c without its failed runs.
template <class = void>
Comparison complete_runs(Comparison c) {
  std::erase_if(c.runs, [](ComparedRun const& run) { return !run.failure.empty(); });
  return c;
}

/// Checks that a comparison has runs, that their histories are complete, and that each run has the outputs of the first
/// run.
/// \throws InvalidInput otherwise.
template <class = void>  // compiled where it is used
void check(Comparison const& c, std::string const& what) {
  if (c.runs.empty())
    throw InvalidInput("comparison.runs", {ErrorObject{what},
                                           ": the comparison has no runs, or all of them failed. Give `compare` a "
                                           "formulation whose run completes."});
  for (ComparedRun const& run : c.runs) {
    std::size_t const n = run.times.size(), outputs = run.output_names.size();
    bool full = n > 0 && run.violations.size() == n && run.energies.size() == n && run.joint_forces.size() == n &&
                run.outputs.size() == outputs && run.difference.size() == outputs &&
                run.output_names == c.runs.front().output_names;
    for (auto const& history : run.outputs) full = full && history.size() == n;
    if (!full)
      throw InvalidInput("comparison.runs",
                         {ErrorObject{what}, ": the run \"", run.name,
                          "\" has no times, a history whose length differs from the number of times, "
                          "or outputs that differ from those of the first run. Use the runs that `compare` returns."});
  }
}

/// Converts `name` to a part of a file name: letters, digits and non-ASCII characters remain. Each group of other
/// characters becomes one '_', or is removed at the beginning and end.
template <class = void>
std::string word_for_file(std::string const& name) {
  std::string word;
  for (char const c : name) {
    bool const stays = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c & 0x80) != 0;
    if (stays)
      word += c;
    else if (!word.empty() && word.back() != '_')
      word += '_';
  }
  if (word.ends_with('_')) word.pop_back();
  return word;
}

/// Writes each figure as a panel, in `columns` columns and with at most six panels per picture (`stem`, `stem`_2, …).
/// Gnuplot draws the pictures if `draw` is true. Adds the names of the files to `written`.
template <class = void>
void draw_panels(std::vector<Figure> const& figures, int columns, std::filesystem::path const& stem, bool draw,
                 std::vector<std::filesystem::path>& written) {
  constexpr std::size_t on_a_page = 6;
  for (std::size_t first = 0; first < figures.size(); first += on_a_page) {
    auto const begin = figures.begin() + std::ptrdiff_t(first);
    std::vector<Figure> const page(begin, begin + std::ptrdiff_t(std::min(on_a_page, figures.size() - first)));
    std::filesystem::path place = stem;
    if (first > 0) place += '_' + std::to_string(first / on_a_page + 1);
    bool const drawn = write_panels(page, columns, place, draw) == DrawResult::png;
    written.push_back(with_ending(place, ".dat"));
    written.push_back(with_ending(place, ".gp"));
    if (drawn) written.push_back(with_ending(place, ".png"));
  }
}

}  // namespace detail

/// Writes the table that operator<< prints for a comparison, in full precision, with one row per quantity and one
/// column per run. Throws InvalidInput for a comparison without complete runs and for numbers that are not finite;
/// IoError if the file cannot be written.
template <class = void>
void write_csv(Comparison const& all, std::filesystem::path const& file) {
  Comparison const c = detail::complete_runs(all);
  detail::check(c, "write_csv");
  std::vector<std::string> heads{"quantity"};
  std::vector<std::vector<Quantity>> columns;
  for (ComparedRun const& run : c.runs) {
    heads.push_back(run.name);
    columns.push_back(quantities(run, c.runs.front()));
  }
  Csv csv(file, std::move(heads), Csv::Keeps::full_table);
  std::vector<double> row(columns.size());
  for (std::size_t i = 0; i < columns.front().size(); ++i) {
    for (std::size_t j = 0; j < columns.size(); ++j) row[j] = columns[j][i].value;
    csv.row(columns.front()[i].name, row);
  }
  csv.close();
}

/// Writes the histories of each run to a separate file in `folder`, history_<number>_<name>.csv. The columns are "t
/// [s]" and the result of `histories(run)`. Returns the files in the order of the runs. Throws InvalidInput for a
/// comparison without complete runs and for numbers that are not finite; IoError if a file cannot be written.
template <class = void>
std::vector<std::filesystem::path> write_histories(Comparison const& all, std::filesystem::path const& folder) {
  Comparison const c = detail::complete_runs(all);
  detail::check(c, "write_histories");
  std::vector<std::filesystem::path> written;
  for (ComparedRun const& run : c.runs) {
    std::vector<History> const columns = histories(run);
    std::vector<std::string> heads{"t [s]"};
    for (History const& h : columns) heads.push_back(h.name);
    written.push_back(
        folder / ("history_" + std::to_string(written.size() + 1) + '_' + detail::word_for_file(run.name) + ".csv"));
    Csv csv(written.back(), std::move(heads));
    std::vector<double> row(columns.size() + 1);
    for (std::size_t k = 0; k < run.times.size(); ++k) {
      row[0] = run.times[k];
      for (std::size_t i = 0; i < columns.size(); ++i) row[i + 1] = columns[i].values[k];
      csv.row(row);
    }
    csv.close();
  }
  return written;
}

/// Draws the histories of all runs as figures in `folder`:
///   `outputs`      each output and its difference from the first run, in descending order of the relative difference
///   `violations`   constraint violations of positions, velocities and accelerations
///   `joint_force`  largest force of all joints at each time
///   `energies`     kinetic and potential energy, and change of the total energy since the start
///   `cost`         largest relative difference of each run from the first run, over the CPU time
///
/// A page has at most six panels; further pages are `outputs_2`, …. Each page consists of the files .dat and .gp, and
/// .png if gnuplot is found and `draw` is true. A figure without data is not written. Returns the files. Throws
/// InvalidInput for a comparison without complete runs; IoError if a file cannot be written or gnuplot fails.
template <class = void>
std::vector<std::filesystem::path> write_figures(Comparison const& all, std::filesystem::path const& folder,
                                                 bool draw = true) {
  Comparison const c = detail::complete_runs(all);
  detail::check(c, "write_figures");
  using Run = ComparedRun const&;
  std::vector<std::filesystem::path> written;
  std::vector<Figure> violations;
  detail::draw_panels(detail::output_figures(c), c.runs.front().outputs.size() > 1 || c.runs.size() > 1 ? 2 : 1,
                      folder / "outputs", draw, written);
  detail::draw_panels(detail::cost_figure(c), 1, folder / "cost", draw, written);
  detail::add_violations(c, "Violation of positions", "[m, rad, 1]", &Violation::position, violations);
  detail::add_violations(c, "Violation of velocities", "[m/s, rad/s, 1/s]", &Violation::velocity, violations);
  detail::add_violations(c, "Violation of accelerations", "[m/s², rad/s², 1/s²]", &Violation::acceleration, violations);
  detail::draw_panels(violations, 1, folder / "violations", draw, written);
  auto const force = [](Run run, std::size_t k) { return run.joint_forces[k]; };
  detail::draw_panels({detail::over_time(c, "Largest force of all joints", "force [N]", force)}, 1,
                      folder / "joint_force", draw, written);
  detail::draw_panels({detail::over_time(c, "Kinetic energy", "energy [J]",
                                         [](Run run, std::size_t k) { return run.energies[k].kinetic; }),
                       detail::over_time(c, "Potential energy", "energy [J]",
                                         [](Run run, std::size_t k) { return run.energies[k].potential(); }),
                       detail::over_time(c, "Total energy, change since the start", "energy [J]",
                                         [](Run run, std::size_t k) {
                                           return run.energies[k].total() - run.energies.front().total();
                                         })},
                      1, folder / "energies", draw, written);
  return written;
}

/// Writes table.csv and the files of `write_histories` and `write_figures` for a comparison to `folder`. Gnuplot draws
/// the figures if `draw` is true. Returns the files. Throws like `write_csv`, `write_histories` and `write_figures`.
template <class = void>
std::vector<std::filesystem::path> write_report(Comparison const& all, std::filesystem::path const& folder,
                                                bool draw = true) {
  Comparison const c = detail::complete_runs(all);
  detail::check(c, "write_report");
  std::vector<std::filesystem::path> written{folder / "table.csv"};
  write_csv(c, written.front());
  for (auto const& files : {write_histories(c, folder), write_figures(c, folder, draw)})
    written.insert(written.end(), files.begin(), files.end());
  return written;
}

/// Writes the points of all completed runs to `file`, one row per point. Throws InvalidInput for numbers that are not
/// finite; IoError if the file cannot be written.
template <class = void>
void write_csv(WorkPrecision const& w, std::filesystem::path const& file) {
  Csv csv(file, {"formulation", "step [s] or tolerance", "steps", "CPU time [s]", "error"}, Csv::Keeps::full_table);
  for (WorkCurve const& curve : w.curves)
    for (WorkPoint const& p : curve.points)
      if (p.failure.empty()) csv.row(curve.name, std::array{p.setting, double(p.steps), p.cpu, p.error});
  csv.close();
}

/// Figure of the error over CPU time for the completed runs, with logarithmic axes. Throws InvalidInput if there are no
/// curves, or if the curves show different outputs.
template <class = void>
Figure work_precision_figure(WorkPrecision const& w) {
  if (w.curves.empty())
    throw InvalidInput("figure.content", {ErrorObject{"work_precision_figure"},
                                          ": there are no curves. Add the curves that `work_precision` returns."});
  Figure figure{.title = "Work and precision",
                .x_label = "CPU time [s]",
                .y_label = "error of " + w.curves.front().output,
                .log_x = true,
                .log_y = true};
  for (WorkCurve const& curve : w.curves) {
    if (curve.output != w.curves.front().output)
      throw InvalidInput("figure.content", {ErrorObject{"work_precision_figure"}, ": the curve \"", curve.name,
                                            "\" shows the output \"", curve.output, "\", not \"",
                                            w.curves.front().output, "\". Draw this curve in another figure."});
    Curve drawn{.label = curve.name, .style = "linespoints", .colour = int(&curve - w.curves.data())};
    for (WorkPoint const& p : curve.points)
      if (p.failure.empty()) {
        drawn.x.push_back(p.cpu);
        drawn.y.push_back(p.error);
      }
    if (!drawn.x.empty()) figure.curves.push_back(std::move(drawn));
  }
  return figure;
}

/// Writes the points and their figure to `folder`: work_precision.csv, .dat and .gp, and .png if gnuplot is found and
/// `draw` is true. Returns the files. Throws InvalidInput if no run is complete, or if the curves show different
/// outputs; IoError if a file cannot be written or gnuplot fails.
template <class = void>
std::vector<std::filesystem::path> write_report(WorkPrecision const& w, std::filesystem::path const& folder,
                                                bool draw = true) {
  Figure const figure = work_precision_figure(w);
  std::filesystem::path const stem = folder / "work_precision";
  std::vector<std::filesystem::path> written{detail::with_ending(stem, ".csv")};
  write_csv(w, written.front());
  detail::draw_panels({figure}, 1, stem, draw, written);
  return written;
}

}  // namespace polybody
