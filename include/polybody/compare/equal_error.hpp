#pragma once
/// \file
/// Comparison of formulations at equal error: mesh and step vary together, each formulation is compared with the
/// converged result of its own physical model, and CPU times are compared at equal errors.
/// Theory: Eqs. 11.29 to 11.34.

#include <ctime>
#include <functional>

#include <polybody/compare/equal_error_evaluation.hpp>
#include <polybody/compare/work_precision.hpp>

namespace polybody {

/// Settings of an `EqualErrorStudy`. `modes` are for modal floating frames, and `tolerances` for integrators with step
/// size control. Each list that a formulation uses needs at least three entries.
struct EqualErrorOptions {
  std::vector<Index> elements = {};                       ///< numbers of elements, ascending
  std::vector<Index> modes = {};                          ///< numbers of modes, ascending
  std::vector<double> steps = {};                         ///< steps [s], descending
  std::vector<double> tolerances = {};                    ///< relative tolerances, descending
  std::vector<double> errors = {1e-1, 1e-2, 1e-3, 1e-4};  ///< wanted errors, relative to the span of the output
  std::size_t output = 0;                                 ///< number of the output
  int repeats = 5;                                        ///< number of timed runs of each cheapest setting
  Index samples = 400;                                    ///< number of intervals between the sampled times
};

/// Physical model of a formulation, with meshes and steps that replace those of the study.
struct StudyEntry {
  std::string model;               ///< name of the physical model; equal names mean equal equations
  std::vector<Index> meshes = {};  ///< numbers of elements (or modes); empty: those of the study
  std::vector<double> steps = {};  ///< steps [s] or tolerances [1]; empty: those of the study
};

namespace detail {

/// Kind of a run in a study: with the output recorded, with output and energy recorded, recorded from perturbed initial
/// coordinates, or timed without records.
enum class StudyRunKind { record, record_energy, perturb, time };
/// Runs one formulation, independent of the type of its model.
using StudyRunner = std::function<void(StudyRun&, StudyRunKind, EqualErrorOptions const&, EqualErrorReport&)>;

/// True for a formulation whose type contains a number of elements.
template <class F>
inline constexpr bool has_fixed_mesh = false;
template <class B, class P, class I>
inline constexpr bool has_fixed_mesh<Formulation<B, P, I>> = requires { MeshOf<B>::elements; };

/// Output of a study: its function of a state, and the times at which it need not be smooth [s], ascending.
struct StudyOutput {
  std::function<double(State const&)> value = {};
  std::vector<double> breakpoints = {};
};

/// Samples the recorded output at the times of the report. The first recorded run determines these times.
template <class = void>
void sample(OutputHistory const& y, Index samples, std::vector<double>& times, std::vector<double>& out) {
  if (times.empty())
    for (Index k = 0; k <= samples; ++k)
      times.push_back(y.times.front() + (y.times.back() - y.times.front()) * double(k) / double(samples));
  for (double const t : times) out.push_back(y(t));
}

/// Error of interpolation in a recorded output: largest difference between the output and its interpolation through
/// every second state. States near the start, the end and breakpoints are not compared.
template <class = void>
double interpolation_error(OutputHistory const& y) {
  OutputHistory half{.times = {}, .values = {}, .breakpoints = y.breakpoints};
  std::vector<std::size_t> omitted;
  for (std::size_t k = 0; k < y.times.size(); ++k) {
    bool const is_breakpoint = std::binary_search(y.breakpoints.begin(), y.breakpoints.end(), y.times[k]);
    if (k > 0 && half.times.back() == y.times[k - 1] && !is_breakpoint) {
      omitted.push_back(k);
      continue;
    }
    half.times.push_back(y.times[k]);
    half.values.push_back(y.values[k]);
  }
  double most = 0.0;
  for (std::size_t const k : omitted)
    if (auto const [first, last] = y.piece(y.times[k]); k >= first + 3 && k + 4 < last)
      most = std::max(most, std::abs(half(y.times[k]) - y.values[k]));
  return most;
}

/// Runs all settings of the formulation `f`, and the finest one again from perturbed initial coordinates.
template <class = void>
void record_formulation(StudiedFormulation& f, StudyRunner const& runner, EqualErrorOptions const& o,
                        EqualErrorReport& r) {
  for (StudyRun& run : f.runs) try {
      runner(run, &run == &f.runs.back() ? StudyRunKind::record_energy : StudyRunKind::record, o, r);
    } catch (Error const& failed) {
      run.y.clear();
      run.failure = failed.what();
    }
  StudyRun moved = f.finest();
  if (!moved.failure.empty()) {
    f.remarks.push_back("the run with " + setting_of(f, moved) + " failed: " + moved.failure);
    return;
  }
  moved.y.clear();
  try {
    runner(moved, StudyRunKind::perturb, o, r);
    f.spread = largest_difference(moved.y, f.finest().y);
  } catch (Error const& failed) {
    f.remarks.push_back(std::string("the run from perturbed coordinates failed: ") + failed.what());
    f.spread = std::numeric_limits<double>::infinity();
  }
}

/// Times the cheapest runs again, alternating between the formulations, and sorts the rankings by the medians.
template <class = void>
void time_again(EqualErrorReport& r, std::vector<StudyRunner> const& runners, EqualErrorOptions const& o) {
  std::vector<CheapestRun> chosen;
  for (Ranking const& ranking : r.rankings)
    for (CheapestRun const& c : ranking.ranked)
      if (std::find(chosen.begin(), chosen.end(), c) == chosen.end()) chosen.push_back(c);
  std::vector<std::vector<double>> times(chosen.size());
  for (int k = 0; k < o.repeats; ++k)
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      StudyRun timed = r.formulations[chosen[i].formulation].runs[chosen[i].run];
      runners[chosen[i].formulation](timed, StudyRunKind::time, o, r);
      times[i].push_back(timed.cpu);
    }
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    std::sort(times[i].begin(), times[i].end());
    StudyRun& run = r.formulations[chosen[i].formulation].runs[chosen[i].run];
    std::size_t const n = times[i].size();
    run.cpu = 0.5 * (times[i][(n - 1) / 2] + times[i][n / 2]);
    run.least_cpu = times[i].front();
    run.most_cpu = times[i].back();
    run.timings = int(n);
  }
  auto const cpu = [&](CheapestRun const& c) { return r.formulations[c.formulation].runs[c.run].cpu; };
  for (Ranking& ranking : r.rankings)
    std::stable_sort(ranking.ranked.begin(), ranking.ranked.end(),
                     [&](CheapestRun const& a, CheapestRun const& b) { return cpu(a) < cpu(b); });
}

