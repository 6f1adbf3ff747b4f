// One step of h = 1 ms: chains of rigid links (0.1 m, 1 kg, I = (1e-4, 1e-3, 1e-3) kg m²) released horizontally, 1 s,
// with ideal and compliant pins; the robot arm of Chapter 2; N four-bars (IFToMM A02); a very flexible cable pendulum.
// Benchmarks:
// - step: the run of a model with the default solver and with Eigen's sparse LU;
// - part: parts of an iteration for a chain of 64 links;
// - variants: eight chains of 64 links with random differences of the masses of their links. The counters give the
//   possible gain of SIMD lanes.
// bench_steps --run MODEL SIZE SECONDS completes one run for a profiler.
#include <cstdio>
#include <polybody/polybody.hpp>
#include <random>

#include "../examples/chapter2.hpp"
#include "lockstep.hpp"
#include "registered.hpp"
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

/// A mechanism with its start and the end of its run [s].
template <class T>
struct Started {
  std::shared_ptr<T const> made;
  State start;
  double end_time;
};
template <class T>
Started<T> from_reference(T const& mechanism, double end_time = 1.0) {
  auto const made = std::make_shared<T const>(mechanism);
  return {made, made->model.reference_state(), end_time};
}

template <class Solver, class T>
void time_steps(benchmark::State& state, Started<T> const& of) {
  ProblemSize const size = problem_size(of.made->model);
  State x;
  registered::time_runs(state, size.velocities + size.rows, [&] {
    x = of.start;
    return simulate<Solver>(of.made->model, x, GeneralisedAlpha{}, {.end_time = of.end_time, .step = 1e-3});
  });
}

/// Registers runs of the mechanism that `start()` returns.
template <class F>
void add(std::string const& name, F const& start) {
  registered::add("step/" + name + "/BlockSolver",
                  [=](benchmark::State& state) { time_steps<BlockSolver>(state, start()); });
  registered::add("step/" + name + "/EigenSparseLu",
                  [=](benchmark::State& state) { time_steps<EigenSparseLu>(state, start()); });
}

template <class B, class P = Constraint>
chapter2::RobotArm<B, P> arm(Index elements, P const& policy = {}) {
  return {chapter2::bar(chapter2::medium, 1.2), elements, 15.0, 0.0, policy};
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

template <class B, class P>
void add_arm(std::string const& body, Index elements, P const& policy) {
  std::string const mesh = elements > 1 ? "/elements:" + std::to_string(elements) : "";
  add("robot_arm/" + body + '/' + P::name + mesh, [=] { return from_reference(arm<B>(elements, policy)); });
}

void add_mechanisms() {
  for (int const links : {4, 16, 64, 256, 1024}) {
    std::string const size = "/links:" + std::to_string(links);
    double const end_time = links > 64 ? 0.2 : 1.0;
    add("chain/Constraint" + size, [=] { return from_reference(Chain<Constraint>(links, {}), end_time); });
    add("chain/Penalty" + size,
        [=] { return from_reference(Chain<Penalty>(links, {.stiffness = 1e7, .damping = 1e3}), end_time); });
  }
  Penalty const stiff{.stiffness = 1e9, .damping = 1e5};
  add_arm<planar::Rigid>("Rigid", 1, Constraint{});
  add_arm<planar::Rigid>("Rigid", 1, stiff);
  add_arm<planar::Lrvf>("Lrvf", 10, Constraint{});
  add_arm<planar::Lrvf>("Lrvf", 10, stiff);
  add_arm<planar::AncfCable<>>("AncfCable", 10, Constraint{});
  add_arm<planar::AncfCable<>>("AncfCable", 10, stiff);
  for (Index const n : {16, 64})
    add("cable_pendulum/elements:" + std::to_string(n), [=] {
      auto const made = std::make_shared<CablePendulum const>(n);
      return Started<CablePendulum>{made, made->start, 1.0};
    });
  for (int const n : {2, 10, 40})
    add("four_bars/N:" + std::to_string(n), [=] {
      auto const made = std::make_shared<FourBars const>(n);
      return Started<FourBars>{made, made->start(), 0.7};  // the first flat position comes at 0.71 s
    });
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
void add_part(std::string const& name, void (*act)(Parts&)) {
  registered::add("part/" + name, [=](benchmark::State& state) {
    Parts p;
    for (auto _ : state) act(p);
  });
}
void add_parts() {
  add_part("evaluate", [](Parts& p) { p.system.evaluate(p.x.q, p.x.v, 0.0); });
  add_part("residual", [](Parts& p) { p.system.residual(p.x.a, p.x.lambda, p.r); });
  add_part("assemble", [](Parts& p) { p.assemble(); });
  add_part("assemble_and_factor", [](Parts& p) {
    p.assemble();
    benchmark::DoNotOptimize(p.solver.factor());
  });
  add_part("solve", [](Parts& p) { p.solver.solve(p.rhs, p.y); });
}

/// Runs eight chains of 64 links whose masses differ by at most the relative part `by`.
void variants(benchmark::State& state, double by) {
  Parts p;
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
  for (auto _ : state) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> within(-by, by);
    std::vector<lockstep::Counts> runs;
    for (int k = 0; k < 8; ++k) {
      Chain<Constraint> const chain(64, {}, [&](int) { return 1.0 + within(random); });
      State x = chain.model.reference_state();
      auto run = simulate(chain.model, x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 1e-3});
      runs.push_back(lockstep::counts_of(run));
    }
    lockstep::count(state, runs, us[0] + us[1] + us[2], us[3]);
  }
}

/// One run with the default solver only, for a profiler: bench_steps --run MODEL SIZE SECONDS.
int run_alone(std::string const& model, int size, double end_time) {
  auto const run = [&](auto const& m, State x) {
    RunReport const r = simulate<BlockSolver>(m, x, GeneralisedAlpha{}, {.end_time = end_time, .step = 1e-3}).run();
    std::printf("%ld steps, %.3f Newton iterations a step\n", r.steps, double(r.iterations) / double(r.steps));
    return 0;
  };
  auto const at_rest = [&](auto const& m) { return run(m, m.reference_state()); };
  if (model == "chain") return at_rest(Chain<Constraint>(size, {}).model);
  if (model == "penalty-chain") return at_rest(Chain<Penalty>(size, {.stiffness = 1e7, .damping = 1e3}).model);
  if (model == "lrvf-arm") return at_rest(arm<planar::Lrvf>(size).model);
  if (model == "cable-arm") return at_rest(arm<planar::AncfCable<>>(size).model);
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
  add_mechanisms();
  add_parts();
  for (auto const& [name, by] : {std::pair("1e-4", 1e-4), {"1e-2", 1e-2}, {"1e-1", 1e-1}})
    registered::add(std::string("variants/masses:") + name, [by = by](benchmark::State& state) {
      variants(state, by);
    })->Iterations(1);
  return registered::run(argc, argv);
}
