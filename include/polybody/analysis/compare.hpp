#pragma once
/// \file
/// One case under several formulations, side by side.

#include <ctime>
#include <iomanip>
#include <ostream>

#include <polybody/analysis/energy.hpp>
#include <polybody/analysis/formulation.hpp>
#include <polybody/analysis/observe.hpp>
#include <polybody/analysis/simulate.hpp>

namespace polybody {

/// A number of interest that every formulation of a case can answer.
template <class M>
struct Output {
  std::string name;  ///< with its unit
  std::function<double(M const&, State const&)> value;
};

/// What a case makes of a formulation: the model, its start, the run and the outputs.
template <class M>
struct Scenario {
  M model;
  State start;
  RunOptions options;
  std::vector<Output<M>> outputs = {};
  std::function<void(M const&, State const&)> observer = {};  ///< called at every state, not timed
};

/// A case is called with a formulation and returns a Scenario of whatever model type that leads to.
template <class C, class F>
concept CaseFor = requires(C const c, F const f) {
  { c(f).model };
  { c(f).start } -> std::convertible_to<State>;
};

/// One column of the report.
struct ComparedRun {
  std::string name;
  Census census;
  RunReport run;
  double cpu = 0.0;                          ///< of the steps alone [s]
  Violation violation;                       ///< largest over the run
  double energy_start = 0.0;                 ///< total energy [J]
  double energy_end = 0.0;
  double peak_joint_force = 0.0;             ///< [N]
  std::vector<double> times;                 ///< [s]
  std::vector<std::string> output_names;
  std::vector<std::vector<double>> outputs;  ///< one history for each output
  std::vector<double> difference;            ///< largest |output − first formulation's| over the run
};

struct Comparison {
  std::vector<ComparedRun> runs;
};

namespace detail {

/// y(t) by linear interpolation in a history with increasing times.
inline double interpolate(std::vector<double> const& times, std::vector<double> const& y, double t) {
  auto const after = std::lower_bound(times.begin(), times.end(), t);
  if (after == times.begin()) return y.front();
  if (after == times.end()) return y.back();
  std::size_t const i = std::size_t(after - times.begin());
  double const x = (t - times[i - 1]) / (times[i] - times[i - 1]);
  return (1.0 - x) * y[i - 1] + x * y[i];
}

template <class M>
double peak_force(System<M> const& system, State const& x) {
  double peak = 0.0;
  for_each_gap(system.model(), system.data(), [&](auto const& e, auto const& gap) {
    constexpr int m = std::decay_t<decltype(gap)>::rows;
    Vec<double, m> const l = multiplier(e, gap, system.data(), x.lambda);
    peak = std::max(peak, (gap.Gb.template leftCols<3>().transpose() * l).norm());
  });
  return peak;
}

template <class F, class C>
ComparedRun compared_run(C const& make_case, F const& formulation) {
  auto scenario = make_case(formulation);
  using M = std::decay_t<decltype(scenario.model)>;
  M const& model = scenario.model;
  ComparedRun out;
  out.name = formulation.name.empty() ? "(unnamed)" : formulation.name;
  out.census = census(model);
  for (auto const& o : scenario.outputs) out.output_names.push_back(o.name);
  out.outputs.resize(scenario.outputs.size());
  State x = scenario.start;
  auto run = simulate(model, x, formulation.integrator, scenario.options);
  System<M> system(model);
  auto const observe = [&] {
    Violation const v = violation(system, x);
    out.violation.position = std::max(out.violation.position, v.position);
    out.violation.velocity = std::max(out.violation.velocity, v.velocity);
    out.violation.acceleration = std::max(out.violation.acceleration, v.acceleration);
    out.peak_joint_force = std::max(out.peak_joint_force, peak_force(system, x));
    out.times.push_back(x.t);
    for (std::size_t i = 0; i < scenario.outputs.size(); ++i)
      out.outputs[i].push_back(scenario.outputs[i].value(model, x));
    if (scenario.observer) scenario.observer(model, x);
  };
  observe();
  out.energy_start = energy(system, x).total();
  while (!run.done()) {
    std::clock_t const begin = std::clock();
    run.advance();
    out.cpu += double(std::clock() - begin) / CLOCKS_PER_SEC;
    observe();
  }
  out.energy_end = energy(system, x).total();
  out.run = run.report();
  return out;
}

}  // namespace detail

/// Runs the case under each formulation (given as values: a policy without default numbers needs its own).
template <class C, class... Fs>
  requires(CaseFor<C, Fs> && ...)
Comparison compare(C const& make_case, Fs const&... formulations) {
  Comparison c;
  (c.runs.push_back(detail::compared_run(make_case, formulations)), ...);
  if (c.runs.empty()) return c;
  ComparedRun const& first = c.runs.front();
  for (ComparedRun& run : c.runs)
    for (std::size_t i = 0; i < std::min(run.outputs.size(), first.outputs.size()); ++i) {
      double most = 0.0;
      for (std::size_t k = 0; k < run.times.size(); ++k)
        most = std::max(most, std::abs(run.outputs[i][k] -
                                       detail::interpolate(first.times, first.outputs[i], run.times[k])));
      run.difference.push_back(most);
    }
  return c;
}

/// The same for formulations whose numbers all have defaults: compare<F1, F2, …>(case).
template <class... Fs, class C>
  requires(sizeof...(Fs) > 0 && (CaseFor<C, Fs> && ...))
Comparison compare(C const& make_case) {
  return compare(make_case, Fs{}...);
}

/// The report as a table, one line a quantity and one column a formulation.
inline std::ostream& operator<<(std::ostream& out, Comparison const& c) {
  if (c.runs.empty()) return out;
  std::size_t label = 34, wide = 14;
  for (ComparedRun const& r : c.runs) wide = std::max(wide, r.name.size() + 2);
  auto const line = [&](std::string const& what, auto&& value) {
    out << std::left << std::setw(int(label)) << what << std::right;
    for (ComparedRun const& r : c.runs) out << std::setw(int(wide)) << value(r);
    out << '\n';
  };
  std::ios state(nullptr);
  state.copyfmt(out);
  out << std::setprecision(4);
  line("", [](auto const& r) { return r.name; });
  line("coordinates", [](auto const& r) { return r.census.coordinates; });
  line("constraints", [](auto const& r) { return r.census.constraints; });
  line("degrees of freedom", [](auto const& r) { return r.census.degrees_of_freedom; });
  line("multiplier rows", [](auto const& r) { return r.census.rows; });
  line("steps", [](auto const& r) { return r.run.steps; });
  line("Newton iterations a step", [](auto const& r) {
    return double(r.run.iterations) / double(std::max(r.run.steps, 1L));
  });
  line("factorisations a step", [](auto const& r) {
    return double(r.run.factorisations) / double(std::max(r.run.steps, 1L));
  });
  line("CPU time [s]", [](auto const& r) { return r.cpu; });
  line("CPU ratio to the first", [&](auto const& r) { return r.cpu / std::max(c.runs.front().cpu, 1e-9); });
  line("position violation", [](auto const& r) { return r.violation.position; });
  line("velocity violation", [](auto const& r) { return r.violation.velocity; });
  line("acceleration violation", [](auto const& r) { return r.violation.acceleration; });
  line("energy at the end - at the start [J]", [](auto const& r) { return r.energy_end - r.energy_start; });
  line("peak joint force [N]", [](auto const& r) { return r.peak_joint_force; });
  for (std::size_t i = 0; i < c.runs.front().output_names.size(); ++i) {
    line("end: " + c.runs.front().output_names[i], [&](auto const& r) { return r.outputs[i].back(); });
    line("  most off the first", [&](auto const& r) { return r.difference[i]; });
  }
  out.copyfmt(state);
  return out;
}

}  // namespace polybody
