#pragma once
/// \file
/// Requirements of runs with derivatives, and the exceptions if they are not satisfied.

#include <array>
#include <string>
#include <vector>

#include <polybody/gradients/parameter.hpp>
#include <polybody/integrators/alpha_method.hpp>
#include <polybody/run/run_options.hpp>

namespace polybody::detail {

template <class = void>
std::vector<double> values_of(std::vector<Parameter> const& parameters) {
  std::vector<double> p;
  for (Parameter const& one : parameters) p.push_back(one.value);
  return p;
}

/// \throws InvalidInput if the options contain step halving or minimum-norm multipliers. The message begins with `who`.
template <class = void>
void require_plain(RunOptions const& o, char const* who) {
  if (o.max_step_halvings.value_or(0) > 0 || o.minimum_norm)
    throw InvalidInput(
        "derivative.options",
        {ErrorObject{who},
         ": a run with halved steps or minimum-norm multipliers is not differentiable. Remove max_step_halvings and "
         "minimum_norm from the options."});
}

/// \throws InvalidInput if the model for another value of p has a different number of unknowns, outputs, events or
/// breakpoints, or eliminates other coordinates. The message begins with `who`.
template <class V>
void require_alike(V const& model, V const& other, Parameter const& p, char const* who) {
  auto const sizes = [](V const& v) {
    return std::array{v.system.coordinates(),
                      v.system.velocities(),
                      v.system.rows(),
                      Index(v.scenario.outputs.size()),
                      Index(v.scenario.options.events.size()),
                      Index(v.breakpoints().size())};
  };
  static constexpr std::array names{"coordinates", "velocities", "constraint equations",
                                    "outputs",     "events",     "breakpoints"};
  auto const there = sizes(other), here = sizes(model);
  for (std::size_t i = 0; i < names.size(); ++i)
    if (there[i] != here[i])
      throw InvalidInput("derivative.sizes",
                         {ErrorObject{who}, ": for another value of \"", p.name,
                          "\" the function that makes the model returns a different size: ", ErrorValue{there[i]}, " ",
                          names[i], " instead of ", here[i],
                          ". Parameters may change values, but not the numbers of bodies, joints, forces, outputs, "
                          "events and breakpoints."});
  Coordinates const &own = model.system.step_coordinates(), &changed = other.system.step_coordinates();
  if (own && changed.reduced->full_velocity != own.reduced->full_velocity)
    throw InvalidInput(
        "derivative.elimination",
        {ErrorObject{who}, ": a change of \"", p.name,
         "\" changes the coordinates that AncfLinear eliminates (a marker crosses the middle between two "
         "nodes). Move the marker, or use Constraint for these joints."});
}

/// Returns `left`, the relative change of the derivatives in the last correction of the step to t [s]. \throws
/// NewtonConvergenceFailure if `left` is above 10⁻⁶. The message begins with `who`.
template <class = void>
double require_converged(double left, double t, char const* who) {
  if (left <= 1e-6) return left;
  throw NewtonConvergenceFailure("derivative.not_converged",
                                 {ErrorObject{who}, ": the derivatives of the step to t = ", ErrorTime{t},
                                  " s do not converge; the relative change in the last correction is ",
                                  ErrorValue{left}, ". Take a smaller step there, or softer contacts."});
}

/// Breakpoints of a run [s], not sorted: first those of driving constraints and loads, then those of the options.
template <class = void>
std::vector<double> breakpoints_of(System const& system, RunOptions const& options) {
  Sequence<double> const& own = system.layout().breakpoints;
  std::vector<double> all(own.begin(), own.end());
  all.insert(all.end(), options.breakpoints.begin(), options.breakpoints.end());
  return all;
}

/// Requested length of the steps, or of the first step if the integrator chooses the lengths [s].
template <class = void>
double length_of_steps(RunOptions const& o) {
  return o.max_step ? std::min<double>(o.step, *o.max_step) : double(o.step);
}

/// Values of the outputs of a scenario at x. \throws NonFiniteValue if a value is not finite.
template <class S>
VecX values_of_outputs(S const& scenario, State const& x) {
  VecX out(Index(scenario.outputs.size()));
  for (Index i = 0; i < out.size(); ++i) {
    auto const& output = scenario.outputs[std::size_t(i)];
    out[i] = output.value(scenario.model, x);
    if (!std::isfinite(out[i]))
      throw NonFiniteValue("output.not_finite", {"sensitivities: \"", ErrorObject{output.name}, "\"",
                                                 non_finite_suffix(out[i]), " at t = ", ErrorTime{x.t}, " s."});
  }
  return out;
}

/// Integrator of the generalised-α family.
template <class I>
concept AlphaFamilyIntegrator = requires(I const integrator) {
  { integrator.method() } -> std::convertible_to<AlphaMethod>;
};

/// Method for a run with derivatives, with a tolerance of at most 10⁻¹² and no budget of iterations. \throws
/// InvalidInput for invalid parameters or options of the integrator, and for a stabilised integrator.
template <AlphaFamilyIntegrator I>
AlphaMethod method_of_derivatives(std::vector<Parameter> const& parameters, I const& integrator, char const* who) {
  integrator.check();
  check(parameters);
  AlphaMethod method = integrator.method();
  if (method.stabilised)
    throw InvalidInput("derivative.options",
                       {ErrorObject{who}, ": a stabilised step has no derivative. Set `stabilised` to false."});
  method.tolerance = std::min(method.tolerance, 1e-12);
  method.newton.budget = 0.0;
  return method;
}

/// Runge–Kutta method for a run with derivatives. An implicit method gets a tolerance of at most 10⁻¹² and no budget of
/// iterations. \throws InvalidInput for invalid parameters or options of the integrator.
template <class I>
MethodOf<I> method_of_stages(std::vector<Parameter> const& parameters, I const& integrator) {
  check(parameters);
  MethodOf<I> method = method_of(integrator);
  if constexpr (requires { method.newton.budget; }) {
    method.tolerance = std::min(method.tolerance, 1e-12);
    method.newton.budget = 0.0;
  }
  return method;
}

}  // namespace polybody::detail
