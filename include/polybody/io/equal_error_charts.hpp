#pragma once
/// \file
/// Charts of a comparison at equal error: work and precision, convergence, differences of physical models, energy.

#include <polybody/compare/equal_error_report.hpp>
#include <polybody/io/svg_chart.hpp>

namespace polybody::detail {

/// Mesh of a run: "20 elements", or an empty text for a body without mesh.
template <class = void>  // compiled where it is used
std::string mesh_text(StudiedFormulation const& f, StudyRun const& run) {
  return f.mesh_name.empty() ? std::string() : std::to_string(run.mesh) + std::string(no_break) + f.mesh_name;
}
/// Step of a run: "h = 0.0025 s" or "tolerance 10⁻⁶".
template <class = void>
std::string step_text(StudiedFormulation const& f, StudyRun const& run) {
  return f.step_name == "tolerance" ? "tolerance\u00A0" + short_text(run.step)
                                    : "h\u00A0=\u00A0" + short_text(run.step) + "\u00A0s";
}
/// Mesh and step of a run.
template <class = void>
std::string setting_text(StudiedFormulation const& f, StudyRun const& run) {
  std::string const mesh = mesh_text(f, run);
  return (mesh.empty() ? mesh : mesh + ", ") + step_text(f, run);
}
/// Unit of the output without brackets, after a space: " m"; empty if the output has no unit.
template <class = void>
std::string unit_after_number(EqualErrorReport const& r) {
  std::string const unit = r.unit();
  return unit.size() > 2 ? std::string(no_break) + unit.substr(1, unit.size() - 2) : std::string();
}
/// Percentage of the span, such as "0.03 %".
template <class = void>
std::string percent_text(double share, int digits = 3) {
  return short_text(100.0 * share, digits) + "\u00A0%";
}

/// Charts of a report. Each formulation has one style in all charts.
class EqualErrorCharts {
 public:
  /// Charts of the report `r`, which must outlive this object. A formulation with the style of an earlier one has
  /// another line pattern.
  explicit EqualErrorCharts(EqualErrorReport const& r) : r_(r), unit_(unit_after_number(r)) {
    static constexpr std::string_view further[] = {"5 4", "10 4 2 4", "1.5 4", "12 2 2 2 2 2"};
    for (StudiedFormulation const& f : r.formulations) {
      FormulationStyle style = formulation_style(f.family, f.policy);
      auto const taken = [&](FormulationStyle const& other) {
        return other.colour == style.colour && other.marker == style.marker && other.dash == style.dash;
      };
      for (std::string_view const dash : further)
        if (std::any_of(styles_.begin(), styles_.end(), taken)) style.dash = dash;
      styles_.push_back(style);
    }
  }

  FormulationStyle const& style(std::size_t i) const { return styles_[i]; }  ///< style of formulation i

  /// CPU time over the discretisation error of all runs. The runs of the Pareto front of a formulation have strong
  /// markers and are joined by a line. The runs of the front of all formulations have rings.
  Chart work() const {
    Chart chart{
        .id = "work",
        .title = "CPU time over discretisation error",
        .note =
            "Each marker is a run. A line joins the best runs of a formulation: none of its other runs has both a "
            "smaller error and a smaller CPU time. Rings mark the best runs of all formulations.",
        .x_label = "discretisation error / span [1]",
        .y_label = "CPU time [s]",
        .log_x = true,
        .log_y = true};
    for (std::size_t i = 0; i < r_.formulations.size(); ++i) {
      StudiedFormulation const& f = r_.formulations[i];
      ChartCurve curve{.label = f.name, .note = f.integrator, .key = i, .style = styles_[i]};
      std::vector<std::pair<double, double>> front;
      for (StudyRun const& run : f.runs) {
        if (!drawn(run)) continue;
        bool const best = on_own_front(f, run);
        if (best) front.emplace_back(run.error / r_.span, run.cpu);
        ChartPoint point{
            .x = run.error / r_.span, .y = run.cpu, .title = title_of(f, run), .strong = best, .ringed = run.on_front};
        if (run.timings > 1) point.least = run.least_cpu, point.most = run.most_cpu;
        curve.points.push_back(std::move(point));
      }
      std::sort(front.begin(), front.end());
      for (auto const& [error, cpu] : front) {
        curve.x.push_back(error);
        curve.y.push_back(cpu);
      }
      if (!curve.points.empty()) chart.curves.push_back(std::move(curve));
    }
    for (Ranking const& ranking : r_.rankings)
      chart.guides.push_back({ranking.wanted, true, "wanted error: " + percent_text(ranking.wanted) + " of the span"});
    add_bounds(chart, true);
    return chart;
  }

