// Cost of a joint under each policy, on chains on pins that fall from a horizontal start. The links have a length of
// 0.1 m; they are rigid in space, or one cable element each in the plane.
// Growth: time of a step of h = 1 ms with 16 to 1024 links, at the actual and at equal counts of iterations, and
// exponents of growth from 64 links on. joints.png shows both times. Parts: nanoseconds per link for residual, tangent,
// factorisation and solution, also compared with links without joints. All times are processor times, the fastest of
// several runs.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <ctime>
#include <polybody/io/plot.hpp>
#include <polybody/polybody.hpp>

namespace {

using namespace polybody;

using Cable = planar::AncfCable<>;
using Laws = NonlinearBushing<LinearLaw, LinearLaw, LinearLaw, LinearLaw, LinearLaw, LinearLaw>;
/// Chain of bodies B on pins of geometry G, with one of the policies Ps.
template <class B, class G, class... Ps>
using Chain = Model<Bodies<B>, Joints<Joint<G, Ps>...>>;
using Rods = Chain<Rigid<>, Revolute, Constraint, Penalty, PenaltyPerEquation<5>, Bushing, Laws>;
template <class... Ps>
using Cables = Chain<Cable, planar::Revolute, Ps...>;

Penalty const penalty{.stiffness = 1e7, .damping = 1e3};
PenaltyPerEquation<5> const per_row{.stiffness = Vec<double, 5>::Constant(1e7),
                                    .damping = Vec<double, 5>::Constant(1e3)};
Bushing const bushing{.stiffness = Bushing::diagonal(Vec3::Constant(1e7), Vec3::Constant(1e5)),
                      .damping = Bushing::diagonal(Vec3::Constant(1e3), Vec3::Constant(10.0))};
LinearLaw const slide{.stiffness = 1e7, .damping = 1e3}, turn{.stiffness = 1e5, .damping = 10.0};
Laws const laws{slide, slide, slide, turn, turn, turn};

template <class B>
B body(Bar const& bar) {
  if constexpr (requires { B::from(bar); })
    return B::from(bar);
  else
    return B::from(bar, 1);
}

template <class P, class B, class G, class... Ps>
Chain<B, G, Ps...> chain(Chain<B, G, Ps...> const&, P const& policy, int links, bool pinned = true) {
  Chain<B, G, Ps...> model{Gravity{0, -9.81, 0}};
  Joint<G, P> const pin{G{}, policy};
  std::optional<BodyHandle<B>> before;
  for (int i = 0; i < links; ++i) {
    auto const link = model.add(body<B>({.length = 0.1,
                                         .section = Rectangle{.height = 0.03, .width = 0.02},
                                         .material = Material{.density = 7800.0, .young = 1e9, .poisson = 0.3},
                                         .placement = Placement::planar(0.1 * i, 0.0)}));
    if (pinned && before)
      model.connect(pin, before->at(0.1), link.at(0.0));
    else if (pinned)
      model.connect(pin, model.ground().at({0, 0, 0}), link.at(0.0));
    before = link;
  }
  return model;
}

/// Processor time of this program [s].
double now() { return double(std::clock()) / CLOCKS_PER_SEC; }

/// Processor time of the fastest of `tries` calls [s].
template <class F>
double fastest(int tries, F&& pass) {
  double best = 1e300;
  for (int i = 0; i < tries; ++i) {
    double const start = now();
    pass();
    best = std::min(best, now() - start);
  }
  return best;
}

/// Sink that copies the blocks of a tangent without further use.
struct Taken {
  std::vector<double> block;
  void add(Index, Index, BlockView const& b) {
    if (Index(block.size()) < b.rows * b.cols) block.resize(std::size_t(b.rows * b.cols));
    for (Index j = 0; j < b.cols; ++j)
      for (Index i = 0; i < b.rows; ++i) block[std::size_t(j * b.rows + i)] = b(i, j);
    benchmark::ClobberMemory();
  }
};

struct Cost {
  double residual, tangent, factor, solve;  ///< times in the state after 0.1 s, `factor` with its tangent [ns per link]
  double step, iterations, factorisations;  ///< means over the first 0.1 s: time [µs] and counts of a step
};

template <class M>
Cost cost(M const& model, int links) {
  Cost out{};
  State x = model.reference_state();
  for (int i = 0; i < 5 + 512 / links; ++i) {
    x = model.reference_state();
    auto run = simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.1, .step = 1e-3});
    double const us = fastest(1, [&] { run.run(); }) * 1e6, steps = double(run.report().steps);
    if (i == 0 || us / steps < out.step) out.step = us / steps;
    out.iterations = double(run.report().iterations) / steps;
    out.factorisations = double(run.report().factorisations) / steps;
  }

  System system = stepped_system(model);
  State y = reduce(system, x);
  TangentCoefficients const c{1.5, 5e-4, 2.5e-7};
  TangentSolver<DefaultSolver> solver;
  auto const write = [&](BlockSink& sink) { system.tangent(c, SecondOrder::omitted, y.lambda, sink); };
  system.evaluate(y.q, y.v, y.t);
  solver.analyse(system, 1, write);
  VecX r = VecX::Zero(system.velocities()), rhs = VecX::Ones(system.size()), solution = rhs;
  Taken taken;
  int const passes = std::max(1, 2048 / links);
  auto const ns = [&](auto&& pass) {
    return fastest(50,
                   [&] {
                     for (int k = 0; k < passes; ++k) pass();
                   }) *
           1e9 / (passes * links);
  };
  out.residual = ns([&] {
    system.evaluate(y.q, y.v, y.t);
    system.residual(y.a, y.lambda, r);
  });
  out.tangent = ns([&] { system.tangent(c, SecondOrder::omitted, y.lambda, taken); });
  out.factor = ns([&] { benchmark::DoNotOptimize(solver.factor(write)); });
  out.solve = ns([&] { solver.solve(rhs, solution); });
  return out;
}

