#include "external.hpp"

#include <cmath>

#include <polybody/compare/work_precision.hpp>
#include <polybody/io/equal_error_page.hpp>

namespace atlas {

namespace fs = std::filesystem;

namespace {

// The history in a file with two columns: times [s], ascending, and values of the output.
OutputHistory history_of(fs::path const& file) {
  polybody::Table const table = read_csv(file);
  if (table.columns.size() != 2 || table.rows.size() < 4)
    throw InvalidInput{"file \"",
                       ErrorObject{file.string()},
                       "\": a history has two columns and at least four rows, but "
                       "the file has ",
                       table.columns.size(),
                       " columns and ",
                       table.rows.size(),
                       " rows."};
  OutputHistory y;
  for (auto const& row : table.rows) {
    if (!y.times.empty() && row[0] <= y.times.back())
      throw InvalidInput{"file \"",
                         ErrorObject{file.string()},
                         "\": times must ascend, but ",
                         ErrorValue{row[0]},
                         " s follows ",
                         y.times.back(),
                         " s."};
    y.times.push_back(row[0]);
    y.values.push_back(row[1]);
  }
  return y;
}

double error_of(ExternalResult const& result, EqualErrorReport const& r, fs::path const& file) {
  if (result.error) return *result.error;
  for (std::size_t k = 0; k < r.references.size(); ++k) {
    if (r.references[k].model != result.model) continue;
    fs::path const of_history = file.parent_path() / result.history;
    OutputHistory const y = history_of(of_history);
    double const off = 1e-9 * (r.times.back() - r.times.front());
    if (y.times.front() > r.times.front() + off || y.times.back() < r.times.back() - off)
      throw InvalidInput{"file \"",
                         ErrorObject{of_history.string()},
                         "\": the history covers ",
                         y.times.front(),
                         " to ",
                         y.times.back(),
                         " s, but the run ",
                         r.times.front(),
                         " to ",
                         r.times.back(),
                         " s."};
    double error = 0.0;
    for (std::size_t i = 0; i < r.times.size(); ++i)
      error = std::max(error, std::abs(y(r.times[i]) - r.reference(k)[i]));
    return error / r.span;
  }
  std::string models;
  for (ModelReference const& reference : r.references) models += (models.empty() ? "" : ", ") + reference.model;
  throw InvalidInput{"file \"",
                     ErrorObject{file.string()},
                     "\", line ",
                     result.line,
                     ": there is no reference of the "
                     "physical model \"",
                     result.model,
                     "\". The models of this problem are: ",
                     models,
                     "."};
}

// Least processor time of the study with at most this error, relative to the span; NaN if no run has it.
double fastest(EqualErrorReport const& r, double error) {
  double least = std::numeric_limits<double>::quiet_NaN();
  for (StudiedFormulation const& f : r.formulations)
    for (StudyRun const& run : f.runs)
      if (run.error <= error * r.span && !(run.cpu >= least)) least = run.cpu;
  return least;
}

bool is_here(ExternalRun const& run, OtherPrograms const& others) {
  return !others.machine.empty() && run.result.machine == others.machine;
}

// Curves of the results with a time that `select` accepts, one for each program and machine. The first one has the
// number `key`.
template <class Select>
std::vector<polybody::detail::ChartCurve> curves(OtherPrograms const& others, std::size_t key, Select const& select) {
  std::vector<polybody::detail::ChartCurve> out;
  for (ExternalRun const& run : others.runs) {
    if (!run.result.time || !select(run)) continue;
    std::string const label = run.result.title(), note = "on " + run.result.machine;
    auto same = std::find_if(out.begin(), out.end(),
                             [&](auto const& curve) { return curve.label == label && curve.note == note; });
    if (same == out.end()) {
      polybody::detail::ChartCurve curve{
          .label = label, .note = note, .key = key + out.size(), .style = formulation_style(families::other)};
      curve.style.colour = int(out.size() % polybody::detail::palette.size());
      out.push_back(std::move(curve));
      same = out.end() - 1;
    }
    same->points.push_back({.x = run.error, .y = *run.result.time, .title = label + ", " + run.result.setting.value});
  }
  return out;
}

std::string colour_rule(polybody::detail::ChartCurve const& curve) {
  return ".f" + std::to_string(curve.key) + " { color: " + std::string(curve.style.rgb()) + "; }\n";
}

}  // namespace

std::vector<ExternalRun> runs_of(std::vector<ExternalResult> const& results, Problem const& problem,
                                 EqualErrorReport const& report, fs::path const& file) {
  std::vector<ExternalRun> out;
  for (ExternalResult const& result : results)
    if (result.problem.value == problem.name) out.push_back({result, error_of(result, report, file)});
  return out;
}

Table external_table(OtherPrograms const& others, EqualErrorReport const& r) {
  Table t{"Other programs",
          "Results of other programs.\nA time from another machine is not ranked.",
          {"program", "setting", "error / span", "time [s]", "machine", "ratio to the fastest"},
          2};
  for (ExternalRun const& run : others.runs) {
    ExternalResult const& result = run.result;
    std::string ratio = result.time ? "not ranked" : "–";
    if (double const least = fastest(r, run.error); result.time && is_here(run, others) && least > 0.0)
      ratio = number(*result.time / least, 2);
    t.rows.push_back({Cell::of(result.title()), Cell::of(result.setting), Cell::number(run.error, 2, 0.06 * run.error),
                      Cell::time(result.time ? number(*result.time, 3) : "–"),
                      Cell::time(result.machine.empty() ? "–" : result.machine), Cell::time(ratio)});
  }
  return t;
}

void write_external_page(OtherPrograms const& others, Problem const& problem, EqualErrorReport const& r,
                         fs::path const& file) {
  using namespace polybody::detail;
  std::size_t const own = r.formulations.size();
  EqualErrorCharts const charts(r);
  Chart here = charts.work();
  std::vector<ChartCurve> const same =
      curves(others, own, [&](ExternalRun const& run) { return is_here(run, others); });
  here.title = "This study, and other programs on its machine";
  Chart apart{.id = "apart",
              .title = "Other machines",
              .note = "Times from other machines are not comparable with those of the other chart.",
              .x_label = "error / span [1]",
              .y_label = "processor time [s]",
              .log_x = true,
              .log_y = true};
  apart.curves = curves(others, own + same.size(), [&](ExternalRun const& run) { return !is_here(run, others); });
  std::string colours;
  for (std::size_t i = 0; i < own; ++i)
    colours += ".f" + std::to_string(i) + " { color: " + std::string(charts.style(i).rgb()) + "; }\n";
  for (ChartCurve const& curve : same) {
    here.curves.push_back(curve);
    colours += colour_rule(curve);
  }
  for (ChartCurve const& curve : apart.curves) colours += colour_rule(curve);
  std::string const title = html_escaped(problem.title + ": other programs");
  std::string text = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" + title +
                     "</title>\n<style>" + std::string(page_style) + colours +
                     "</style>\n</head>\n<body>\n<header>\n<h1>" + title +
                     "</h1>\n</header>\n<main>\n<div class=\"grid\">\n" + ChartDrawing(here).html() +
                     (apart.curves.empty() ? "" : ChartDrawing(apart).html()) + "</div>\n<table>\n<tr>";
  Table const table = external_table(others, r);
  for (std::string const& head : table.heads) text += "<th>" + html_escaped(head) + "</th>";
  for (auto const& row : table.rows) {
    text += "</tr>\n<tr>";
    for (Cell const& cell : row) text += "<td>" + html_escaped(cell.text) + "</td>";
  }
  AtomicFile out(file);
  out.write(text + "</tr>\n</table>\n</main>\n</body>\n</html>\n");
  out.close();
}

}  // namespace atlas
