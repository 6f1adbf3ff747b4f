// One step of h = 1 ms: chains of rigid links (0.1 m, 1 kg, I = (1e-4, 1e-3, 1e-3) kg m²) released horizontally, 1 s,
// with ideal and compliant pins; the robot arm of Chapter 2; N four-bars (IFToMM A02); a very flexible cable pendulum.
// Each model is solved with the default solver and with Eigen's sparse LU. The program also measures the parts of a
// step, and the possible gain of variants of a chain in the lanes of SIMD vectors.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdio>
#include <polybody/polybody.hpp>
#include <random>

#include "../examples/chapter2.hpp"
#include "lockstep.hpp"
#include "timing.hpp"

namespace {

using namespace polybody;

template <class Policy>
struct Chain {
  using Pin = Joint<Revolute, Policy>;
  Model<Bodies<Rigid<>>, Joints<Pin>> model{Gravity{0, 0, -9.81}};

  /// \param factor returns the factor of the mass of link i
  template <class F>
  Chain(int links, Policy const& policy, F const& factor) {
    Pin const pin{Revolute{.axis = Vec3::UnitY()}, policy};
    std::optional<BodyHandle<Rigid<>>> before;
    for (int i = 0; i < links; ++i) {
      double const mass = factor(i);
      Mat3 const inertia = Vec3(1e-4 * mass, 1e-3 * mass, 1e-3 * mass).asDiagonal();
      auto const link = model.add(Rigid<>(mass, inertia, Placement::at({0.1 * i + 0.05, 0, 0})));
      if (before)
        model.connect(pin, before->at(Vec3(0.05, 0, 0)), link.at(Vec3(-0.05, 0, 0)));
      else
        model.connect(pin, model.ground().at({0, 0, 0}), link.at(Vec3(-0.05, 0, 0)));
      before = link;
    }
  }
  Chain(int links, Policy const& policy) : Chain(links, policy, [](int) { return 1.0; }) {}
};

/// Pendulum of a very flexible cable that turns about the vertical (D6a of docs/cases.md).
struct CablePendulum {
  using Ball = Joint<Spherical, Constraint>;
  Model<Bodies<AncfCable<>>, Joints<Ball>> model{Gravity{0, -9.81, 0}};
  State start;

  explicit CablePendulum(Index elements) {
    Bar const bar{.length = 1.0,
                  .constants = BarConstants{.EA = 40.0, .EI = 7.957747154594767e-5, .mass_per_length = 8e-3}};
    auto const cable = model.add(AncfCable<>::from(bar, elements));
    model.connect(Ball{}, model.ground().at({0, 0, 0}), cable.at(0.0));
    start = model.reference_state();
    model.set_velocity(start, cable, Vec3::Zero(), Vec3(0, 4, 0));
  }
};

struct Cost {
  double microseconds = 0.0;                      ///< time of a step
  double iterations = 0.0, factorisations = 0.0;  ///< counts per step
};

template <class Solver, class M>
Cost cost(M const& model, State x, double end_time) {
  auto run = simulate<Solver>(model, x, GeneralisedAlpha{}, {.end_time = end_time, .step = 1e-3});
  auto const start = std::chrono::steady_clock::now();
  run.run();
  double const time = std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
  RunReport const& r = run.report();
  return {time / double(r.steps), double(r.iterations) / double(r.steps), double(r.factorisations) / double(r.steps)};
}

void chains() {
  std::printf("\nmicroseconds a step (Newton iterations, factorisations a step)\n");
  std::printf("  links   constraint, block solver      constraint, Eigen SparseLU   penalty 1e7 N/m, block solver\n");
  for (int const links : {4, 16, 64, 256, 1024}) {
    double const end_time = links > 64 ? 0.2 : 1.0;
    Chain<Constraint> const ideal(links, {});
    Chain<Penalty> const compliant(links, {.stiffness = 1e7, .damping = 1e3});
    Cost const block = cost<BlockSolver>(ideal.model, ideal.model.reference_state(), end_time),
               lu = cost<EigenSparseLu>(ideal.model, ideal.model.reference_state(), end_time),
               soft = cost<BlockSolver>(compliant.model, compliant.model.reference_state(), end_time);
    std::printf("  %5d", links);
    for (Cost const& c : {block, lu, soft})
      std::printf(" %9.1f (%5.2f, %5.3f)      ", c.microseconds, c.iterations, c.factorisations);
    std::printf("  ratio SparseLU / block %.1f\n", lu.microseconds / block.microseconds);
  }
}

/// Prints a row of the table: times of the default solver and of Eigen's sparse LU, and their ratio.
template <class M>
void compare_solvers(std::string const& what, M const& model, State const& x, double end_time) {
  Cost const block = cost<BlockSolver>(model, x, end_time), lu = cost<EigenSparseLu>(model, x, end_time);
  std::printf("  %-34s %8.1f (%5.2f, %5.3f)   %8.1f   ratio %.1f\n", what.c_str(), block.microseconds, block.iterations,
              block.factorisations, lu.microseconds, lu.microseconds / block.microseconds);
}

template <class B, class P = Constraint>
chapter2::RobotArm<B, P> arm(Index elements, P const& policy = {}) {
  return {chapter2::bar(chapter2::medium, 1.2), elements, 15.0, 0.0, policy};
}
template <class B, class P>
void compare_solvers_of_arm(std::string const& what, Index elements, P const& policy) {
  auto const robot = arm<B>(elements, policy);
  compare_solvers("robot arm, " + what, robot.model, robot.model.reference_state(), 1.0);
}

/// Linkage of N windows of unit bars on pins (R2 of docs/cases.md), upright, moving to the right at 1 m/s.
struct FourBars {
  using Pin = Joint<planar::Revolute, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Pin>> model{Gravity{0, -9.81, 0}};
  std::vector<BodyHandle<planar::Rigid>> up, across;

