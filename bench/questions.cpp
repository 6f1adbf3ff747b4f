// Cost of evaluations of the states of a run: a chain of 64 rigid links, a step of 1 ms, then the energy, and the
// constraint violation and the reaction of a joint. The program measures the evaluations by the run, the same
// evaluations again for the same state, and the functions of model and state. Target: evaluations by the run cost at
// most a tenth of the step.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <polybody/polybody.hpp>

#include "timing.hpp"

namespace {

using namespace polybody;
using Pin = Joint<Spherical, Constraint>;

double median(std::vector<double>& times) {
  std::nth_element(times.begin(), times.begin() + std::ptrdiff_t(times.size() / 2), times.end());
  return times[times.size() / 2];
}

}  // namespace

int main() {
  Model<Bodies<Rigid<>>, Joints<Pin>> model{Gravity{0, 0, -9.81}};
  std::vector<BodyHandle<Rigid<>>> links;
  std::vector<ElementHandle<Pin>> pins;
  for (int i = 0; i < 64; ++i) {
    links.push_back(model.add(Rigid<>::from({.length = 1.0,
                                             .section = Circle{.radius = 0.01},
                                             .material = Material{.density = 7800, .young = 2e11},
                                             .placement = Placement::at({double(i), 0, 0})})));
    if (i == 0)
      pins.push_back(model.connect(Pin{}, model.ground().at({0, 0, 0}), links[0].at(0.0)));
    else
      pins.push_back(model.connect(Pin{}, links[std::size_t(i - 1)].at(1.0), links[std::size_t(i)].at(0.0)));
  }
  State x = model.reference_state();
  std::vector<double> step, first, again, functions;
  auto run = simulate(model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 0.5, .step = 1e-3});
  ObservedState const& now = run.now();
  double sum = 0.0;
  auto const ask = [&] {
    sum += now.energy().total() + now.constraint_violation(pins[32]).norm() + now.reaction(pins[32]).f.norm();
  };
  while (!run.done()) {
    step.push_back(timing::microseconds([&] { run.advance(); }));
    first.push_back(timing::microseconds(ask));
    again.push_back(timing::microseconds(ask));
    functions.push_back(timing::microseconds([&] {
      sum += energy(model, x).total() + constraint_violation(model, x, pins[32]).norm() +
             reaction(model, x, pins[32]).f.norm();
    }));
  }
  benchmark::DoNotOptimize(sum);
  double const of_step = median(step), asked = median(first);
  std::printf(
      "step %.1f us; energy, violation and reaction: of the run %.2f us (%.3f of the step), again %.2f us, "
      "by functions of model and state %.1f us\n",
      of_step, asked, asked / of_step, median(again), median(functions));
  return 0;
}
