#include <ctime>

#include <polybody/io/checkpoint.hpp>
#include <polybody/signals/filter.hpp>

#include "../vehicle_links/surface.hpp"
#include "decoupled_link.hpp"
#include "stress_film.hpp"

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

// Data for the computation of the strain of a rigid link after the run.
struct Recording {
  std::shared_ptr<LoadRecorder> recorder = {};
  std::optional<RigidLink> link = {};
};

// Adds an observer of each state, which appends the outputs of a flexible link to `history` or records the loads of a
// rigid link.
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
  link.rigid->add(*recorder);
  scenario.observer = [=](AnyModel const& model, State const& x) {
    before(model, x);
    history->recording += cpu_of([&] { recorder->record(x); });
  };
  return {recorder, link.rigid};
}

void recover(Options const& o, Recording const& recording, LinkHistory& h) {
  BodyRecord const& record = recording.link->record(*recording.recorder);
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

// Interpolates the histories at equal time steps. In a run with a sampling interval, a recorded state is up to one step
// later than its sampling time.
void take_equal_steps(StressRuns& runs, double step) {
  ComparedRun& r = runs.comparison.runs[0];
  auto const spaced = [&](std::vector<double>& x) {
    if (!x.empty()) x = resampled(r.times, x, step, 2.5 * step);
  };
  for (std::vector<double>& output : r.outputs) spaced(output);
  LinkHistory& link = *runs.links[0];
  for (std::vector<double>* const x : {&link.strain, &link.bending, &link.vibrating}) spaced(*x);
  for (auto& [name, stress] : link.surface) spaced(stress);
  double const start = r.times.front();
  r.times.resize(link.strain.size());
  for (std::size_t i = 0; i < r.times.size(); ++i) r.times[i] = start + double(i) * step;
}

}  // namespace

Options::Options() {
  masses = m113::with_steel_links();
  step = 1e-3;
  rho = 0.5;
  speed = m113::fast_sprocket_velocities[0];
  sampled = sampled_below = 1e-4;
  out = "out/track_stress";
}

std::string Options::policy() const {
  if (selection.policies.size() > 1)
    throw InvalidInput{"This comparison has one policy of the pins, but ", ErrorValue{selection.policies.size()},
                       " are selected."};
  return selection.policies.empty() ? "" : selection.policies.front();
}

std::string name_of(Combination const& c) { return c.links.body.name + (c.links.usual ? "" : ", " + c.links.policy); }

StressRuns run_of(Options const& options, Combination const& c, std::string const& name) {
  Options o = options;
  static_cast<LinkSettings&>(o) = with_steps(options, c);
  WatchedLink link;
  Built const built = build(o, [&](VehicleParts const& parts) {
    LinkVehicle made = c.links.make(o, parts);
    link = made.link;
    return made.vehicle;
  });
  StressRuns runs;
  auto const history = runs.links.emplace_back(std::make_shared<LinkHistory>());
  Recording recording;
  StressScene film(o, name, built.vehicle, link);
  runs.comparison = run_scenario(o, c, name, [&] {
    auto scenario = TrackCase{o, &runs.outcomes, film.scene()}.scenario(name, built);
    recording = watch(scenario, link, history);
    return scenario;
  });
  if (recording.recorder) recover(o, recording, *history);
  film.finish(o, runs.times(0), *history);
  if (o.sampling > 0.0) take_equal_steps(runs, o.sampling);
  return runs;
}

StressRuns run(Options const& o, std::vector<Combination> const& combinations) {
  warn_of_drive(o);
  StressRuns all;
  std::vector<Comparison> apart;
  for (Combination const& c : combinations) {
    require_turning(o, c.links);
    Options mine = o;
    std::string name = name_of(c);
    if (combinations.size() > 1 && name != "rigid" && name != "ancf") mine.film = nullptr;
    if (o.selection.integrators.size() > 1) name += ", " + integrator_name(c);
    StressRuns one = run_of(mine, c, name);
    for (ComparedRun const& r : one.comparison.runs)
      for (auto const& met : r.run.events) std::cerr << r.name << ": at " << met.time << " s " << met.name << ".\n";
    apart.push_back(std::move(one.comparison));
    all.outcomes.insert(all.outcomes.end(), one.outcomes.begin(), one.outcomes.end());
    all.links.insert(all.links.end(), one.links.begin(), one.links.end());
  }
  all.comparison = join(apart);
  return all;
}

void restart(Options const& o, Combination const& c) {
  if (integrator_name(c) != "generalised-alpha")
    throw InvalidInput{"--restart needs --integrator generalised-alpha, but the integrator is ",
                       ErrorObject{integrator_name(c)}, "."};
  std::vector<Outcome> outcomes;
  auto const scenario = TrackCase{o, &outcomes}.scenario(name_of(c), built_of(o, c.links));
  fs::path const file = o.out / (name_of(c) + ".checkpoint");
  State x = scenario.start;
  auto whole = simulate(scenario.model, x, integrator(o), scenario.options);
  double const at = put_away(whole, 0.5 * o.end_time, file);
  State y = scenario.start;
  auto rest = resume(scenario.model, y, integrator(o), scenario.options, read_checkpoint(file));
  while (!rest.done()) rest.advance();
  bool const same = x.t == y.t && x.q == y.q && x.v == y.v && x.a == y.a && x.lambda == y.lambda;
  std::printf("%s: checkpoint at %.4g s, resumed, run to %.4g s: %s\n", name_of(c).c_str(), at, y.t,
              same ? "bitwise identical" : "NOT identical");
  if (!same) throw Error("The final state of the resumed run differs from that of the full run.");
}

}  // namespace chapter4
