// Cost of a step of the tracked vehicle with every combination of links and pins (Chapters 3 and 4): processor time per
// second of driving, mean, 99.9 % quantile and maximum of a step, counts of Newton's method, and the time of each part
// of a step with the flop limit of its factorisation. Options: bench_vehicle [--body X] [--policy Y] [--until S]
// [--speed W]. With --causes 1: iterations and factorisations of steps by the number of contacts that begin or end.
// With --variants 1: possible gain of eight vehicles in the lanes of SIMD vectors, with speeds that differ by up to one
// percent.
#include <ctime>

#include <cstdio>
#include <cstring>

#include <polybody/integrators/step_tangent.hpp>

#include "../examples/vehicle_links/links.hpp"
#include "lockstep.hpp"
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
  if (tangent.factor(system, place, c) >= 0) std::printf("no pivot\n");
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

void measure(LinkSettings const& o, LinksOnPins const& links) {
  Built const built = built_of(o, links);
  AnyModel const& model = built.vehicle.model;
  State x = model.reference_state();
  GeneralisedAlpha const by = integrator(o);
  Simulation<GeneralisedAlpha> run =
      simulate(model, x, by, {.end_time = o.end_time, .step = o.step, .max_step_halvings = 6});
  std::vector<double> times;
  double last = cpu();
  for (State const& state : run) {
    double const now = cpu();
    if (state.t > 0.0) times.push_back(1e6 * (now - last));
    last = cpu();
  }
  double sum = 0.0;
  for (double const t : times) sum += t;
  std::sort(times.begin(), times.end());
  double const steps = double(run.report().steps), iterations = double(run.report().iterations) / steps,
               factorisations = double(run.report().factorisations) / steps;
  Parts const p = parts_of(model, x, by, o.step);
  std::printf(
      "| `%s` | `%s` | %.2f | %.0f, %.0f, %.0f | %.2f, %.2f | %.0f, %.0f, %.0f | %.0f, %.0f (%.0f) | %.0f |\n",
      links.body.name.c_str(), links.policy.c_str(), 1e-6 * sum / o.end_time, sum / steps,
      times[times.size() - 1 - times.size() / 1000], times.back(), iterations, factorisations, p.evaluation, p.residual,
      p.solution, p.writing, p.factorisation, p.limit,
      100.0 * (iterations * (p.evaluation + p.residual + p.solution) + factorisations * (p.writing + p.factorisation)) *
          steps / sum);
  std::fflush(stdout);
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

/// Prints iterations and factorisations of steps by the number of contacts that begin or end within the step.
void causes(LinkSettings const& o, LinksOnPins const& links) {
  Built const built = built_of(o, links);
  AnyModel const& model = built.vehicle.model;
  State x = model.reference_state();
  Simulation<GeneralisedAlpha> run =
      simulate(model, x, integrator(o), {.end_time = o.end_time, .step = o.step, .max_step_halvings = 6});
  RunSystems const systems = model.systems_of<GeneralisedAlpha>();
  System& full = systems.full ? *systems.full : *systems.stepped;
  struct Class {
    std::size_t most;  // greatest number of contacts that begin or end
    double steps = 0.0, iterations = 0.0, factorisations = 0.0;
  };
  std::vector<Class> classes{{0}, {2}, {5}, {10}, {std::size_t(-1)}};
  std::vector<std::size_t> before, after, changed;
  double iterations = 0.0, factorisations = 0.0;
  for (State const& state : run) {
    after = touching(built.vehicle, full, state);
    auto const& report = run.report();
    if (state.t > 0.0) {
      changed.clear();
      std::set_symmetric_difference(before.begin(), before.end(), after.begin(), after.end(),
                                    std::back_inserter(changed));
      Class& of =
          *std::find_if(classes.begin(), classes.end(), [&](Class const& c) { return changed.size() <= c.most; });
      of.steps += 1.0;
      of.iterations += double(report.iterations) - iterations;
      of.factorisations += double(report.factorisations) - factorisations;
    }
    iterations = double(report.iterations);
    factorisations = double(report.factorisations);
    before.swap(after);
  }
  std::printf("| `%s` | `%s` |", links.body.name.c_str(), links.policy.c_str());
  for (Class const& c : classes)
    std::printf(" %.0f: %.2f, %.2f |", 100.0 * c.steps / double(run.report().steps), c.iterations / c.steps,
                c.factorisations / c.steps);
  std::printf("\n");
  std::fflush(stdout);
}

void variants(LinkSettings o, LinksOnPins const& links) {
  std::vector<lockstep::Counts> runs;
  double const speed = o.speed;
  double iteration = 0.0, factorisation = 0.0;
  for (double const by : {0.0, 1e-5, 1e-4, 1e-3, 1e-2, -1e-2, -1e-4, -1e-3}) {
    o.speed = speed * (1.0 + by);
    Built const built = built_of(o, links);
    AnyModel const& model = built.vehicle.model;
    State x = model.reference_state();
    Simulation<GeneralisedAlpha> run =
        simulate(model, x, integrator(o), {.end_time = o.end_time, .step = o.step, .max_step_halvings = 6});
    runs.push_back(lockstep::counts_of(run));
    if (by != 0.0) continue;
    Parts const p = parts_of(model, x, integrator(o), o.step);
    iteration = p.evaluation + p.residual + p.solution;
    factorisation = p.writing + p.factorisation;
  }
  lockstep::print("`" + links.body.name + "` on `" + links.policy + "`, speeds", runs, iteration, factorisation);
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  LinkSettings o;
  o.step = 1e-3;
  o.rho = 0.5;
  o.speed = 30.0;
  o.end_time = 4.0;
  bool of_variants = false, of_causes = false;
  std::string body, policy;
  o.masses = m113::with_steel_links(o.masses);
  for (int i = 1; i + 1 < argc; i += 2) {
    std::string const name = argv[i], value = argv[i + 1];
    if (name == "--body")
      body = value;
    else if (name == "--policy")
      policy = value;
    else if (name == "--until")
      o.end_time = std::stod(value);
    else if (name == "--speed")
      o.speed = std::stod(value);
    else if (name == "--causes")
      of_causes = value != "0";
    else if (name == "--variants")
      of_variants = value != "0";
    else
      return std::printf(
                 "bench_vehicle: unknown option %s. The options are --body, --policy, --until, --speed, --causes and "
                 "--variants.\n",
                 name.c_str()),
             1;
  }
  auto const each = [&](auto&& f) {
    for (LinksOnPins const& links : all_links())
      if (links.refusals.front().empty() && (body.empty() || body == links.body.name) &&
          (policy.empty() || policy == links.policy))
        f(o, links);
  };
  if (of_causes) {
    std::printf(
        "%g s from a standstill to %g rad/s, steps of 1 ms: share of the steps [%%] in which so many contacts come or "
        "go, and their iterations and factorisations\n\n| links | pins | none | 1 or 2 | 3 to 5 | 6 to 10 | more "
        "|\n|---|---|---|---|---|---|---|\n",
        o.end_time, o.speed);
    each(causes);
    return 0;
  }
  if (of_variants) {
    lockstep::print_head();
    each(variants);
    return 0;
  }
  std::printf(
      "%g s from a standstill to %g rad/s, steps of 1 ms; microseconds\n\n"
      "| links | pins | CPU a second [s] | step: mean, 99.9 %%, largest | iterations, factorisations | evaluation, "
      "residual, solution | writing, factorisation (flop limit) | share of the step [%%] |\n"
      "|---|---|---|---|---|---|---|---|\n",
      o.end_time, o.speed);
  each(measure);
}
