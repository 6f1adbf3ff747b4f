#pragma once
// Pins of one formulation under each integrator.
#include <polybody/compare/compare.hpp>

#include "pins.hpp"

namespace chapter3 {

// The run under an integrator that controls its step, or does not, with the steps that are its own.
template <class Body, class Policy, class I>
Runs run_by(Options o, std::string const& name, Policy const& policy, I const& integrator, double step) {
  if (o.step == 0.0) o.step = step;
  if constexpr (requires { I::controls_step; }) o.first_step = std::min(1e-5, o.step);
  if (o.first_step > 0.0 || o.step < implicit_step) o.sampling = std::max(o.step, implicit_step);
  Runs runs;
  runs.sampling = o.sampling;
  runs.comparison = compare(TrackCase{o, &runs.outcomes}, Formulation<Body, Policy, I>{name, policy, integrator});
  return runs;
}

// \param bearable longest steps of explicit methods: those of RungeKutta4 end at 2.8 over the fastest rate, which
// `track_times` prints [s]
template <class Body, class Policy>
Runs run_pins(Options const& o, std::string const& name, Policy const& policy, double bearable) {
  double const newton = o.tolerance > 0.0 ? o.tolerance : 1e-5, error = o.tolerance > 0.0 ? o.tolerance : 1e-6;
  auto const by = [&](auto const& integrator, double step = implicit_step) {
    return run_by<Body>(o, name, policy, integrator, step);
  };
  if (o.integrator == "hht") return by(HhtAlpha{.alpha = (o.rho - 1.0) / (o.rho + 1.0), .tolerance = newton});
  if (o.integrator == "radau") return by(Radau{.tolerance = newton});
  if (o.integrator == "adams")
    return by(AdamsBashforthMoulton<CoordinatePartitioning>{.relative_tolerance = error, .absolute_tolerance = error});
  if (o.integrator == "dormand-prince")
    return by(DormandPrince<Projection>{.relative_tolerance = error, .absolute_tolerance = error});
  if (o.integrator == "rk") return by(RungeKutta4<CoordinatePartitioning>{}, bearable);
  return by(GeneralizedAlpha{.rho_inf = o.rho, .tolerance = newton});
}

template <class Body, class Policy>
Pins pins_by(std::string const& name, Policy const& policy, double bearable) {
  return {name, [=](Options const& o) { return run_pins<Body>(o, name, policy, bearable); },
          [=](Options const& o) {
            Ramp const drive = m113::drive(o.speed);
            return census(
                m113::Vehicle<Body, Policy, BumpCourse>(policy, {drive, drive}, {.ground_body = true}, course(false))
                    .model);
          }};
}

}  // namespace chapter3