/// Removes the output of the finest run of a formulation and adds a remark, if `interpolation_error` of this run
/// exceeds the smallest wanted error `least` [unit of the output].
template <class = void>
void require_smooth(EqualErrorReport const& r, StudiedFormulation& f, double least) {
  StudyRun& fine = f.runs.back();
  if (fine.y.empty() || fine.interpolation_error <= least) return;
  f.remarks.push_back("no reference: the output \"" + r.output + "\" is not smooth: interpolation through every " +
                      "second state changes it by " + r.with_unit(fine.interpolation_error) +
                      ", but the smallest wanted error is " + r.with_unit(least) +
                      ". Shorten the steps, or choose an output without jumps.");
  fine.y.clear();
}

/// Stores in `r` the largest span of the outputs of the finest runs of selected formulations. If no selected output
/// varies, the span remains unchanged.
/// \throws InvalidInput if formulations are selected, none of their outputs varies, and the span is zero.
template <class Select>
void find_span(EqualErrorReport& r, Select&& selects) {
  double span = 0.0, largest = 0.0;
  bool any = false;
  for (StudiedFormulation const& f : r.formulations) {
    if (!selects(f)) continue;
    any = true;
    auto const [least, most] = std::minmax_element(f.finest().y.begin(), f.finest().y.end());
    span = std::max(span, *most - *least);
    largest = std::max({largest, std::abs(*least), std::abs(*most)});
  }
  if (span > 1e-12 * largest)
    r.span = span;
  else if (any && r.span == 0.0)
    throw InvalidInput("equal_error.constant", {"EqualErrorStudy: the output \"", ErrorObject{r.output},
                                                "\" is constant, so relative errors are undefined. Choose another "
                                                "output."});
}

/// Removes limits whose error bound exceeds the span, and stores the span of the formulations that keep their limit.
template <class = void>
void refuse_limits(EqualErrorReport& r) {
  double before = 0.0;
  do {
    before = r.span;
    for (StudiedFormulation& f : r.formulations) refuse_limit(r, f);
    find_span(r, [](StudiedFormulation const& f) { return !f.limit.empty(); });
  } while (r.span < before);
}

