#pragma once
// Integrators that the option --integrator selects.
#include <polybody/polybody.hpp>
#include <polybody/run/any_model.hpp>

namespace chapter3 {

using Adams = polybody::AdamsBashforthMoulton<polybody::CoordinatePartitioning>;
using DormandPrince = polybody::DormandPrince<polybody::Projection>;
using RungeKutta = polybody::RungeKutta4<polybody::CoordinatePartitioning>;

inline constexpr polybody::SteppedBy<polybody::GeneralisedAlpha, polybody::HhtAlpha, polybody::Radau, Adams,
                                     DormandPrince, RungeKutta>
    by_each;

}  // namespace chapter3
