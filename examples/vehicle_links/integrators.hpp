#pragma once
// Integrators of the vehicle that the option --integrator selects.
#include <polybody/polybody.hpp>

#include "links.hpp"

namespace chapter3 {

using Adams = AdamsBashforthMoulton<CoordinatePartitioning>;
using RungeKutta = RungeKutta4<CoordinatePartitioning>;

inline auto integrators(LinkSettings const& o) {
  double const newton = o.tolerance > 0.0 ? o.tolerance : 1e-5, error = o.tolerance > 0.0 ? o.tolerance : 1e-6;
  using combinations::NamedIntegrator;
  return std::tuple(NamedIntegrator<GeneralisedAlpha>{"generalised-alpha", {.rho_inf = o.rho, .tolerance = newton}},
                    NamedIntegrator<HhtAlpha>{"hht", {.alpha = (o.rho - 1.0) / (o.rho + 1.0), .tolerance = newton}},
                    NamedIntegrator<Newmark>{"newmark", {.tolerance = newton}},
                    NamedIntegrator<Radau>{"radau", {.tolerance = newton}},
                    NamedIntegrator<EnergyMomentum>{"energy-momentum", {.tolerance = newton}},
                    NamedIntegrator<RungeKutta>{"runge-kutta", {}},
                    NamedIntegrator<Adams>{"adams", {.relative_tolerance = error, .absolute_tolerance = error}},
                    NamedIntegrator<DormandPrince<Projection>>{
                        "dormand-prince", {.relative_tolerance = error, .absolute_tolerance = error}});
}
using Integrators = decltype(integrators(LinkSettings()));

}  // namespace chapter3
