#pragma once
/// \file
/// Work-precision studies: error versus CPU time of one case at several steps or tolerances.
/// Theory: Eq. 11.28.

#include <span>

#include <polybody/compare/compare.hpp>

namespace polybody {

/// Point of a work-precision curve: result of one run.
struct WorkPoint {
  double setting = 0.0;      ///< step [s], or relative tolerance of an integrator with step size control
  long steps = 0;            ///< number of steps of the run
  double cpu = 0.0;          ///< CPU time of the steps [s]
  double error = 0.0;        ///< error in the unit of the output, see `work_precision`
  std::string failure = {};  ///< message of a failed run, whose results are invalid; empty if the run is complete
};

/// Work-precision curve: all runs of one formulation.
struct WorkCurve {
  std::string name;                    ///< name of the formulation
  std::string output;                  ///< name of the output whose error is given
  std::vector<WorkPoint> points = {};  ///< one point for each setting
};

/// Work-precision curves of several formulations for one output.
struct WorkPrecision {
  std::vector<WorkCurve> curves;  ///< one curve for each formulation
};

/// Output y(t) of a recorded run, interpolated by cubics between the recorded times. No cubic crosses a breakpoint of
/// the run, because derivatives of the output may jump there.
struct OutputHistory {
  std::vector<double> times, values;     ///< (n) t [s] and y [unit of the output]
  std::vector<double> breakpoints = {};  ///< breakpoints [s], ascending
  /// Interpolates y at time t [s].
  double operator()(double t) const {
    auto const [first, last] = piece(t);
    return detail::interpolate(std::span(times).subspan(first, last - first),
                               std::span(values).subspan(first, last - first), t);
  }
  /// First index, and index after the last, of the states between the breakpoints around t [s].
  std::pair<std::size_t, std::size_t> piece(double t) const {
    auto const next = std::lower_bound(breakpoints.begin(), breakpoints.end(), t);
    auto first = times.begin(), last = times.end();
    if (next != breakpoints.begin()) first = std::lower_bound(first, last, *std::prev(next));
    if (next != breakpoints.end()) last = std::upper_bound(first, last, *next);
    if (first == last) return {0, times.size()};  // no state lies between the breakpoints
    return {std::size_t(first - times.begin()), std::size_t(last - times.begin())};
  }
};

/// Reference for an output: a function of time, a `reference_run`, or a number for the end of the run.
struct OutputReference {
  std::function<double(double)> at;  ///< y_ref(t), t in [s]
  bool only_at_end = false;          ///< true if outputs are compared at the end of the run only

