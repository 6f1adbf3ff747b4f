#include "stress_case.hpp"

#include <ctime>

#include <polybody/io/checkpoint.hpp>

#include "decoupled_link.hpp"
#include "surface.hpp"

namespace chapter4 {

namespace {

double cpu_of(auto&& work) {
  std::clock_t const begin = std::clock();
  work();
  return double(std::clock() - begin) / CLOCKS_PER_SEC;
}

// Stress of a link with its vibrations under the recorded loads, computed with the integrator of the run.
DecoupledStress vibrating(Options const& o, BodyRecord const& record) {
  return DecoupledStress::vibrating(structure_of_link(o), record, integrator(o),
                                    {.frame = ReferenceConditions::simply_supported(0, 2)}, loads(o));
}
DecoupledStress recovered(Options const& o, BodyRecord const& record) {
  if (o.recovery == "vibrating") return vibrating(o, record);
  return quasi_static(o, record);
}

// Completes a run and writes a checkpoint of the first state at or after the time `at` [s] to `file`. Returns the time
// of this state [s].
double put_away(Simulation<GeneralisedAlpha>& run, double at, fs::path const& file) {
  double done_at = -1.0;
  while (!run.done()) {
    run.advance();
    if (done_at >= 0.0 || run.state().t < at) continue;
    write_checkpoint(file, run.snapshot());
    done_at = run.state().t;
  }
  return done_at;
}

Built built_of(Options const& o, Combination const& c) {
  return build(o, [&](VehicleParts const& parts) { return c.make(o, parts).vehicle; });
}

}  // namespace

Recording watch(Scenario<AnyModel>& scenario, WatchedLink const& link, std::shared_ptr<LinkHistory> const& history) {
  auto const before = scenario.observer;
  if (!link.rigid) {
    scenario.observer = [=, see = link.see](AnyModel const& model, State const& x) {
      before(model, x);
      see(x, *history);
    };
    return {};
  }
  auto const recorder = std::make_shared<LoadRecorder>(scenario.model.system());
  recorder->add(*link.rigid);
  scenario.observer = [=](AnyModel const& model, State const& x) {
    before(model, x);
    history->recording += cpu_of([&] { recorder->record(x); });
  };
  return {recorder, link.rigid};
}

void recover(Options const& o, Recording const& recording, LinkHistory& h) {
  BodyRecord const& record = recording.recorder->of(*recording.link);
  h.decoupled = true;
  h.recovery = cpu_of([&] {
    DecoupledStress const stress = recovered(o, record);
    h.strain = m113::link_strain(stress);
    h.bending = m113::link_bending(stress, section_height(o));
    for (double& strain : h.bending) strain /= o.young;
    if (o.surface) add_surface(h, o, record);
  });
  h.vibration = cpu_of([&] { h.vibrating = m113::link_strain(vibrating(o, record)); });
}

StressRuns run_of(Options const& o, Combination const& c) { return run_by(o, c.name(), c.make, integrator(o)); }

void restart(Options const& o, Combination const& c) {
  std::vector<Outcome> outcomes;
  auto const scenario = TrackCase{o, &outcomes}.scenario(c.name(), built_of(o, c));
  fs::path const file = o.out / (c.name() + ".checkpoint");
  State x = scenario.start;
  auto whole = simulate(scenario.model, x, integrator(o), scenario.options);
  double const at = put_away(whole, 0.5 * o.end_time, file);
  State y = scenario.start;
  auto rest = resume(scenario.model, y, integrator(o), scenario.options, read_checkpoint(file));
  while (!rest.done()) rest.advance();
  bool const same = x.t == y.t && x.q == y.q && x.v == y.v && x.a == y.a && x.lambda == y.lambda;
  std::printf("%s: checkpoint at %.4g s, resumed, run to %.4g s: %s\n", c.name().c_str(), at, y.t,
              same ? "bitwise identical" : "NOT identical");
  if (!same) throw Error("The final state of the resumed run differs from that of the full run.");
}

}  // namespace chapter4
