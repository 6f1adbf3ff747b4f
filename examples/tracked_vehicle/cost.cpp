#include "cost.hpp"

#include "measures.hpp"

namespace chapter3 {

using combinations::Selection;

namespace {

constexpr double sampled = 1.25e-4;       // shortest sampling interval of a recorded run [s]
constexpr int repeats = 3;                // number of timed runs
constexpr double longest_repeated = 2.0;  // CPU time of the longest run that is timed more than once [s]

// Difference of the 30 Hz force over the whole run, relative to the force of `first` [1].
double difference(Runs const& first, Runs const& second, double end) {
  return force_difference(first, 0, second, 0, {"joint force x [N]", "joint force z [N]"}, {0.0, end});
}

// Options of a run with this step [s] or tolerance [1].
Options with_accuracy(Options o, Combination const& c, double accuracy) {
  o.default_step = false;
  if (has_step_control(c)) {
    o.tolerance = accuracy;
    o.step = 1.5 * sampled;  // longest step; states are interpolated over at most 2.5 sampling intervals
    o.sampling = sampled;
  } else {
    o.step = accuracy;
    o.sampling = std::max(accuracy, sampled);
  }
  return o;
}

// Runs the pins. Throws InvalidInput if an event ends the run early.
Runs run_pins(Options const& o, ConvergedPins const& pins, Combination const& c) {
  Runs runs = Pins{pins.name, c, pins.stiffness}.run(o);
  if (RunReport const& report = runs.comparison.runs[0].run; report.stopped)
    throw InvalidInput{"\"",       ErrorObject{pins.name},
                       "\": ",     report.events.back().name,
                       " at t = ", ErrorTime{report.events.back().time},
                       " s."};
  return runs;
}

void converge(ConvergedPins& pins, Options const& o) try {
  Combination const alpha{pins.links, 0};
  double const shortest = o.selection.steps.back();
  Options const fine = with_accuracy(o, alpha, 0.25 * shortest);
  Options perturbed = fine;
  perturbed.preload = std::nextafter(o.preload, std::numeric_limits<double>::infinity());
  pins.run = run_pins(fine, pins, alpha);
  pins.bound = difference(pins.run, run_pins(with_accuracy(o, alpha, 0.5 * shortest), pins, alpha), o.end_time);
  pins.spread = difference(pins.run, run_pins(perturbed, pins, alpha), o.end_time);
} catch (Error const& e) {
  pins.failure = e.what();
}

// Steps of the study, or tolerances, or stable steps of the Runge–Kutta method if no steps are selected.
std::vector<double> accuracies(Options const& o, Combination const& c, bool default_steps) {
  double const stable = c.links.stable_step;
  if (has_step_control(c)) return o.selection.tolerances;
  if (default_steps && integrator_name(c) == "runge-kutta") return {stable, 0.5 * stable, 0.25 * stable};
  return o.selection.steps;
}

void record(CostRun& run, CostCurve const& curve, ConvergedPins const& pins, Options const& o) try {
  Runs const runs = run_pins(with_accuracy(o, curve.combination, run.accuracy), pins, curve.combination);
  ComparedRun const& one = runs.comparison.runs[0];
  run.counts = one.run;
  run.cpu = {one.cpu};
  run.error = difference(runs, pins.run, o.end_time);
} catch (Error const& e) {
  run.failure = e.what();
}

// Records runs of descending step or tolerance, at least three, until the error is below the smallest wanted error.
void record(CostCurve& curve, ConvergedPins const& pins, Options const& o, std::vector<double> const& settings) {
  double const least = *std::min_element(o.selection.errors.begin(), o.selection.errors.end());
  for (double const accuracy : settings) {
    if (curve.runs.size() >= 3 && curve.runs.back().failure.empty() && curve.runs.back().error < least) return;
    record(curve.runs.emplace_back(CostRun{.accuracy = accuracy}), curve, pins, o);
  }
}

// Times short runs again, alternating between the formulations, without records of their states.
void time_again(CostStudy& study, Options o) {
  std::vector<std::pair<CostCurve const*, CostRun*>> repeated;
  for (CostCurve& curve : study.curves)
    for (CostRun& run : curve.runs)
      if (run.failure.empty() && run.cpu.front() <= longest_repeated) {
        run.cpu.clear();
        repeated.emplace_back(&curve, &run);
      }
  for (int k = 0; k < repeats; ++k)
    for (auto const& [curve, run] : repeated) {
      Options timed = with_accuracy(o, curve->combination, run->accuracy);
      timed.sampling = o.end_time;
      run->cpu.push_back(run_pins(timed, study.pins[curve->pins], curve->combination).comparison.runs[0].cpu);
    }
  for (auto const& [curve, run] : repeated) std::sort(run->cpu.begin(), run->cpu.end());
}

// Adds a combination that does not exist. Integrators with the same reason share a sentence.
void refuse(CostStudy& study, Combination const& c) {
  std::string const name = c.links.body.name + ", " + c.links.policy + " with ",
                    reason = " does not exist: " + c.refusal();
  for (std::string& known : study.refusals)
    if (known.starts_with(name) && known.ends_with(reason)) {
      known.insert(known.size() - reason.size(), ", " + integrator_name(c));
      return;
    }
  study.refusals.push_back(name + integrator_name(c) + reason);
}

// Number of the pins of this combination and stiffness [N/m] in the study, to which they are added if they are new.
std::size_t pins_of(CostStudy& study, Combination const& c, double stiffness) {
  std::string name = (c.links.body.name == "rigid" ? "" : c.links.body.name + ", ") + c.links.policy;
  if (c.links.policy == "penalty") name += " " + compact(stiffness);
  auto const known =
      std::find_if(study.pins.begin(), study.pins.end(), [&](ConvergedPins const& pins) { return pins.name == name; });
  if (known != study.pins.end()) return std::size_t(known - study.pins.begin());
  study.pins.push_back({.name = name, .links = c.links, .stiffness = stiffness});
  return study.pins.size() - 1;
}

void add_curves(CostStudy& study, Options const& o) {
  for (Combination const& c : candidates(o.selection)) {
    if (!c.refusal().empty()) {
      refuse(study, c);
      continue;
    }
    require_turning(o, c.links);
    for (double const k : c.links.policy == "penalty" ? o.penalties : std::vector{o.spring_pins})
      study.curves.push_back({pins_of(study, c, k), c, integrator_name(c), has_step_control(c)});
  }
}

}  // namespace

std::string CostCurve::setting(CostRun const& run) const {
  return controlled ? "tolerance " + compact(run.accuracy) : compact(1e3 * run.accuracy) + " ms";
}

CostStudy cost_study(Options o) {
  o.film = nullptr;
  o.animate = 0.0;
  o.audit = false;
  Selection& s = o.selection;
  bool const default_steps = s.steps.empty();
  complete(s,
           {.steps = {4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4}, .tolerances = {1e-3, 1e-4, 1e-5}, .errors = {1e-2, 1e-3, 1e-4}});
  if (s.bodies.empty()) s.bodies = {"rigid"};
  if (s.policies.empty()) s.policies = combinations::all_policies;
  if (s.integrators.empty()) s.integrators = {"generalised-alpha", "radau", "adams"};
  polybody::detail::require_axis(s.steps, false, "steps", "--compare cost");
  polybody::detail::require_axis(s.tolerances, false, "tolerances", "--compare cost");
  CostStudy study{.errors = s.errors};
  add_curves(study, o);
  if (study.curves.empty())
    throw InvalidInput{ErrorObject{"--compare cost"}, ": no selected combination exists. ", study.refusals.front()};
  o.start = std::make_shared<m113::TrackStart const>(settled(o));
  for (ConvergedPins& pins : study.pins) converge(pins, o);
  for (ConvergedPins& pins : study.pins)
    if (pins.failure.empty()) pins.difference = difference(study.reference().run, pins.run, o.end_time);
  for (CostCurve& curve : study.curves)
    if (study.pins[curve.pins].failure.empty())
      record(curve, study.pins[curve.pins], o, accuracies(o, curve.combination, default_steps));
  time_again(study, o);
  return study;
}

}  // namespace chapter3