  /// Reference value at the `end` of the run.
  OutputReference(double end) : at([end](double) { return end; }), only_at_end(true) {}
  /// Reference function y(t) for every time of the run.
  template <class F>
    requires std::is_invocable_r_v<double, F const&, double>
  OutputReference(F const& y) : at(y) {}
};

namespace detail {

/// Returns output number `output` of a scenario.
/// \throws InvalidInput if it does not exist.
template <class S>
auto const& output_of(S const& scenario, std::size_t output, std::string const& what) {
  if (output >= scenario.outputs.size())
    throw InvalidInput("compare.output_index",
                       {ErrorObject{what}, ": output ", ErrorValue{output}, " does not exist; the case has ",
                        scenario.outputs.size(), " outputs, counted from 0."});
  return scenario.outputs[output];
}

/// Sets the step, or the relative tolerance, to `setting`. The absolute tolerance changes in proportion. A fixed step
/// is not halved if it fails, unless `max_step_halvings` is set.
template <class I>
void set_accuracy(I& integrator, RunOptions& options, double setting) {
  require_positive(setting, "work_precision: a step or tolerance");
  if constexpr (requires { I::adaptive_step; }) {
    integrator.absolute_tolerance *= setting / integrator.relative_tolerance;
    integrator.relative_tolerance = setting;
  } else {
    options.step = setting;
    options.max_step_halvings = options.max_step_halvings.value_or(0);
  }
}

/// Breakpoints of a simulation, ascending [s]: those of its time functions and those of its options.
template <class Run>
std::vector<double> breakpoints_of(Run& simulation, RunOptions const& options) {
  auto const& of_model = simulation.system().layout().breakpoints;
  std::vector<double> all(of_model.begin(), of_model.end());
  all.insert(all.end(), options.breakpoints.begin(), options.breakpoints.end());
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace detail

/// Runs the case that `make_case(formulation)` returns and records its output number `output`, as a reference for other
/// integrators. The `setting` is a step h [s] or a tolerance. The interpolation error between recorded times is about
/// h⁴ d⁴y/dt⁴/43, so the step must be short. An integrator with step size control uses at least 4000 steps.
template <class C, class F>
  requires ComparisonCase<C, F>
OutputHistory reference_run(C const& make_case, F const& formulation, double setting, std::size_t output = 0) {
  auto scenario = make_case(formulation);
  auto const& value = detail::output_of(scenario, output, "reference_run").value;
  auto integrator = formulation.integrator;
  RunOptions& options = scenario.options;
  detail::set_accuracy(integrator, options, setting);
  State x = scenario.start;
  double const longest = (options.end_time - x.t) / 4000.0;
  if constexpr (requires { decltype(integrator)::adaptive_step; })
    if (longest > 0.0) options.max_step = std::min(options.max_step.value_or(longest), longest);
  OutputHistory out;
  auto simulation = simulate(scenario.model, x, integrator, options);
  out.breakpoints = detail::breakpoints_of(simulation, options);
  for (State const& now : simulation) {
    out.times.push_back(now.t);
    out.values.push_back(value(scenario.model, now));
  }
  return out;
}

/// Work-precision curve of the case that `make_case(formulation)` returns, with one run for each of the `settings`. A
/// setting is the step [s], or the relative tolerance of an integrator with step size control. The error of the output
/// y is computed at the times t_k of the states, or at the end time T:
///   max_k |y(t_k) − y_ref(t_k)|  for a function of time or a `reference_run`,   |y(T) − y_ref|  for a number.
/// A failed step, for example one that is too long, ends its run but not the others; `failure` contains the message.
/// \throws InvalidInput if there are no settings, if a setting is not positive, or if the output does not exist.
template <class C, class F>
  requires ComparisonCase<C, F>
WorkCurve work_precision(C const& make_case, F const& formulation, std::vector<double> const& settings,
                         OutputReference const& reference, std::size_t output = 0) {
  auto scenario = make_case(formulation);
  auto const& y = detail::output_of(scenario, output, "work_precision");
  if (settings.empty())
    throw InvalidInput(
        "work_precision.settings",
        {ErrorObject{"work_precision"}, ": at least one step or tolerance is needed, but the list is empty."});
  WorkCurve curve{detail::name_of(formulation), y.name};
  for (double const setting : settings) {
    auto integrator = formulation.integrator;
    detail::set_accuracy(integrator, scenario.options, setting);
    WorkPoint& point = curve.points.emplace_back(WorkPoint{.setting = setting});
    auto const compare_at = [&](State const& x) {
      double const error = std::abs(y.value(scenario.model, x) - reference.at(x.t));
      if (!std::isfinite(error))
        throw NonFiniteValue("compare.error_not_finite", {"The error of \"", ErrorObject{y.name},
                                                          "\" is not finite at t = ", ErrorTime{x.t}, " s."});
      point.error = std::max(point.error, error);
    };
    State x = scenario.start, again = x;
    try {
      auto run = simulate(scenario.model, x, integrator, scenario.options);
      std::clock_t const begin = std::clock();
      point.steps = run.run().steps;
      point.cpu = double(std::clock() - begin) / CLOCKS_PER_SEC;
      if (reference.only_at_end)
        compare_at(x);
      else  // errors are computed in a second run, so that the timed run contains only steps
        for (State const& now : simulate(scenario.model, again, integrator, scenario.options)) compare_at(now);
    } catch (Error const& failed) {
      point.failure = failed.what();
    }
  }
  return curve;
}

}  // namespace polybody