  explicit FourBars(int n) {
    Bar const unit{.length = 1.0, .constants = BarConstants{.EA = 1.0, .EI = 1.0, .mass_per_length = 1.0}};
    auto const rod = [&](double x, double y, double angle) {
      Bar b = unit;
      b.placement = Placement::planar(x, y, angle);
      return model.add(planar::Rigid::from(b));
    };
    for (int i = 0; i <= n; ++i) {
      up.push_back(rod(i, 0, 0.5 * std::numbers::pi));
      model.connect(Pin{}, model.ground().at({double(i), 0, 0}), up.back().at(0.0));
    }
    for (int i = 0; i < n; ++i) {
      across.push_back(rod(i, 1, 0.0));
      model.connect(Pin{}, up[std::size_t(i)].at(1.0), across.back().at(0.0));
      model.connect(Pin{}, up[std::size_t(i) + 1].at(1.0), across.back().at(1.0));
    }
  }
  State start() const {
    State x = model.reference_state();
    for (std::size_t i = 0; i < up.size(); ++i)  // rotation about the foot of the bar
      model.set_velocity(x, up[i], Vec3(0, double(i), 0), Vec3(0, 0, -1));
    for (auto const& bar : across) model.set_velocity(x, bar, Vec3(1, 0, 0), Vec3::Zero());
    return x;
  }
};

void mechanisms() {
  std::printf("\nmicroseconds a step (iterations, factorisations), Eigen SparseLU, ratio\n");
  Penalty const stiff{.stiffness = 1e9, .damping = 1e5};
  compare_solvers_of_arm<planar::Rigid>("rigid, Constraint", 1, Constraint{});
  compare_solvers_of_arm<planar::Rigid>("rigid, Penalty", 1, stiff);
  compare_solvers_of_arm<planar::Lrvf>("10 Lrvf, Constraint", 10, Constraint{});
  compare_solvers_of_arm<planar::Lrvf>("10 Lrvf, Penalty", 10, stiff);
  compare_solvers_of_arm<planar::AncfCable<>>("10 AncfCable, Constraint", 10, Constraint{});
  compare_solvers_of_arm<planar::AncfCable<>>("10 AncfCable, Penalty", 10, stiff);
  for (Index const n : {16, 64}) {
    CablePendulum const pendulum(n);
    compare_solvers("cable pendulum, " + std::to_string(n) + " elements", pendulum.model, pendulum.start, 1.0);
  }
  for (int const n : {2, 10, 40}) {
    FourBars const bars(n);
    compare_solvers(std::to_string(n) + " four-bars", bars.model, bars.start(),
                    0.7);  // the first flat position comes at 0.71 s
  }
}

/// Parts of an iteration for a chain of 64 links.
struct Parts {
  Chain<Constraint> chain{64, {}};
  System system{chain.model};
  State x = chain.model.reference_state();
  BlockSolver solver;
  VecX r, rhs, y;