  /// Discretisation error over the mesh with the shortest step, one chart for elements and one for modes.
  std::vector<Chart> convergence_over_mesh() const {
    std::vector<Chart> charts;
    for (std::string const axis : {"elements", "modes"}) {
      Chart chart{.id = "error-over-" + axis,
                  .title = "Error over the number of " + axis,
                  .note = "Runs with the shortest step.",
                  .x_label = "number of " + axis + " [1]",
                  .y_label = "discretisation error / span [1]"};
      add_convergence(chart, [&](StudiedFormulation const& f, StudyRun const& run) {
        return f.mesh_name == axis && run.step == f.finest().step ? double(run.mesh) : 0.0;
      });
      if (!chart.curves.empty()) charts.push_back(std::move(chart));
    }
    return charts;
  }

  /// Discretisation error over the step with the finest mesh, one chart for steps and one for tolerances.
  std::vector<Chart> convergence_over_step() const {
    std::vector<Chart> charts;
    for (bool const controlled : {false, true}) {
      Chart chart{.id = controlled ? "error-over-tolerance" : "error-over-step",
                  .title = controlled ? "Error over the tolerance" : "Error over the step",
                  .note = "Runs with the finest mesh.",
                  .x_label = controlled ? "relative tolerance [1]" : "step [s]",
                  .y_label = "discretisation error / span [1]"};
      add_convergence(chart, [&](StudiedFormulation const& f, StudyRun const& run) {
        return (f.step_name == "tolerance") == controlled && run.mesh == f.finest().mesh ? run.step : 0.0;
      });
      if (!chart.curves.empty()) charts.push_back(std::move(chart));
    }
    return charts;
  }

  /// References of the physical models over time, with bands of their error bounds.
  Chart output() const {
    Chart chart{.id = "output",
                .title = "References of the output",
                .note = "Extrapolated results of the physical models. The half width of a band is the error bound.",
                .x_label = "time [s]",
                .y_label = r_.output};
    for (std::size_t k = 0; k < r_.references.size(); ++k) {
      ModelReference const& reference = r_.references[k];
      StudiedFormulation const& f = r_.formulations[reference.formulation];
      chart.curves.push_back(over_time(
          reference.formulation, reference.model,
          f.name + ", extrapolated from " + setting_text(f, f.finest()) + ", " + f.integrator, r_.reference(k), unit_));
      chart.curves.back().band = reference.error;
    }
    return chart;
  }

  /// Differences between the references over time, with bands of their error bounds. Up to six pairs share one chart;
  /// otherwise each physical model has a chart with its differences from the later ones.
  std::vector<Chart> differences() const {
    std::vector<Chart> charts;
    bool const together = r_.differences.size() <= 6;
    for (ModelDifference const& d : r_.differences) {
      std::string const id = together ? "differences" : "differences-" + std::to_string(d.a + 1);
      if (charts.empty() || charts.back().id != id)
        charts.push_back(
            {.id = id,
             .title =
                 together ? "Differences of the references" : "Differences from “" + r_.references[d.a].model + "”",
             .note = "The half width of a band is the error bound. The two colours of a curve are those of the "
                     "formulations that provide the references.",
             .x_label = "time [s]",
             .y_label = "difference " + r_.unit()});
      charts.back().curves.push_back(difference(d));
    }
    return charts;
  }

  /// Total energy over time of the finest run of each formulation.
  Chart energy() const {
    Chart chart{.id = "energy",
                .title = "Total energy of the finest runs",
                .note = "Kinetic and potential energy of each formulation with its finest mesh and shortest step.",
                .x_label = "time [s]",
                .y_label = "total energy [J]"};
    for (std::size_t i = 0; i < r_.formulations.size(); ++i) {
      StudiedFormulation const& f = r_.formulations[i];
      if (!f.runs.empty() && !f.finest().energy.empty())
        chart.curves.push_back(
            over_time(i, f.name, setting_text(f, f.finest()) + ", " + f.integrator, f.finest().energy, " J"));
    }
    return chart;
  }

 private:
  bool drawn(StudyRun const& run) const {
    return run.error > 0.0 && run.cpu > 0.0 && std::isfinite(run.error / r_.span);
  }
  /// True if no other run of the formulation is better in error or CPU time, and at least equal in the other.
  bool on_own_front(StudiedFormulation const& f, StudyRun const& run) const {
    return std::none_of(f.runs.begin(), f.runs.end(), [&](StudyRun const& other) {
      return drawn(other) && other.error <= run.error && other.cpu <= run.cpu &&
             (other.error < run.error || other.cpu < run.cpu);
    });
  }

  std::string title_of(StudiedFormulation const& f, StudyRun const& run) const {
    return f.name + "\n" + setting_text(f, run) + ", " + f.integrator + "\nerror " + percent_text(run.error / r_.span) +
           " of the span (" + readable(run.error) + unit_ + ")\nCPU time " + readable(run.cpu) + " s";
  }