/// Slope of log y over log x for x ≥ 64, by least squares.
double slope(Curve const& curve) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (curve.x[i] < 64) continue;
    double const x = std::log(curve.x[i]), y = std::log(curve.y[i]);
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

struct Tables {
  std::string parts;
  std::vector<Figure> panels = {panel("A step of a falling chain on pins, as taken"),
                                panel("The same at equal counts: 3 iterations, 0.2 factorisations")};

  static Figure panel(char const* title) {
    return {.title = title,
            .x_label = "links",
            .y_label = "µs a step",
            .log_x = true,
            .log_y = true,
            .x_range = std::array{10.0, 2000.0}};
  }
};

/// Measures one policy for up to `most` links. `free` is the cost of links without joints.
template <class M, class P>
void measure(char const* name, M const& like, P const& policy, Cost const& free, Tables& out, int most = 1024) {
  Curve taken{.label = name, .style = "linespoints"}, equal = taken;
  std::printf("  %-36s", name);
  for (int links = 16; links <= most; links *= 2) {
    Cost const c = cost(chain(like, policy, links), links);
    std::printf(" %7.1f (%3.1f, %4.2f)", c.step, c.iterations, c.factorisations);
    std::fflush(stdout);
    for (Curve* curve : {&taken, &equal}) curve->x.push_back(links);
    taken.y.push_back(c.step);
    equal.y.push_back((3.0 * (c.residual + c.solve) + 0.2 * c.factor) * 1e-3 * links);
    if (links == 64) {
      char row[200];
      std::snprintf(row, sizeof row, "  %-36s %9.0f %9.0f %9.0f %9.0f      %9.0f %9.0f\n", name, c.residual, c.tangent,
                    c.factor, c.solve, c.residual - free.residual, c.tangent - free.tangent);
      out.parts += row;
    }
  }
  if (most > 64) std::printf("   slopes %.2f, %.2f", slope(taken), slope(equal));
  std::printf("\n");
  if (most == 64) return;
  out.panels[0].curves.push_back(std::move(taken));
  out.panels[1].curves.push_back(std::move(equal));
}

void all_joints(benchmark::State& state) {
  for (auto _ : state) {
    using Kept = Cables<Constraint, Penalty>;
    using ByBodies = JointCoordinatesBy<joint_coordinates::ArticulatedBody>;
    Cost const rod = cost(chain(Rods{}, Constraint{}, 64, false), 64),
               cable = cost(chain(Kept{}, Constraint{}, 64, false), 64);
    Tables tables;
    std::printf(
        "\nmicroseconds a step (iterations, factorisations); slopes from 64 links on, as taken and at equal counts\n  "
        "%-36s",
        "links");
    for (int links = 16; links <= 1024; links *= 2) std::printf(" %7d            ", links);
    std::printf("\n");
    measure("rigid, Constraint", Rods{}, Constraint{}, rod, tables);
    measure("rigid, Penalty", Rods{}, penalty, rod, tables);
    measure("rigid, PenaltyPerEquation", Rods{}, per_row, rod, tables, 64);
    measure("rigid, Bushing", Rods{}, bushing, rod, tables);
    measure("rigid, NonlinearBushing", Rods{}, laws, rod, tables, 64);
    measure("rigid, JointCoordinates", Chain<Rigid<>, Revolute, JointCoordinates>{}, JointCoordinates{}, rod, tables);
    measure("rigid, JointCoordinatesBy<ArticulatedBody>", Chain<Rigid<>, Revolute, ByBodies>{}, ByBodies{}, rod,
            tables);
    measure("cables, Constraint", Kept{}, Constraint{}, cable, tables);
    measure("cables, Penalty", Kept{}, penalty, cable, tables, 64);
    measure("cables, AncfLinear", Cables<AncfLinear>{}, AncfLinear{}, cable, tables);
    std::printf(
        "\nnanoseconds a link                      residual   tangent, and factored  solution   beside free links: "
        "residual, tangent\n");
    for (auto const& [name, c] : {std::pair("rigid, free", rod), {"cables, free", cable}})
      std::printf("  %-36s %9.0f %9.0f %9.0f %9.0f\n", name, c.residual, c.tangent, c.factor, c.solve);
    std::printf("%s", tables.parts.c_str());
    for (Figure& f : tables.panels) {
      f.curves.push_back({.x = {16, 1024}, .y = {4, 256}, .label = "slope 1", .style = "dashed", .colour = 6});
    }
    write_panels(tables.panels, 2, "joints");
  }
}
BENCHMARK(all_joints)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