  Parts() : r(VecX::Zero(system.velocities())), rhs(VecX::Zero(system.size())), y(rhs) {
    PatternSink pattern;
    system.evaluate(x.q, x.v, 0.0);
    system.tangent({1.0, 1.0, 1.0}, SecondOrder::omitted, x.lambda, pattern);
    solver.analyse(system.size(), pattern.blocks);
    assemble();
    solver.factor();
    rhs.setOnes();
  }
  void assemble() {
    solver.begin();
    system.tangent({1.5, 5e-4, 2.5e-7}, SecondOrder::omitted, x.lambda, solver);
  }
};
Parts& parts() {
  static Parts p;
  return p;
}
void evaluate(benchmark::State& state) {
  Parts& p = parts();
  for (auto _ : state) p.system.evaluate(p.x.q, p.x.v, 0.0);
}
void residual(benchmark::State& state) {
  Parts& p = parts();
  for (auto _ : state) p.system.residual(p.x.a, p.x.lambda, p.r);
}
void assemble(benchmark::State& state) {
  Parts& p = parts();
  for (auto _ : state) p.assemble();
}
void assemble_and_factor(benchmark::State& state) {
  Parts& p = parts();
  for (auto _ : state) {
    p.assemble();
    benchmark::DoNotOptimize(p.solver.factor());
  }
}
void solve(benchmark::State& state) {
  Parts& p = parts();
  for (auto _ : state) p.solver.solve(p.rhs, p.y);
}
BENCHMARK(evaluate);
BENCHMARK(residual);
BENCHMARK(assemble);
BENCHMARK(assemble_and_factor);
BENCHMARK(solve);

/// Measures eight chains of 64 links with random differences of the masses of their links.
void variants() {
  Parts& p = parts();
  auto const nothing = [] {};
  std::vector<double> const us = timing::fastest({{nothing, [&] { p.system.evaluate(p.x.q, p.x.v, 0.0); }},
                                                  {nothing, [&] { p.system.residual(p.x.a, p.x.lambda, p.r); }},
                                                  {nothing, [&] { p.solver.solve(p.rhs, p.y); }},
                                                  {nothing,
                                                   [&] {
                                                     p.assemble();
                                                     benchmark::DoNotOptimize(p.solver.factor());
                                                   }}},
                                                 101);
  lockstep::print_head();
  for (double const by : {1e-4, 1e-2, 1e-1}) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> within(-by, by);
    std::vector<lockstep::Counts> runs;
    for (int k = 0; k < 8; ++k) {
      Chain<Constraint> const chain(64, {}, [&](int) { return 1.0 + within(random); });
      State x = chain.model.reference_state();
      auto run = simulate(chain.model, x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 1e-3});
      runs.push_back(lockstep::counts_of(run));
    }
    char name[40];
    std::snprintf(name, sizeof name, "masses of links, ±%g %%", 100.0 * by);
    lockstep::print(name, runs, us[0] + us[1] + us[2], us[3]);
  }
}

/// One run with the default solver only, for a profiler: bench_steps --run MODEL SIZE SECONDS.
int run_alone(std::string const& model, int size, double end_time) {
  auto const run = [&](auto const& m, State const& x) {
    Cost const c = cost<BlockSolver>(m, x, end_time);
    std::printf("%.0f steps, %.3f Newton iterations a step\n", end_time / 1e-3, c.iterations);
    return 0;
  };
  auto const from_reference = [&](auto const& m) { return run(m, m.reference_state()); };
  if (model == "chain") return from_reference(Chain<Constraint>(size, {}).model);
  if (model == "penalty-chain") return from_reference(Chain<Penalty>(size, {.stiffness = 1e7, .damping = 1e3}).model);
  if (model == "lrvf-arm") return from_reference(arm<planar::Lrvf>(size).model);
  if (model == "cable-arm") return from_reference(arm<planar::AncfCable<>>(size).model);
  if (model == "cable-pendulum") {
    CablePendulum const pendulum(size);
    return run(pendulum.model, pendulum.start);
  }
  if (model == "four-bars") {
    FourBars const bars(size);
    return run(bars.model, bars.start());
  }
  std::fprintf(stderr, "bench_steps: unknown model %s\n", model.c_str());
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 5 && std::string(argv[1]) == "--run") return run_alone(argv[2], std::stoi(argv[3]), std::stod(argv[4]));
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  chains();
  mechanisms();
  variants();
}
