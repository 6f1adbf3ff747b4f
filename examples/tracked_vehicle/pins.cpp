#include "pins.hpp"

#include "integrators.hpp"

namespace chapter3 {

namespace {

// Runs the vehicle with an integrator, with fixed steps or with step size control. `step` is the default of the step
// [s].
template <class I>
Runs run_by(Options o, Pins const& pins, I const& integrator, double step = implicit_step) {
  if (o.step == 0.0) o.step = step;
  if constexpr (requires { I::adaptive_step; }) o.first_step = std::min(1e-5, o.step);
  if (o.first_step > 0.0 || o.step < implicit_step) o.sampling = std::max(o.step, implicit_step);
  Runs runs;
  runs.sampling = o.sampling;
  runs.comparison =
      require_complete(compare(TrackCase{o, &runs.outcomes}, Driven<I>{pins.name, build(o, pins.make), integrator}));
  return runs;
}

}  // namespace

Runs Pins::run(Options const& o) const {
  double const newton = o.tolerance > 0.0 ? o.tolerance : 1e-5, error = o.tolerance > 0.0 ? o.tolerance : 1e-6;
  if (o.integrator == "hht")
    return run_by(o, *this, HhtAlpha{.alpha = (o.rho - 1.0) / (o.rho + 1.0), .tolerance = newton});
  if (o.integrator == "radau") return run_by(o, *this, Radau{.tolerance = newton});
  if (o.integrator == "adams") return run_by(o, *this, Adams{.relative_tolerance = error, .absolute_tolerance = error});
  if (o.integrator == "dormand-prince")
    return run_by(o, *this, DormandPrince{.relative_tolerance = error, .absolute_tolerance = error});
  if (o.integrator == "rk") return run_by(o, *this, RungeKutta{}, bearable);
  return run_by(o, *this, GeneralisedAlpha{.rho_inf = o.rho, .tolerance = newton});
}

ProblemSize Pins::count(Options const& o) const {
  Ramp const drive = m113::drive(o.speed);
  return problem_size(make({course(false), {drive, drive}, {.ground_body = true}}).model);
}

}  // namespace chapter3
