#pragma once
/// \file
/// One case under several formulations, side by side.

#include <ctime>

#include <polybody/compare/comparison.hpp>
#include <polybody/compare/formulation.hpp>
#include <polybody/run/sampling.hpp>
#include <polybody/run/simulate.hpp>

namespace polybody {

/// A number of interest that every formulation of a case can answer.
template <class M>
struct Output {
  std::string name;                                     ///< with its unit
  std::function<double(M const&, State const&)> value;  ///< in a state
};

/// What a case makes of a formulation: the model, its start, the run and the outputs.
template <class M>
struct Scenario {
  M model;                                                    ///< of one formulation
  State start;                                                ///< where the run begins
  RunOptions options;                                         ///< of the run
  std::vector<Output<M>> outputs = {};                        ///< what is compared
  std::function<void(M const&, State const&)> observer = {};  ///< called at every state that is asked, not timed
  double sampling = 0.0;  ///< [s]: asked is the first state on or after each multiple of it from the start on; 0: every
                          ///< state of the run. For integrators whose steps are much shorter than what is of interest.
};

/// A case is called with a formulation and returns a Scenario of whatever model type that leads to.
template <class C, class F>
concept CaseFor = requires(C const c, F const f) {
  { c(f).model };
  { c(f).start } -> std::convertible_to<State>;
  { c(f).sampling } -> std::convertible_to<double>;
};

namespace detail {

/// The formulation's own name, or else its integrator's.
template <class F>
std::string name_of(F const& formulation) {
  return formulation.name.empty() ? decltype(formulation.integrator)::name : formulation.name;
}
/// The name, made different from those of earlier runs.
template <class = void>
std::string name_beside(std::vector<ComparedRun> const& earlier, std::string const& own) {
  std::string name = own;
  auto const taken = [&](ComparedRun const& run) { return run.name == name; };
  for (int i = 2; std::any_of(earlier.begin(), earlier.end(), taken); ++i) name = own + " (" + std::to_string(i) + ")";
  return name;
}

/// \throws InvalidInput unless the outputs of a run have names, all different, and are those of the earlier runs.
template <class = void>
void check_outputs(ComparedRun const& run, std::vector<ComparedRun> const& earlier) {
  std::vector<std::string> names = run.output_names;
  std::sort(names.begin(), names.end());
  bool const named = names.empty() || !names.front().empty();
  if (!named || std::adjacent_find(names.begin(), names.end()) != names.end())
    throw InvalidInput{"compare: the outputs of \"", run.name, "\" need names, each its own."};
  if (!earlier.empty() && run.output_names != earlier.front().output_names)
    throw InvalidInput{"compare: \"", run.name, "\" has other outputs than \"", earlier.front().name,
                       "\". Let the case name the same ones, in the same order, for every formulation."};
}

/// The questions that are asked about every state of a run, whatever the case's model.
struct CaseQuestions {
  System system;
  std::vector<std::function<double(State const&)>> outputs = {};
  std::function<void(State const&)> observer = {};

  template <class = void>  // compiled where it is used
  void note(State const& x, ComparedRun& out) {
    Violation const& v = out.violations.emplace_back(violation(system, x));  // evaluates the system
    out.violation.position = std::max(out.violation.position, v.position);
    out.violation.velocity = std::max(out.violation.velocity, v.velocity);
    out.violation.acceleration = std::max(out.violation.acceleration, v.acceleration);
    out.energies.push_back(energy(system, x));
    out.joint_forces.push_back(peak_joint_force(system, x));
    out.peak_joint_force = std::max(out.peak_joint_force, out.joint_forces.back());
    out.times.push_back(x.t);
    for (std::size_t i = 0; i < outputs.size(); ++i) out.outputs[i].push_back(outputs[i](x));
    if (observer) observer(x);
  }
};

/// The questions of a scenario, which must outlive them.
template <class S>
CaseQuestions questions_of(S& scenario) {
  auto const& model = scenario.model;
  CaseQuestions questions{question_system(model)};
  for (auto& o : scenario.outputs) questions.outputs.push_back([&](State const& x) { return o.value(model, x); });
  if (scenario.observer) questions.observer = [&](State const& x) { scenario.observer(model, x); };
  return questions;
}

/// Runs to the end and notes the first state, the last one, and those in between that `sampling` asks for; only the
/// steps are timed.
template <class Run>
void record_run(Run& run, CaseQuestions& questions, double sampling, ComparedRun& out) {
  RunSampling asked(run.state().t, sampling);
  questions.note(run.state(), out);
  while (!run.done()) {
    std::clock_t const begin = std::clock();
    run.advance();
    out.cpu += double(std::clock() - begin) / CLOCKS_PER_SEC;
    if (asked.takes(run.state().t) || run.done()) questions.note(run.state(), out);
  }
  out.energy_start = out.energies.front().total();
  out.energy_end = out.energies.back().total();
  out.run = run.report();
}

/// Adds the run of a formulation to c, or a sentence to `failures`.
template <class F, class C>
void add_run(C const& make_case, F const& formulation, Comparison& c, std::string& failures) {
  auto scenario = make_case(formulation);
  ComparedRun out;
  out.name = name_beside(c.runs, name_of(formulation));
  out.census = census(scenario.model);
  for (auto const& o : scenario.outputs) out.output_names.push_back(o.name);
  check_outputs(out, c.runs);
  out.outputs.resize(scenario.outputs.size());
  require_not_negative(scenario.sampling, "compare: the sampling of ", "\"" + out.name + "\"");
  State x = scenario.start;
  try {
    auto run = simulate(scenario.model, x, formulation.integrator, scenario.options);
    CaseQuestions questions = questions_of(scenario);
    record_run(run, questions, scenario.sampling, out);
  } catch (Error const& failed) {
    failures += sentence_of({" \"", out.name, "\": ", failed.what()});
    return;
  }
  c.runs.push_back(std::move(out));
}

/// How far the outputs of each run are off those of the first.
template <class = void>
void compare_with_first(Comparison& c) {
  if (c.runs.empty()) return;
  ComparedRun const& first = c.runs.front();
  for (ComparedRun& run : c.runs)
    for (std::size_t i = 0; i < run.outputs.size(); ++i) {
      double most = 0.0;
      for (std::size_t k = 0; k < run.times.size(); ++k)
        most = std::max(most, std::abs(run.outputs[i][k] - interpolate(first.times, first.outputs[i], run.times[k])));
      run.difference.push_back(most);
    }
}

}  // namespace detail

/// Runs the case under each of `formulations` (values: a policy without default numbers needs its own);
/// make_case(formulation) gives it.
/// \throws InvalidInput for outputs that are not the same for all, and what the case throws; ComparisonFailed, after
/// the other runs and with their results, where `simulate` or an output throws an `Error`.
template <class C, class... Fs>
  requires(CaseFor<C, Fs> && ...)
Comparison compare(C const& make_case, Fs const&... formulations) {
  Comparison c;
  std::string failures;
  (detail::add_run(make_case, formulations, c, failures), ...);
  detail::compare_with_first(c);
  if (!failures.empty()) throw ComparisonFailed("compare: runs failed." + failures, std::move(c));
  return c;
}

/// The same for formulations whose numbers all have defaults: compare<F1, F2, …>(make_case).
template <class... Fs, class C>
  requires(sizeof...(Fs) > 0 && (CaseFor<C, Fs> && ...))
Comparison compare(C const& make_case) {
  return compare(make_case, Fs{}...);
}

}  // namespace polybody
