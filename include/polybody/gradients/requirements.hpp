#pragma once
/// \file
/// What runs must be to be differentiated; refusals in words.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

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

/// \throws InvalidInput, beginning with `who`, for options with what is not differentiated.
template <class = void>
void require_plain(RunOptions const& o, char const* who) {
  if (!o.events.empty() || !o.corners.empty() || o.halvings > 0 || o.minimum_norm)
    throw InvalidInput{who,
                       ": a run with events, corners, halved steps or multipliers of least norm is not differentiated. "
                       "Leave them out of the options."};
}

/// \throws InvalidInput, beginning with `who`, unless the model of another value of p has as many unknowns, outputs,
/// events and corners.
template <class V>
void require_alike(V const& model, V const& other, Parameter const& p, char const* who) {
  auto const sizes = [](V const& v) {
    return std::array{v.system.coordinates(),
                      v.system.speeds(),
                      v.system.rows(),
                      Index(v.scenario.outputs.size()),
                      Index(v.scenario.options.events.size()),
                      Index(v.corners().size())};
  };
  if (sizes(other) != sizes(model))
    throw InvalidInput{who, ": with another \"", p.name,
                       "\" the factory makes a model of other sizes. Let parameters change numbers, not what is "
                       "there."};
}

/// Runs of this model by this integrator are differentiated.
template <class M, class I>
constexpr void require_differentiable() {
  static_assert(!M::eliminates,
                "Steps in joint coordinates, and with dependent coordinates eliminated, are not differentiated. Give "
                "the joints Constraint, Penalty or Bushing.");
  static_assert(
      requires(I const& integrator) {
        { integrator.method() } -> std::convertible_to<AlphaMethod>;
      }, "Runs are differentiated under the generalised-α family: GeneralizedAlpha, HhtAlpha, Newmark, Trapezoidal.");
}

/// The method by which a run is differentiated: its corrections go on to 1e-12. \throws InvalidInput, beginning with
/// `who`, for parameters and integrators that cannot be meant.
template <class I>
AlphaMethod method_of_slopes(std::vector<Parameter> const& parameters, I const& integrator, char const* who) {
  integrator.check();
  check(parameters);
  AlphaMethod method = integrator.method();
  if (method.stabilised)
    throw InvalidInput{who, ": a stabilised step is not differentiated. Set `stabilised` to false."};
  method.tolerance = std::min(method.tolerance, 1e-12);
  method.newton.budget = 0.0;
  return method;
}

}  // namespace polybody::detail
