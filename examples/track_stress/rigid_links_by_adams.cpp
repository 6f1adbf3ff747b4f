#include <polybody/signals/filter.hpp>

#include "../any_vehicle.hpp"
#include "stress_case.hpp"

namespace chapter4 {

namespace {

// Interpolates the histories at equal time steps. In a run with step size control, a recorded state is up to one step
// later than its sampling time.
void take_equal_steps(StressRuns& runs, double step) {
  ComparedRun& r = runs.comparison.runs[0];
  auto const spaced = [&](std::vector<double>& x) { x = resampled(r.times, x, step, 2.5 * step); };
  for (std::vector<double>& output : r.outputs) spaced(output);
  LinkHistory& link = *runs.links[0];
  for (std::vector<double>* const x : {&link.strain, &link.bending, &link.vibrating}) spaced(*x);
  double const start = r.times.front();
  r.times.resize(link.strain.size());
  for (std::size_t i = 0; i < r.times.size(); ++i) r.times[i] = start + double(i) * step;
}

}  // namespace

StressRuns rigid_links_by_adams(Options o) {
  using Adams = AdamsBashforthMoulton<CoordinatePartitioning>;
  o.film = nullptr;
  o.sampling = o.step;
  o.first_step = std::min(1e-5, o.step);
  auto const make = [](Options const&, VehicleParts const& parts) {
    auto const vehicle = made_vehicle<Rigid<>>(Constraint{}, parts);
    return StressVehicle{any_vehicle(vehicle, stepped_by<Adams>),
                         {.rigid = vehicle->side(m113::Side::left).links[watched_link]}};
  };
  StressRuns runs = run_by(o, "rigid, Adams", make, Adams{.relative_tolerance = 1e-6, .absolute_tolerance = 1e-6});
  take_equal_steps(runs, o.step);
  return runs;
}

}  // namespace chapter4
