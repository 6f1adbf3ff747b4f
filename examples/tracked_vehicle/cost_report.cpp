#include <polybody/io/csv.hpp>

#include "cost.hpp"
#include "measures.hpp"

namespace chapter3 {

using combinations::Cells;

namespace {

// The cheapest run of a curve for a wanted error.
struct Cheapest {
  CostCurve const* curve;
  CostRun const* run;
};

// Reason why a curve has no rank at the error `wanted` [1]; empty if `best` is its cheapest run.
std::string find_cheapest(CostStudy const& study, CostCurve const& curve, double wanted, CostRun const*& best) {
  ConvergedPins const& pins = study.pins[curve.pins];
  if (!pins.failure.empty()) return "no converged force: " + pins.failure;
  if (pins.resolution() > 0.5 * wanted)
    return "errors below " + number(1e2 * pins.resolution(), 2) + " % are not resolved";
  for (CostRun const& run : curve.runs)
    if (run.failure.empty() && run.error <= wanted && (!best || run.median() < best->median())) best = &run;
  return best ? "" : "no run reaches this error";
}

Cells cells(CostStudy const& study, Cheapest const& at, Cheapest const* ideal) {
  auto const text = [](double x) { return number(x, 3); };
  CostRun const& run = *at.run;
  double const steps = double(std::max(run.counts.steps, 1L));
  return {study.pins[at.curve->pins].name,
          at.curve->integrator,
          at.curve->setting(run),
          text(run.median()),
          text(run.cpu.front()),
          text(run.cpu.back()),
          ideal ? text(run.median() / ideal->run->median()) : "-",
          text(1e2 * run.error),
          std::to_string(run.counts.steps),
          text(double(run.counts.iterations) / steps),
          text(double(run.counts.factorisations) / steps)};
}

void print_ranking(CostStudy const& study, double wanted) {
  std::vector<Cheapest> ranked;
  std::vector<std::string> others;
  for (CostCurve const& curve : study.curves) {
    CostRun const* best = nullptr;
    std::string const reason = find_cheapest(study, curve, wanted, best);
    if (best)
      ranked.push_back({&curve, best});
    else
      others.push_back(study.pins[curve.pins].name + ", " + curve.integrator + ": " + reason);
  }
  std::sort(ranked.begin(), ranked.end(),
            [](Cheapest const& a, Cheapest const& b) { return a.run->median() < b.run->median(); });
  std::cout << "\nError of at most " << number(1e2 * wanted, 3) << " %:\n";
  std::vector<Cells> rows{{"pins", "integrator", "setting", "CPU [s]", "least", "most", "ratio", "error [%]", "steps",
                           "iterations a step", "factorisations a step"}};
  for (Cheapest const& at : ranked) {
    auto const ideal = std::find_if(ranked.begin(), ranked.end(), [&](Cheapest const& other) {
      return other.curve->pins == 0 && other.curve->integrator == at.curve->integrator;
    });
    rows.push_back(cells(study, at, ideal == ranked.end() ? nullptr : &*ideal));
  }
  if (!ranked.empty()) combinations::print(rows, 3);
  for (std::string const& other : others) std::cout << "  " << other << '\n';
}

// Differences between the formulations, and all runs.
void print_lines(CostStudy const& study) {
  Lines lines;
  ConvergedPins const& first = study.reference();
  std::cout << "\nDifferences of the converged forces from those of " << first.name << ":\n";
  for (ConvergedPins const& pins : study.pins) {
    if (!pins.failure.empty()) {
      std::cout << "  " << pins.name << ": " << pins.failure << '\n';
      continue;
    }
    double const bound = first.resolution() + pins.resolution();
    lines("converged, " + pins.name,
          {{"difference", 1e2 * pins.difference, 4, "%"},
           {"bound", 1e2 * bound, 4, "%"},
           {"error bound", 1e2 * pins.bound, -1, "%"},
           {"round-off", 1e2 * pins.spread, -1, "%"}},
          &pins == &first || pins.difference > bound ? "" : "the difference is not resolved");
  }
  std::cout << "\nRuns:\n";
  for (CostCurve const& curve : study.curves)
    for (CostRun const& run : curve.runs) {
      ConvergedPins const& pins = study.pins[curve.pins];
      std::string const name = pins.name + ", " + curve.integrator + ", " + curve.setting(run);
      if (!run.failure.empty()) {
        std::cout << "  " << name << ": " << run.failure << '\n';
        continue;
      }
      double const steps = double(std::max(run.counts.steps, 1L));
      lines("run, " + name,
            {{"error", 1e2 * run.error, -1, "%"},
             {"steps", double(run.counts.steps), 0},
             {"iterations a step", double(run.counts.iterations) / steps, 1},
             {"factorisations a step", double(run.counts.factorisations) / steps, 2},
             {"evaluations a step", double(run.counts.evaluations) / steps, 1},
             {"CPU", run.median(), 3, "s"},
             {"timings", double(run.cpu.size()), 0}},
            run.error > pins.resolution() ? "" : "the error is not resolved");
    }
}

void write_table(CostStudy const& study, fs::path const& file) {
  Csv csv(file, {"pins, integrator", "step [s] or tolerance [1]", "error [1]", "resolution [1]", "CPU [s]",
                 "least CPU [s]", "most CPU [s]", "timings", "steps", "iterations", "factorisations", "evaluations"});
  for (CostCurve const& curve : study.curves)
    for (CostRun const& run : curve.runs) {
      if (!run.failure.empty()) continue;
      ConvergedPins const& pins = study.pins[curve.pins];
      std::vector<double> const row{run.accuracy,
                                    run.error,
                                    pins.resolution(),
                                    run.median(),
                                    run.cpu.front(),
                                    run.cpu.back(),
                                    double(run.cpu.size()),
                                    double(run.counts.steps),
                                    double(run.counts.iterations),
                                    double(run.counts.factorisations),
                                    double(run.counts.evaluations)};
      csv.row(pins.name + ", " + curve.integrator, row);
    }
  csv.close();
  std::cout << "  " << file.string() << '\n';
}

// Colour of pins: of constraint, penalty, bushing and joint coordinates as in all figures of the chapter, of the other
// stiffnesses of penalties one of the remaining colours.
int colour_of(CostStudy const& study, std::size_t k) {
  constexpr std::array<int, 4> others{7, 5, 3, 6};
  LinksOnPins const& links = study.pins[k].links;
  auto const& all = combinations::all_policies;
  if (links.policy != "penalty" || study.pins[k].stiffness == m113::pin_stiffness)
    return int(std::find(all.begin(), all.end(), links.policy) - all.begin());
  std::size_t softer = 0;
  for (std::size_t i = 0; i < k; ++i)
    softer += study.pins[i].links.policy == "penalty" && study.pins[i].stiffness != m113::pin_stiffness;
  return others[softer % others.size()];
}

// Work-precision curves of one integrator. An error that is not resolved is drawn at the resolution.
Figure work_figure(CostStudy const& study, std::string const& integrator) {
  Figure f{.title = integrator,
           .x_label = "error of the 30 Hz force [1]",
           .y_label = "CPU time [s]",
           .log_x = true,
           .log_y = true,
           .width_px = 800,
           .height_px = 560};
  for (CostCurve const& curve : study.curves) {
    if (curve.integrator != integrator) continue;
    ConvergedPins const& pins = study.pins[curve.pins];
    Curve c{.label = pins.name, .style = "linespoints", .colour = colour_of(study, curve.pins)};
    for (CostRun const& run : curve.runs) {
      if (!run.failure.empty() || run.median() <= 0.0) continue;
      c.x.push_back(std::max(run.error, pins.resolution()));
      c.y.push_back(run.median());
    }
    if (!c.x.empty()) f.curves.push_back(c);
  }
  return f;
}

// Whole decades that contain a coordinate of all points.
std::array<double, 2> decades(std::vector<Figure> const& figures, std::vector<double> Curve::* coordinate) {
  double low = std::numeric_limits<double>::infinity(), high = 0.0;
  for (Figure const& f : figures)
    for (Curve const& c : f.curves)
      for (double const x : c.*coordinate) low = std::min(low, x), high = std::max(high, x);
  return {std::pow(10.0, std::floor(std::log10(low) - 1e-9)), std::pow(10.0, std::ceil(std::log10(high) + 1e-9))};
}

// Difference of penalties from the first pins over their stiffness, and its bound.
Figure difference_figure(CostStudy const& study) {
  Figure f{.title = "penalties: difference from " + study.reference().name,
           .x_label = "stiffness of the pins [N/m]",
           .y_label = "difference of the 30 Hz force [1]",
           .log_x = true,
           .log_y = true,
           .width_px = 800,
           .height_px = 560};
  Curve difference{.label = "difference", .style = "linespoints", .colour = 1},
      bound{.label = "bound", .style = "dashed", .colour = 6};
  for (ConvergedPins const& pins : study.pins) {
    if (pins.links.policy != "penalty" || !pins.failure.empty() || pins.difference <= 0.0) continue;
    for (Curve* const c : {&difference, &bound}) c->x.push_back(pins.stiffness);
    difference.y.push_back(pins.difference);
    bound.y.push_back(study.reference().resolution() + pins.resolution());
  }
  if (difference.x.empty()) return f;
  auto const [softest, stiffest] = std::minmax_element(difference.x.begin(), difference.x.end());
  f.x_range = {{0.5 * *softest, 2.0 * *stiffest}};
  f.curves = {difference, bound};
  return f;
}

void draw(Options const& o, CostStudy const& study) {
  std::vector<Figure> figures;
  std::vector<std::string> drawn;
  for (CostCurve const& curve : study.curves) {
    if (combinations::is_among(curve.integrator, drawn)) continue;
    drawn.push_back(curve.integrator);
    figures.push_back(work_figure(study, curve.integrator));
  }
  std::erase_if(figures, [](Figure const& f) { return f.curves.empty(); });
  if (figures.empty()) return;
  auto const x = decades(figures, &Curve::x), y = decades(figures, &Curve::y);
  for (Figure& f : figures) f.x_range = x, f.y_range = y;
  if (Figure const f = difference_figure(study); !f.curves.empty()) figures.push_back(f);
  write_panels(figures, 2, o.out / "cost", !o.no_plot);
  std::cout << "  " << (o.out / "cost").string() << (o.no_plot ? ".gp" : ".png") << '\n';
}

}  // namespace

void report(Options const& o, CostStudy const& study) {
  std::cout << "Cost of the pins at equal error of the force in pin " << watched_pin << ", low-passed at "
            << number(force_cut_off) << " Hz, 0 to " << number(o.end_time)
            << " s.\nerror: root mean square difference from the converged run with the same pins, relative to the "
               "force.\nratio: CPU time divided by that of "
            << study.pins.front().name << " by the same integrator.\n";
  for (double const wanted : study.errors) print_ranking(study, wanted);
  print_lines(study);
  for (std::string const& refusal : study.refusals) std::cout << "  " << refusal << '\n';
  write_table(study, o.out / "cost.csv");
  draw(o, study);
}

}  // namespace chapter3