/// Completes a simulation of a study and stores its results in `run`, and the times of the samples in `r`.
template <class Run>
void complete_run(Run& simulation, StudyOutput const& output, StudyRun& run, StudyRunKind kind,
                  EqualErrorOptions const& o, EqualErrorReport& r) {
  std::clock_t const begin = std::clock();
  if (kind == StudyRunKind::time) {
    simulation.run();
    run.cpu = double(std::clock() - begin) / CLOCKS_PER_SEC;
    return;
  }
  OutputHistory outputs, energies;
  outputs.breakpoints = energies.breakpoints = output.breakpoints;
  auto const note = [&] {
    auto const& now = simulation.now();
    outputs.times.push_back(now.t);
    outputs.values.push_back(output.value(now));
    if (kind == StudyRunKind::record_energy) energies.values.push_back(now.energy().total());
  };
  note();
  run.cpu = 0.0;
  while (!simulation.done()) {
    std::clock_t const start = std::clock();
    simulation.advance();
    run.cpu += double(std::clock() - start) / CLOCKS_PER_SEC;
    note();
  }
  RunReport const& report = simulation.report();
  run.steps = report.steps;
  run.iterations = report.iterations;
  run.factorisations = report.factorisations;
  sample(outputs, o.samples, r.times, run.y);
  if (kind != StudyRunKind::record_energy) return;
  run.interpolation_error = interpolation_error(outputs);
  energies.times = outputs.times;
  sample(energies, o.samples, r.times, run.energy);
}

/// Initial state of a run. Before a run of the kind `perturb`, each coordinate changes by one unit in the last place.
inline State first_state(State x, StudyRunKind kind) {
  if (kind == StudyRunKind::perturb)
    for (double& q : x.q) q = std::nextafter(q, std::numeric_limits<double>::infinity());
  return x;
}

/// Checks an axis of a study: at least three positive values, ascending or descending.
/// \throws InvalidInput otherwise.
template <class T>
void require_axis(std::vector<T> const& values, bool ascending, std::string const& what, std::string const& name) {
  if (values.size() < 3)
    throw InvalidInput("equal_error.axis", {ErrorObject{name}, ": the list of ", what,
                                            " needs at least three entries to observe an order, but has ",
                                            ErrorValue{values.size()}, ". Add to the list."});
  for (std::size_t k = 0; k < values.size(); ++k) {
    bool const ordered = k == 0 || (ascending ? values[k] > values[k - 1] : values[k] < values[k - 1]);
    if (!(values[k] > T(0)) || !ordered)
      throw InvalidInput("equal_error.axis", {ErrorObject{name}, ": the list of ", what, " must be positive and ",
                                              ascending ? "ascending" : "descending", ", but entry ", k,
                                              ", counted from 0, is ", ErrorValue{values[k]}, "."});
  }
}

}  // namespace detail

/// Comparison at equal error of formulations that are added one by one, in one or several source files:
///
///     EqualErrorStudy study({.elements = {5, 10, 20, 40}, .steps = {5e-3, 2.5e-3, 1.25e-3}});
///     study.add(Arm{}, Formulation<planar::Lrvf, Constraint, GeneralisedAlpha>{"LRVF"}, {.model = "beam with shear"});
///     study.add(Arm{}, Formulation<planar::AncfCable<>, Constraint, GeneralisedAlpha>{"cable"}, {.model = "cable"});
///     std::cout << study.run();
///
/// The case creates its flexible body by `formulation.body(bar)`, with the mesh that the study has set in
/// `formulation.mesh`. The output is recorded at every state of a run and interpolated between them, so it must be
/// smooth there.
class EqualErrorStudy {
 public:
  /// \throws InvalidInput if a wanted error, the number of samples or the number of repeats is not positive.
  explicit EqualErrorStudy(EqualErrorOptions options) : options_(std::move(options)) {
    for (double const e : options_.errors) require_positive(e, "EqualErrorStudy: a wanted error");
    require_positive(double(options_.samples), "EqualErrorStudy: the number of samples");
    require_positive(double(options_.repeats), "EqualErrorStudy: the number of repeats");
  }

