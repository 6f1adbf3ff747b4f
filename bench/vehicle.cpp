// Cost of a step of the tracked vehicle with every combination of links and pins (Chapters 3 and 4), from a standstill.
// Names end with the options --body and --policy of track_stress, such as step/Rigid/Constraint. Options: [--until S]
// [--speed W]. Benchmarks:
// - step: run in steps of 1 ms. Counters: mean, 99.9 % quantile and maximum of a step, time of each part of a step,
//   flop limit of its factorisation [µs], and share of these parts in a step [%].
// - causes: the same run. Counters: share of the steps [%] in which so many contacts begin or end, and iterations and
//   factorisations of these steps.
// - variants: eight runs with speeds that differ by up to one percent. Counters: possible gain of SIMD lanes.
#include <ctime>
#include <numeric>

#include <polybody/integrators/step_tangent.hpp>

#include "../examples/vehicle_links/links.hpp"
#include "lockstep.hpp"
#include "registered.hpp"
#include "timing.hpp"

namespace {

using namespace chapter3;

double cpu() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// Times of the parts of an iteration and of a factorisation [µs].
struct Parts {
  double evaluation, residual, solution, writing, factorisation, limit;
};

/// Measures the parts at a state of a run, with all data in the cache as within a step.
Parts parts_of(AnyModel const& model, State const& full, GeneralisedAlpha const& integrator, double h) {
  RunSystems const systems = model.systems_of<GeneralisedAlpha>();
  System& system = *systems.stepped;
  State x = reduce(system, full);
  append_multipliers(system, x);
  AlphaMethod const m = integrator.method();
  TangentCoefficients const c{(1.0 - m.alpha_m) / (1.0 - m.alpha_f), m.gamma * h, m.beta * h * h};
  StepPosition const place{{x.q, x.v, x.t}, x.a, x.lambda};
  auto const write = [&](BlockSink& sink) { system.tangent(c, SecondOrder::omitted, x.lambda, sink); };
  StepTangent<StepSolver<BlockSolver>> tangent;
  tangent.analyse(system, SecondOrder::omitted, x.lambda);
  auto& linear = tangent.solver().linear_solver();
  VecX r(system.velocities()), rhs = VecX::Ones(system.velocities() + multipliers_of(system)), y = rhs;
  tangent.evaluate(system, place.at);
  tangent.balance(system, place, r);
  (void)tangent.factor(system, place, c);
  auto const nothing = [] {};
  std::vector<double> const us = timing::fastest({{nothing, [&] { tangent.evaluate(system, place.at); }},
                                                  {nothing, [&] { tangent.balance(system, place, r); }},
                                                  {nothing, [&] { tangent.correct(rhs, y); }},
                                                  {nothing, [&] { (void)tangent.factor(system, place, c); }},
                                                  {[&] {
                                                     linear.begin();
                                                     BlockSink sink(linear);
                                                     write(sink);
                                                   },
                                                   [&] { (void)linear.factor(); }}},
                                                 101);
  double const numeric = us[4];
  return {us[0], us[1], us[2], us[3] - numeric, numeric, linear.flops() / timing::eigen_rate()};
}

/// Model of a combination, ready to run.
struct Drive {
  LinkSettings const& o;
  Built built;
  AnyModel const& model = built.vehicle.model;
  State x = {};

