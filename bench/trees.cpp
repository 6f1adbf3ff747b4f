// Joint coordinates of a tree by articulated bodies, on a chain that falls from a horizontal start: links of 0.1 m and
// 1 kg on pins. The program measures one call (q, q˙) → q¨, a quarter of a step of Runge–Kutta 4, a step of
// generalised-α and its iterations, and the processor time of one second for a given error of the tip. If Simbody is
// found (Debian: libsimbody-dev), the chain is also solved by Simbody in the same run; ratios are the time of polybody
// over the time of Simbody. All times are processor times, the fastest of several runs.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <polybody/io/plot.hpp>
#include <polybody/polybody.hpp>

#include "trees/simbody_chain.hpp"

namespace {

using namespace polybody;
using namespace falling_chain;

using ByBodies = JointCoordinatesBy<joint_coordinates::ArticulatedBody>;
using Pin = Joint<Revolute, ByBodies>;
using Chain = Model<Bodies<Rigid<>>, Joints<Pin>>;

Chain chain(int links) {
  Chain model{Gravity{0, -weight, 0}};
  Pin const pin{Revolute{.axis = {0, 0, 1}}, {}};
  std::optional<BodyHandle<Rigid<>>> before;
  for (int i = 0; i < links; ++i) {
    auto const link = model.add(Rigid<>({.mass = mass,
                                         .inertia = Vec3(moments[0], moments[1], moments[2]).asDiagonal(),
                                         .placement = Placement::at({length * (i + 0.5), 0, 0})}));
    Vec3 const end(0.5 * length, 0, 0);
    if (before)
      model.connect(pin, before->at(end), link.at(Vec3(-end)));
    else
      model.connect(pin, model.ground().at({0, 0, 0}), link.at(Vec3(-end)));
    before = link;
  }
  return model;
}

Second second(int links, double tolerance) {
  Chain const model = chain(links);
  Second out;
  out.seconds = fastest(3, 1, [&] {
    State x = model.reference_state();
    simulate(model, x, DormandPrince<>{.relative_tolerance = tolerance, .absolute_tolerance = tolerance},
             {.end_time = 1.0, .step = 1e-2})
        .run();
    Index const last = 7 * (links - 1);
    out.tip = {x.q[last], x.q[last + 1]};
  });
  return out;
}

Call call(int links) {
  Chain const model = chain(links);
  System system = stepped_system(model);
  State x = reduce(system, model.reference_state());
  for (int i = 0; i < links; ++i) {
    x.q[i] = angle(i);
    x.v[i] = rate(i);
  }
  ForwardDynamics<> forward(system);
  double const taken =
      fastest(20, 20000 / links, [&] { forward.accelerations(system, {x.q, x.v, 0.0}, x.a, x.lambda); });
  return {taken, x.a[links - 1]};
}

/// Time of a step of 1 ms [s], and mean number of iterations of a step.
template <class I>
std::pair<double, double> step(int links, I const& integrator) {
  Chain const model = chain(links);
  int const steps = std::clamp(20000 / links, 100, 2000);
  double iterations = 0.0;
  double const taken = fastest(5, 1, [&] {
    State x = model.reference_state();
    auto run = simulate(model, x, integrator, {.end_time = 1e-3 * steps, .step = 1e-3});
    iterations = double(run.run().iterations) / steps;
  });
  return {taken / steps, iterations};
}

/// Time at which a curve of time over error has this error, interpolated in logarithms; zero if the curve does not
/// reach the error.
double time_at(Curve const& curve, double error) {
  for (std::size_t i = 0; i + 1 < curve.x.size(); ++i) {
    double const a = std::log(curve.x[i]), b = std::log(curve.x[i + 1]), at = std::log(error);
    if ((a - at) * (b - at) > 0.0) continue;
    double const part = (at - a) / (b - a);
    return std::exp((1.0 - part) * std::log(curve.y[i]) + part * std::log(curve.y[i + 1]));
  }
  return 0.0;
}

void calls() {
  std::printf("\none call (q, q') -> q'' [us]   a quarter of a step of Runge-Kutta 4");
#ifdef POLYBODY_HAS_SIMBODY
  std::printf("   Simbody's call, ratio, last q'' apart");
#endif
  std::printf("\n");
  for (int const links : {4, 16, 64, 256}) {
    auto const [taken, last] = call(links);
    double const quarter = 0.25 * step(links, RungeKutta4<>{}).first;
    std::printf("  %4d links  %8.2f             %8.2f (%.2f)", links, 1e6 * taken, 1e6 * quarter, quarter / taken);
#ifdef POLYBODY_HAS_SIMBODY
    auto const [other, its] = simbody_call(links);
    std::printf("                      %8.2f     %5.2f   %.0e", 1e6 * other, taken / other,
                std::fabs(last - its) / std::fabs(its));
#endif
    std::printf("\n");
  }
}

void implicit_steps() {
  std::printf("\na step of 1 ms by generalised-alpha [us], iterations   and by full Newton\n");
  for (int const links : {16, 64, 256, 1024, 4096}) {
    auto const [taken, iterations] = step(links, GeneralisedAlpha{});
    auto const [full, of_full] = step(links, GeneralisedAlpha{.newton = {.always_refactor = true}});
    std::printf("  %4d links  %8.1f   %.2f                            %8.1f   %.2f\n", links, 1e6 * taken, iterations,
                1e6 * full, of_full);
  }
}

void work_for_accuracy() {
  Figure figure{.title = "One second of a falling chain",
                .x_label = "error of the tip [m]",
                .y_label = "processor time [s]",
                .log_x = true,
                .log_y = true};
  std::printf("\none second: processor time [ms] for an error of the tip of 1e-7 m\n");
  int colour = 1;
  for (int const links : {4, 16, 64}) {
    Tip const reference = second(links, 1e-12).tip;
    std::string const name = ", " + std::to_string(links) + " links";
    Curve ours{.label = "polybody, Dormand-Prince" + name, .style = "linespoints", .colour = colour};
    for (double tolerance = 1e-4; tolerance > 1e-11; tolerance *= 0.1) {
      Second const one = second(links, tolerance);
      ours.x.push_back(apart(one.tip, reference));
      ours.y.push_back(one.seconds);
    }
    std::printf("  %4d links  %8.1f", links, 1e3 * time_at(ours, 1e-7));
#ifdef POLYBODY_HAS_SIMBODY
    Tip const their_reference = simbody_second(links, 1e-12).tip;
    Curve theirs{.label = "Simbody, Runge-Kutta-Merson" + name, .style = "dashed", .colour = colour};
    for (double accuracy = 1e-3; accuracy > 1e-9; accuracy *= 0.1) {
      Second const one = simbody_second(links, accuracy);
      theirs.x.push_back(apart(one.tip, their_reference));
      theirs.y.push_back(one.seconds);
    }
    double const a = time_at(ours, 1e-7), b = time_at(theirs, 1e-7);
    std::printf("   Simbody, Runge-Kutta-Merson %8.1f, ratio %.2f; converged tips %.0e m apart", 1e3 * b, a / b,
                apart(reference, their_reference));
    figure.curves.push_back(std::move(theirs));
#endif
    std::printf("\n");
    figure.curves.push_back(std::move(ours));
    ++colour;
  }
  write_panels({figure}, 1, "trees");
}

void trees(benchmark::State& state) {
  for (auto _ : state) {
    calls();
    implicit_steps();
    work_for_accuracy();
  }
}
BENCHMARK(trees)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
