#pragma once
/// \file
/// Derivatives of a whole run with respect to numbers of its model, by direct differentiation of its steps:
///
///     auto const make = [](std::span<double const> p) { … return Scenario<M>{model, start, options, outputs}; };
///     SensitivityResult const s = sensitivities(make, {{"length [m]", 1.0}}, GeneralisedAlpha{});
///     s.slopes.back()(0, 0);   // of the first output by the first parameter at the end of the run
///
/// They are those of the discrete run: of the numbers that its steps give, not of the motion that these approximate. A
/// model is made for nearby values, and only its equations at given unknowns are differenced (FourPoints: relative
/// errors of 1e-12), never a run. Steps are differentiated exactly (`AlphaLinearisedStep`), by their lengths too:
/// corners and events end steps at times that move with the parameters. A start, what an event does to a state, and the
/// correction of the speeds that a step of another length sets out with, are maps from state to state that are
/// differenced.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/gradients/alpha_sensitivities.hpp>
#include <polybody/gradients/forward_sensitivities.hpp>
#include <polybody/gradients/stage_sensitivities.hpp>

namespace polybody {

/// A user's factory: a scenario of a model for the values of the parameters, in their order.
template <class F>
concept ScenarioFactory = requires(F const make, std::span<double const> p) {
  { make(p).model };
  { make(p).start } -> std::convertible_to<State>;
  { make(p).outputs };
};

/// Runs the scenario that `make` gives for the parameters' values and differentiates its outputs with respect to each.
/// Newton's corrections go on to 1e-12 or to what rounding leaves. \param integrator one of the generalised-α family,
/// without `stabilised`; with their headers (runge_kutta_step_slope.hpp, radau_step_slope.hpp) RungeKutta4,
/// DormandPrince, whose choice of steps stays as it is but where an event, a corner or the end of the run ends one, and
/// Radau. \throws InvalidInput for parameters that cannot be meant, a factory whose models differ in size, an event
/// that only touches zero, events or corners that come at once and part with a parameter, a parameter that changes
/// equations of what it does not name as touched, at the start or at the end; SingularMatrix at a singular
/// position; and as `simulate`.
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
