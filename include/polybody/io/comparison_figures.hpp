#pragma once
/// \file
/// Figures of a comparison's report: outputs and their differences, constraint violations and computing time.

#include <algorithm>
#include <functional>
#include <limits>

#include <polybody/compare/comparison.hpp>
#include <polybody/io/figure.hpp>
#include <polybody/io/formulation_style.hpp>

namespace polybody {

/// Colour of each run in figures, an index into the colours of plot.hpp. It is the colour of the run's family of bodies
/// (`formulation_style`) or, if two runs share one, of its policy (`policy_colours`). If two policies also share a
/// colour, or if a colour is unknown, the runs have the colours 0, 1, 2, ….
template <class = void>
std::vector<int> formulation_colours(Comparison const& c) {
  auto const colours = [&](auto const& of) {
    std::vector<int> all;
    for (ComparedRun const& run : c.runs)
      if (int const colour = of(run); colour >= 0 && std::ranges::find(all, colour) == all.end()) all.push_back(colour);
    return all;
  };
  std::vector<int> found = colours([](ComparedRun const& run) { return formulation_style(run.family).colour; });
  if (found.size() < c.runs.size())
    found = colours([](ComparedRun const& run) { return formulation_colour(run.policy); });
  if (found.size() < c.runs.size()) {
    found.clear();
    for (std::size_t i = 0; i < c.runs.size(); ++i) found.push_back(int(i));
  }
  return found;
}

namespace detail {

/// Figure of `value(run, k)`, k = 0, 1, …, over `run.times`, with one curve per run. The curve of the first run is
/// thick; the others are dashed lines over this curve.
template <class = void>
Figure over_time(Comparison const& c, std::string const& title, std::string const& y_label,
                 std::function<double(ComparedRun const&, std::size_t)> const& value) {
  Figure figure{.title = title, .x_label = "t [s]", .y_label = y_label, .width_px = 900, .height_px = 560};
  std::vector<int> const colours = formulation_colours(c);
  for (std::size_t i = 0; i < c.runs.size(); ++i) {
    ComparedRun const& run = c.runs[i];
    Curve curve{.x = run.times, .label = run.name, .colour = colours[i]};
    curve.style = i == 0 ? "lines" : "dashed";
    curve.width = i == 0 ? 3.0 : 1.5;
    for (std::size_t k = 0; k < run.times.size(); ++k) curve.y.push_back(value(run, k));
    figure.curves.push_back(std::move(curve));
  }
  return figure;
}

/// Adds a figure of the constraint violations over time, on a logarithmic axis, for the runs with a positive violation.
/// Adds no figure if there is no such run. Violations below the limit 1e-16 are drawn at the limit; if no violation
/// exceeds 1e-16, the limit is 1e-6 of the largest violation. Zeros are omitted.
template <class = void>
void add_violations(Comparison const& c, std::string const& title, std::string const& units, double Violation::* level,
                    std::vector<Figure>& figures) {
  Figure figure = over_time(c, title, "largest violation " + units,
                            [level](ComparedRun const& run, std::size_t k) { return run.violations[k].*level; });
  figure.log_y = true;
  auto const largest = [](Curve const& curve) { return *std::max_element(curve.y.begin(), curve.y.end()); };
  std::erase_if(figure.curves, [&](Curve const& curve) { return !(largest(curve) > 0.0); });
  if (figure.curves.empty()) return;
  double all = 0.0;
  for (Curve const& curve : figure.curves) all = std::max(all, largest(curve));
  double const limit = all > 1e-16 ? 1e-16 : 1e-6 * all;
  for (Curve& curve : figure.curves)
    for (double& y : curve.y)
      if (y > 0.0) y = std::max(y, limit);
  figures.push_back(std::move(figure));
}

/// Output i of the first run at time t [s].
template <class = void>
double first_output(Comparison const& c, std::size_t i, double t) {
  return interpolate(c.runs.front().times, c.runs.front().outputs[i], t);
}

/// Unit with brackets at the end of an output's name, "[m]" for "tip x [m]"; empty if the name has no unit.
template <class = void>
std::string_view unit_in(std::string_view name) {
  std::size_t const unit = name.rfind(" [");
  return unit == name.npos || !name.ends_with(']') ? std::string_view() : name.substr(unit + 1);
}

/// Largest minus smallest value of output i in the first run, or the magnitude of a constant output.
template <class = void>
double own_span(Comparison const& c, std::size_t i) {
  auto const [low, high] = std::ranges::minmax(c.runs.front().outputs[i]);
  return high > low ? high - low : std::abs(high);
}

/// Reference span for differences of output i: the greater of its `own_span` and 1 % of the largest `own_span` of
/// outputs with the same unit. The second value prevents large relative differences of an output that is only
/// round-off.
template <class = void>
double measure_of(Comparison const& c, std::size_t i) {
  std::vector<std::string> const& names = c.runs.front().output_names;
  double span = own_span(c, i);
  for (std::size_t k = 0; k < names.size(); ++k)
    if (!unit_in(names[i]).empty() && unit_in(names[k]) == unit_in(names[i]))
      span = std::max(span, 1e-2 * own_span(c, k));
  return span;
}

/// Largest difference of output i between a run and the first run, relative to `measure_of`. Infinite if `measure_of`
/// is zero and the difference is not.
template <class = void>
double relative_difference(Comparison const& c, ComparedRun const& run, std::size_t i) {
  double const most = run.difference[i], span = measure_of(c, i);
  return most == 0.0 ? 0.0 : span > 0.0 ? most / span : std::numeric_limits<double>::infinity();
}

/// Indices of the outputs, in descending order of their largest relative difference from the first run.
template <class = void>
std::vector<std::size_t> outputs_by_difference(Comparison const& c) {
  std::vector<double> most(c.runs.front().outputs.size(), 0.0);
  std::vector<std::size_t> order(most.size());
  for (std::size_t i = 0; i < most.size(); ++i) {
    order[i] = i;
    for (ComparedRun const& run : c.runs) most[i] = std::max(most[i], relative_difference(c, run, i));
  }
  std::ranges::stable_sort(order, [&](std::size_t i, std::size_t j) { return most[i] > most[j]; });
  return order;
}

/// Largest magnitude of a curve's values.
template <class = void>
double largest_amount(Curve const& curve) {
  double most = 0.0;
  for (double const y : curve.y) most = std::max(most, std::abs(y));
  return most;
}

/// Mean square of a curve's values.
template <class = void>
double mean_square(Curve const& curve) {
  double sum = 0.0;
  for (double const y : curve.y) sum += y * y;
  return sum / double(curve.y.size());
}

/// Converts the curves of a figure to magnitudes on a logarithmic axis, and removes curves whose values are all zero.
/// `least` is the smallest positive `largest_amount` of the curves. Magnitudes below 1e-3·`least` are drawn at
/// 1e-3·`least`.
template <class = void>
void show_amounts(Figure& figure, double least) {
  figure.log_y = true;
  figure.y_label = "magnitude of the " + figure.y_label;
  std::erase_if(figure.curves, [](Curve const& curve) { return !(largest_amount(curve) > 0.0); });
  for (Curve& curve : figure.curves)
    for (double& y : curve.y) y = std::max(std::abs(y), 1e-3 * least);
}

/// Figure of the differences of output i from the first run. Curves are drawn in descending order of their mean square,
/// so that large differences do not hide small ones. The figure shows magnitudes on a logarithmic axis if the largest
/// difference of one run is more than 100 times that of another run.
template <class = void>
Figure difference_figure(Comparison const& c, std::size_t i) {
  std::string const &name = c.runs.front().output_names[i], unit(unit_in(name));
  Figure off = over_time(c, name + ", difference from \"" + c.runs.front().name + "\"",
                         (unit.empty() ? "difference" : "difference " + unit), [&](auto const& run, std::size_t k) {
                           return run.outputs[i][k] - first_output(c, i, run.times[k]);
                         });
  off.curves.erase(off.curves.begin());
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (Curve& curve : off.curves) {
    curve.style = "lines";
    double const amount = largest_amount(curve);
    most = std::max(most, amount);
    if (amount > 0.0) least = std::min(least, amount);
  }
  std::ranges::stable_sort(off.curves, [](Curve const& a, Curve const& b) { return mean_square(a) > mean_square(b); });
  if (most > 100.0 * least) show_amounts(off, least);
  return off;
}

/// Figure of each output over time. If there are several runs, a figure of the differences from the first run
/// follows, since curves that agree hide one another.
template <class = void>
std::vector<Figure> output_figures(Comparison const& c) {
  std::vector<Figure> figures;
  for (std::size_t const i : outputs_by_difference(c)) {
    std::string const& name = c.runs.front().output_names[i];
    figures.push_back(over_time(c, name, name, [i](auto const& run, std::size_t k) { return run.outputs[i][k]; }));
    if (c.runs.size() > 1) figures.push_back(difference_figure(c, i));
  }
  return figures;
}

/// Adds a vertical line at the computing time of the first run, behind the points of the other runs. The time axis is
/// logarithmic if the times span more than a factor of 10.
template <class = void>
void add_first_cost(ComparedRun const& first, int colour, Figure& figure) {
  double low = std::numeric_limits<double>::infinity(), high = 0.0, soonest = first.cpu, latest = soonest;
  for (Curve const& curve : figure.curves) {
    low = std::min(low, curve.y[0]);
    high = std::max(high, curve.y[0]);
    soonest = std::min(soonest, curve.x[0]);
    latest = std::max(latest, curve.x[0]);
  }
  figure.log_x = soonest > 0.0 && latest > 10.0 * soonest;
  if (!figure.log_x) figure.x_range = {{0.0, 1.1 * latest}};
  if (first.cpu > 0.0)
    figure.curves.insert(figure.curves.begin(), {.x = {first.cpu, first.cpu},
                                                 .y = {0.5 * low, 2.0 * high},
                                                 .label = first.name,
                                                 .style = "dashed",
                                                 .colour = colour});
}

/// Figure of the largest relative difference of each run from the first run, over the CPU time of the run. Returns no
/// figure if no run differs.
template <class = void>
std::vector<Figure> cost_figure(Comparison const& c) {
  ComparedRun const& first = c.runs.front();
  Figure figure{.title = "Largest difference from \"" + first.name + "\", and CPU time",
                .x_label = "CPU time [s]",
                .y_label = "difference / span of the output",
                .log_y = true,
                .width_px = 900,
                .height_px = 560};
  std::vector<int> const colours = formulation_colours(c);
  for (std::size_t k = 1; k < c.runs.size(); ++k) {
    double most = 0.0;
    for (std::size_t i = 0; i < first.outputs.size(); ++i)
      if (double const off = relative_difference(c, c.runs[k], i); std::isfinite(off)) most = std::max(most, off);
    if (most > 0.0 && c.runs[k].cpu > 0.0)
      figure.curves.push_back({.x = {c.runs[k].cpu},
                               .y = {most},
                               .label = c.runs[k].name,
                               .style = "points",
                               .colour = colours[k],
                               .width = 3.0});
  }
  if (figure.curves.empty()) return {};
  add_first_cost(first, colours.front(), figure);
  return {std::move(figure)};
}

}  // namespace detail

}  // namespace polybody
