#pragma once
/// \file
/// Derivatives of a whole run with respect to parameters of its model, by forward differentiation of its steps:
///
///     auto const make = [](std::span<double const> p) { … return Scenario<M>{model, start, options, outputs}; };
///     SensitivityResult const s = sensitivities(make, {{"length [m]", 1.0}}, GeneralisedAlpha{});
///     s.derivatives.back()(0, 0);   // derivative of output 0 with respect to parameter 0 at the end of the run
///
/// The results are derivatives of the discrete run, that is of its computed values, not of the exact motion. The
/// factory makes models for nearby parameter values. Only their equations at given unknowns are differenced
/// (FourPoints: relative errors of 1e-12), never a run. Steps are differentiated exactly (`AlphaLinearisedStep`), also
/// with respect to their lengths, since breakpoints and events end steps at times that depend on the parameters. Three
/// maps from state to state are differenced: a start, an event action, and the start correction after a change of the
/// step length.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <polybody/gradients/alpha_sensitivities.hpp>
#include <polybody/gradients/forward_sensitivities.hpp>
#include <polybody/gradients/stage_sensitivities.hpp>

namespace polybody {

/// User function that makes the scenario of a model from the values of the parameters, in their order.
template <class F>
concept ScenarioFactory = requires(F const make, std::span<double const> p) {
  { make(p).model };
  { make(p).start } -> std::convertible_to<State>;
  { make(p).outputs };
};

/// Runs the scenario that `make` returns for the values of the parameters, and differentiates its outputs with respect
/// to each parameter. Newton's method converges to 1e-12 or to round-off. \param integrator of the generalised-α
/// family, without `stabilised`; with runge_kutta_linearised_step.hpp also RungeKutta4 and DormandPrince; with
/// radau_linearised_step.hpp also Radau. Step lengths of DormandPrince are constants, unless an event, a breakpoint or
/// the end of the run ends the step. \throws InvalidInput for invalid parameters; if models of the factory differ in
/// size; if an event only touches zero; if events or breakpoints coincide and a parameter separates them; if a
/// parameter changes equations of an object outside its `affects`. \throws SingularMatrix in a singular configuration;
/// and the exceptions of `simulate`.
template <ScenarioFactory Make, class I>
SensitivityResult sensitivities(Make const& make, std::vector<Parameter> const& parameters, I const& integrator) {
  if constexpr (detail::AlphaFamilyIntegrator<I>) {
    AlphaMethod const method = detail::method_of_derivatives(parameters, integrator, "sensitivities");
    return detail::ForwardSensitivities<Make, I, detail::AlphaSensitivities>(make, parameters, method).run();
  } else {
    static_assert(detail::HasStageDerivatives<I>,
                  "sensitivities supports GeneralisedAlpha, HhtAlpha, Newmark and Trapezoidal; with "
                  "<polybody/gradients/runge_kutta_linearised_step.hpp> also RungeKutta4 and DormandPrince, with "
                  "<polybody/gradients/radau_linearised_step.hpp> also Radau.");
    MethodOf<I> const method = detail::method_of_stages(parameters, integrator);
    return detail::ForwardSensitivities<Make, I, detail::StageSensitivities>(make, parameters, method).run();
  }
}

}  // namespace polybody