  /// Adds a formulation. `make_case(formulation)` returns its Scenario.
  /// \throws InvalidInput if meshes or steps are fewer than three, not positive or not in order.
  template <class C, class F>
    requires ComparisonCase<C, F>
  void add(C const& make_case, F const& formulation, StudyEntry entry) {
    static_assert(!detail::has_fixed_mesh<F>,
                  "EqualErrorStudy sets the mesh of the body at run time. Name the body without Meshed or Modal.");
    StudiedFormulation f;
    f.name = detail::name_of(formulation);
    f.model = std::move(entry.model);
    f.integrator = F::IntegratorType::name;
    if constexpr (requires { F::PolicyType::name; }) f.policy = F::PolicyType::name;
    constexpr bool controlled = requires { F::IntegratorType::adaptive_step; };
    f.step_name = controlled ? "tolerance" : "step [s]";
    if (F::has_modes && !options_.modes.empty())
      f.mesh_name = "modes";
    else if (F::has_mesh)
      f.mesh_name = "elements";
    bool const modal = f.mesh_name == "modes";
    f.family = detail::family_of(formulation, modal);
    if (entry.meshes.empty() && !f.mesh_name.empty()) entry.meshes = modal ? options_.modes : options_.elements;
    if (entry.steps.empty()) entry.steps = controlled ? options_.tolerances : options_.steps;
    if (!f.mesh_name.empty()) detail::require_axis(entry.meshes, true, f.mesh_name, f.name);
    detail::require_axis(entry.steps, false, controlled ? "tolerances" : "steps", f.name);
    if (f.mesh_name.empty()) entry.meshes = {0};
    for (Index const mesh : entry.meshes)
      for (double const step : entry.steps) f.runs.push_back({.mesh = mesh, .step = step});
    runners_.push_back([make_case, formulation, modal](StudyRun& run, detail::StudyRunKind kind,
                                                       EqualErrorOptions const& o, EqualErrorReport& r) {
      F with_mesh = formulation;
      if (run.mesh > 0) (modal ? with_mesh.mesh.modes : with_mesh.mesh.elements) = run.mesh;
      auto scenario = make_case(with_mesh);
      auto const& output = detail::output_of(scenario, o.output, "EqualErrorStudy");
      r.output = output.name;
      detail::set_accuracy(with_mesh.integrator, scenario.options, run.step);
      State x = detail::first_state(scenario.start, kind);
      auto simulation = simulate(scenario.model, x, with_mesh.integrator, scenario.options);
      ProblemSize const size = problem_size(scenario.model);
      run.unknowns = size.velocities + size.rows;
      detail::complete_run(simulation,
                           {.value = [&](State const& now) { return output.value(scenario.model, now); },
                            .breakpoints = detail::breakpoints_of(simulation, scenario.options)},
                           run, kind, o, r);
    });
    report_.formulations.push_back(std::move(f));
  }

  /// Runs all formulations with all meshes and steps and evaluates the results. A failed run, or a formulation without
  /// a converged result, does not end the study. A result has not converged if its error bound exceeds the span.
  /// `failure` of the run, or the remarks of the formulation, give the reason.
  /// \throws InvalidInput if no formulation was added, or if the output of every complete run is constant.
  template <class = void>  // compiled where it is used
  EqualErrorReport run() const {
    EqualErrorReport r = report_;
    if (r.formulations.empty())
      throw InvalidInput("equal_error.empty", {ErrorObject{"EqualErrorStudy"},
                                               ": there are no formulations. Call `add` for each formulation."});
    for (std::size_t i = 0; i < r.formulations.size(); ++i)
      detail::record_formulation(r.formulations[i], runners_[i], options_, r);
    detail::find_span(r, [](StudiedFormulation const& f) { return !f.finest().y.empty(); });
    double const least = *std::min_element(options_.errors.begin(), options_.errors.end()) * r.span;
    for (StudiedFormulation& f : r.formulations) {
      detail::require_smooth(r, f, least);
      detail::find_limit(r, f);
    }
    detail::refuse_limits(r);
    detail::find_references(r);
    if (r.span > 0.0) detail::rank(r, options_.errors);
    detail::time_again(r, runners_, options_);
    detail::mark_front(r);
    return r;
  }

 private:
  EqualErrorOptions options_;
  EqualErrorReport report_;
  std::vector<detail::StudyRunner> runners_;
};

}  // namespace polybody
