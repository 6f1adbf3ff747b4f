// One step of h = 1 ms: chains of rigid links (0.1 m, 1 kg, I = (1e-4, 1e-3, 1e-3) kg m²) released horizontally, 1 s, with
// ideal and compliant pins, by the default solver and by Eigen's sparse LU; and the share of each part of a step.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdio>
#include <polybody/polybody.hpp>

namespace {

using namespace polybody;

template <class Policy>
struct Chain {
  using Pin = Joint<Revolute, Policy>;
  Model<Bodies<Rigid<>>, Joints<Pin>> model{Gravity{0, 0, -9.81}};

  Chain(int links, Policy const& policy) {
    Mat3 const inertia = Vec3(1e-4, 1e-3, 1e-3).asDiagonal();
    Pin const pin{Revolute{.axis = Vec3::UnitY()}, policy};
    std::optional<BodyHandle<Rigid<>>> before;
    for (int i = 0; i < links; ++i) {
      auto const link = model.add(Rigid<>(1.0, inertia, Placement::at({0.1 * i + 0.05, 0, 0})));
      if (before)
        model.connect(pin, before->at(Vec3(0.05, 0, 0)), link.at(Vec3(-0.05, 0, 0)));
      else
        model.connect(pin, model.ground().at({0, 0, 0}), link.at(Vec3(-0.05, 0, 0)));
      before = link;
    }
  }
};

struct Cost {
  double microseconds = 0.0;  ///< a step
  double iterations = 0.0, factorisations = 0.0;
};

template <class Solver, class M>
Cost cost(M const& model, double until) {
  State x = model.reference_state();
  auto run = simulate<Solver>(model, x, GeneralizedAlpha{}, {.until = until, .step = 1e-3});
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
    double const until = links > 64 ? 0.2 : 1.0;
    Chain<Constraint> const ideal(links, {});
    Chain<Penalty> const compliant(links, {.stiffness = 1e7, .damping = 1e3});
    Cost const block = cost<BlockSolver>(ideal.model, until), lu = cost<EigenSparseLu>(ideal.model, until),
               soft = cost<BlockSolver>(compliant.model, until);
    std::printf("  %5d", links);
    for (Cost const& c : {block, lu, soft}) std::printf(" %9.1f (%5.2f, %5.3f)      ", c.microseconds, c.iterations, c.factorisations);
    std::printf("  ratio SparseLU / block %.1f\n", lu.microseconds / block.microseconds);
  }
}

/// The parts of an iteration on a chain of 64.
struct Parts {
  Chain<Constraint> chain{64, {}};
  System<decltype(chain.model)> system{chain.model};
  State x = chain.model.reference_state();
  BlockSolver solver;
  VecX r, rhs, y;

  Parts() : r(VecX::Zero(system.speeds())), rhs(VecX::Zero(system.size())), y(rhs) {
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

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  chains();
}