  /// Adds the curves of the runs for which `size(f, run)` is positive, over this size. The legend contains the order.
  template <class Size>
  void add_convergence(Chart& chart, Size const& size) const {
    chart.log_x = chart.log_y = true;
    bool const of_mesh = chart.id == "error-over-elements" || chart.id == "error-over-modes";
    for (std::size_t i = 0; i < r_.formulations.size(); ++i) {
      StudiedFormulation const& f = r_.formulations[i];
      double const order = of_mesh ? f.mesh_order : f.step_order;
      ChartCurve curve{.label = f.name, .key = i, .style = styles_[i]};
      for (StudyRun const& run : f.runs)
        if (double const x = size(f, run); x > 0.0 && run.error > 0.0 && std::isfinite(run.error / r_.span)) {
          curve.x.push_back(x);
          curve.y.push_back(run.error / r_.span);
          curve.points.push_back({.x = x, .y = run.error / r_.span, .title = title_of(f, run)});
        }
      if (curve.x.empty()) continue;
      std::string const fixed = of_mesh ? step_text(f, f.finest()) : mesh_text(f, f.finest());
      curve.note = (std::isfinite(order) ? "order " + fixed_text(order, 1) : std::string("no order observed")) +
                   (fixed.empty() ? "" : ", " + fixed) + ", " + f.integrator;
      chart.x_marks.insert(chart.x_marks.end(), curve.x.begin(), curve.x.end());
      chart.curves.push_back(std::move(curve));
    }
    add_bounds(chart, false);
  }

  /// Adds lines at the error bounds of the references, and at the changes by round-off, for the formulations of a
  /// chart.
  void add_bounds(Chart& chart, bool vertical) const {
    auto const add = [&](double bound, std::string const& what, std::size_t i) {
      double const share = bound / r_.span;
      if (share > 0.0 && std::isfinite(share))
        chart.guides.push_back({share, vertical, what + ": " + percent_text(share) + " of the span", i});
    };
    for (ModelReference const& reference : r_.references)
      if (std::any_of(chart.curves.begin(), chart.curves.end(),
                      [&](ChartCurve const& c) { return r_.formulations[c.key].model == reference.model; }))
        add(reference.error, "error bound of the reference of “" + reference.model + "”", reference.formulation);
    for (ChartCurve const& c : chart.curves)
      add(r_.formulations[c.key].spread, r_.formulations[c.key].name + ", change by round-off", c.key);
    chart.note +=
        std::string(vertical ? " A dashed line is a wanted error." : "") +
        " A dotted line is the error bound of a reference, or a change by round-off. Smaller errors are uncertain.";
  }

  /// Curve of a history with a few markers, at places that differ between formulations.
  ChartCurve over_time(std::size_t i, std::string label, std::string note, std::vector<double> const& y,
                       std::string const& unit) const {
    ChartCurve curve{
        .label = std::move(label), .note = std::move(note), .key = i, .style = styles_[i], .x = r_.times, .y = y};
    std::size_t const n = std::min(r_.times.size(), y.size());
    for (int k = 0; k < 6 && n > 0; ++k) {
      double const share = (k + (double(i) + 0.5) / double(r_.formulations.size())) / 6.0;
      std::size_t const at = std::min(n - 1, std::size_t(share * double(n)));
      if (!std::isfinite(y[at])) continue;
      curve.points.push_back({.x = r_.times[at],
                              .y = y[at],
                              .title = curve.label + ", " + curve.note + "\nt = " + short_text(r_.times[at], 4) +
                                       " s: " + readable(y[at], 4) + unit});
    }
    return curve;
  }

  ChartCurve difference(ModelDifference const& d) const {
    std::size_t const i = r_.references[d.a].formulation, j = r_.references[d.b].formulation;
    ChartCurve curve{.label = r_.references[d.a].model + " − " + r_.references[d.b].model,
                     .key = i,
                     .style = styles_[i],
                     .x = r_.times,
                     .band = d.error};
    curve.note = (d.resolved() ? "largest difference " + readable(d.difference) + unit_ : std::string("not resolved")) +
                 ", error bound " + readable(d.error) + unit_;
    if (styles_[i].rgb() == styles_[j].rgb())
      curve.style.dash = "9 5";
    else
      curve.second = j;
    for (std::size_t k = 0; k < r_.times.size(); ++k) curve.y.push_back(r_.reference(d.a)[k] - r_.reference(d.b)[k]);
    return curve;
  }

  EqualErrorReport const& r_;
  std::string unit_;
  std::vector<FormulationStyle> styles_;
};

}  // namespace polybody::detail