  Drive(LinkSettings const& options, LinksOnPins const& combination) : o(options), built(built_of(o, combination)) {}
  Index unknowns() const { return problem_size(model).velocities + problem_size(model).rows; }
  Simulation<GeneralisedAlpha> run() {
    x = model.reference_state();
    return simulate(model, x, integrator(o), {.end_time = o.end_time, .step = o.step, .max_step_halvings = 6});
  }
};

void measure(benchmark::State& state, LinkSettings const& o, LinksOnPins const& combination) {
  Drive drive(o, combination);
  std::vector<double> times;
  registered::time_runs(
      state, drive.unknowns(), [&] { return drive.run(); },
      [&](Simulation<GeneralisedAlpha>& run) {
        times.clear();
        while (!run.done()) {
          double const before = cpu();
          run.advance();
          times.push_back(1e6 * (cpu() - before));
        }
      });
  double const sum = std::accumulate(times.begin(), times.end(), 0.0), steps = double(times.size());
  std::sort(times.begin(), times.end());
  auto& counters = state.counters;
  counters["mean"] = sum / steps;
  counters["99.9 %"] = times[times.size() - 1 - times.size() / 1000];
  counters["largest"] = times.back();
  Parts const p = parts_of(drive.model, drive.x, integrator(o), o.step);
  counters["evaluation"] = p.evaluation;
  counters["residual"] = p.residual;
  counters["solution"] = p.solution;
  counters["writing"] = p.writing;
  counters["factorisation"] = p.factorisation;
  counters["flop limit"] = p.limit;
  counters["share"] = 100.0 *
                      (counters["newton_iterations"] * (p.evaluation + p.residual + p.solution) +
                       counters["factorisations"] * (p.writing + p.factorisation)) /
                      sum;
}

/// Active contact points in ascending order. The number of a contact point is a hash of its track, link and contact
/// partner.
std::vector<std::size_t> touching(AnyVehicle const& vehicle, System& system, State const& x) {
  system.evaluate(x.q, x.v, x.t);
  std::vector<std::size_t> points;
  for (m113::Side const side : {m113::Side::left, m113::Side::right})
    vehicle.tracks->track(side).contacts(system, [&](TouchingPoint const& p) {
      std::size_t const pair =
          std::hash<std::string>{}(*p.against) ^ (std::size_t(p.body) << 16) ^ (std::size_t(side) << 32);
      points.push_back(pair);
    });
  std::sort(points.begin(), points.end());
  return points;
}

/// Counts iterations and factorisations of steps by the number of contacts that begin or end within the step.
void causes(benchmark::State& state, LinkSettings const& o, LinksOnPins const& combination) {
  Drive drive(o, combination);
  RunSystems const systems = drive.model.systems_of<GeneralisedAlpha>();
  System& full = systems.full ? *systems.full : *systems.stepped;
  struct Class {
    std::size_t most;  // greatest number of contacts that begin or end
    char const* name;
    double steps = 0.0, iterations = 0.0, factorisations = 0.0;
  };
  std::vector<Class> classes;
  auto const classify = [&](Simulation<GeneralisedAlpha>& run) {
    classes = {{0, "none"}, {2, "1 or 2"}, {5, "3 to 5"}, {10, "6 to 10"}, {std::size_t(-1), "more"}};
    std::vector<std::size_t> before = touching(drive.built.vehicle, full, run.now()), after, changed;
    long iterations = 0, factorisations = 0;
    while (!run.done()) {
      run.advance();
      after = touching(drive.built.vehicle, full, run.now());
      changed.clear();
      std::set_symmetric_difference(before.begin(), before.end(), after.begin(), after.end(),
                                    std::back_inserter(changed));
      Class& of =
          *std::find_if(classes.begin(), classes.end(), [&](Class const& c) { return changed.size() <= c.most; });
      of.steps += 1.0;
      of.iterations += double(run.report().iterations - iterations);
      of.factorisations += double(run.report().factorisations - factorisations);
      iterations = run.report().iterations;
      factorisations = run.report().factorisations;
      before.swap(after);
    }
  };
  registered::time_runs(state, drive.unknowns(), [&] { return drive.run(); }, classify);
  for (Class const& c : classes) {
    state.counters[c.name + std::string(": share")] = 100.0 * c.steps / state.counters["steps"];
    state.counters[c.name + std::string(": iterations")] = c.iterations / c.steps;
    state.counters[c.name + std::string(": factorisations")] = c.factorisations / c.steps;
  }
}

void variants(benchmark::State& state, LinkSettings const& options, LinksOnPins const& combination) {
  LinkSettings o = options;
  for (auto _ : state) {
    std::vector<lockstep::Counts> runs;
    Parts p = {};
    for (double const by : {0.0, 1e-5, 1e-4, 1e-3, 1e-2, -1e-2, -1e-4, -1e-3}) {
      o.speed = options.speed * (1.0 + by);
      Drive drive(o, combination);
      auto run = drive.run();
      runs.push_back(lockstep::counts_of(run));
      if (by == 0.0) p = parts_of(drive.model, drive.x, integrator(o), o.step);
    }
    lockstep::count(state, runs, p.evaluation + p.residual + p.solution, p.writing + p.factorisation);
  }
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  LinkSettings o;
  o.step = 1e-3;
  o.rho = 0.5;
  o.speed = 30.0;
  o.end_time = 4.0;
  o.masses = m113::with_steel_links(o.masses);
  o.files = POLYBODY_TRACK_LINK_FILES;
  for (int i = 1; i < argc; i += 2) {
    std::string const name = argv[i];
    if (i + 1 == argc || (name != "--until" && name != "--speed"))
      return std::fprintf(stderr,
                          "bench_vehicle: unknown option %s. The options are --until S, --speed W and those of Google "
                          "Benchmark.\n",
                          argv[i]),
             1;
    (name == "--until" ? o.end_time : o.speed) = std::stod(argv[i + 1]);
  }
  using Measure = void (*)(benchmark::State&, LinkSettings const&, LinksOnPins const&);
  std::pair<char const*, Measure> const families[] = {{"step/", measure}, {"causes/", causes}, {"variants/", variants}};
  for (auto const& [family, act] : families)
    for (LinksOnPins const& c : all_links())
      if (c.refusals.front().empty())
        registered::add(family + registered::type_name(c.body.name) + '/' + registered::type_name(c.policy),
                        [=, act = act](benchmark::State& state) { act(state, o, c); })
            ->Iterations(1);
  benchmark::RunSpecifiedBenchmarks();
}
