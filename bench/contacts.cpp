// Contacts that begin and end: a chain of 64 links falls across five wheels, and every link can touch every wheel.
// There are three ways to treat the elimination order: omit link–wheel blocks from the matrix and iterate over them;
// reserve a slot for each of the 320 pairs; or compute a new order if a contact begins or ends. The program measures
// the first two ways and the time of a new order.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdio>
#include <polybody/polybody.hpp>

namespace {

using namespace polybody;

/// Contact force of two balls along the line of centres for an overlap δ > 0: k δ (1 + d δ̇) [Hunt & Crossley 1975].
template <bool Couples>
struct Press {
  static constexpr int markers = 2;
  static constexpr bool is_load = false;
  static constexpr MarkerKind needs = MarkerKind::point;
  static constexpr bool couples_bodies = Couples;

  double distance = 0.0;  ///< distance of the centres at first contact [m]
  double k = 1e5, d = 0.5;

  void check(std::string const&) const {}
  template <StateScalar T>
  std::array<Wrench<T>, 2> wrenches(std::array<Frame<T>, 2> const& frames, double) const {
    using std::sqrt;
    std::array<Wrench<T>, 2> w;
    Vec<T, 3> const line = frames[1].r - frames[0].r;
    T const l2 = line.squaredNorm();
    if (value_of(l2) >= distance * distance) return w;
    T const l = sqrt(l2), overlap = distance - l, rate = -line.dot(frames[1].v - frames[0].v) / l;
    T const force = overlap * (rate * d + 1.0) * k;
    if (value_of(force) <= 0.0) return w;
    w[1].f = line * (force / l);
    w[0].f = -w[1].f;
    return w;
  }
};

template <bool Couples>
struct ChainOnWheels {
  using Pin = Joint<Revolute, Constraint>;
  using Contact = Press<Couples>;
  Model<Bodies<Rigid<>>, Joints<Pin>, Forces<Contact>> model{Gravity{0, 0, -9.81}};

  explicit ChainOnWheels(bool touching = true) {
    Pin const pin{Revolute{.axis = Vec3::UnitY()}, {}};
    std::vector<BodyHandle<Rigid<>>> links;
    for (int i = 0; i < 64; ++i) {
      links.push_back(
          model.add(Rigid<>(1.0, Vec3(1e-4, 1e-3, 1e-3).asDiagonal(), Placement::at({0.1 * i + 0.05, 0, 0}))));
      auto const here = links.back().at(Vec3(-0.05, 0, 0));
      if (i == 0)
        model.connect(pin, model.ground().at({0, 0, 0}), here);
      else
        model.connect(pin, links[std::size_t(i - 1)].at(Vec3(0.05, 0, 0)), here);
    }
    for (int w = 0; w < 5; ++w) {
      Vec3 const centre(0.8 + 1.2 * w, 0.0, -0.3);
      auto const wheel = model.add(Rigid<>(20.0, Mat3::Identity() * 0.3, Placement::at(centre)));
      model.connect(pin, model.ground().at(centre), wheel.at(Vec3(0, 0, 0)));
      if (touching)
        for (auto const& link : links)
          model.apply(Contact{.distance = 0.2}, wheel.at(Vec3(0, 0, 0)), link.at(Vec3(0, 0, 0)));
    }
  }
};

using Clock = std::chrono::steady_clock;
double microseconds(Clock::time_point start) {
  return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
}

template <class M>
void report(char const* what, M const& model) {
  State x = model.reference_state();
  auto run = simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.5, .step = 1e-3});
  auto const start = Clock::now();
  RunReport const& r = run.run();
  double const time = microseconds(start) / double(r.steps);
  std::printf("  %-34s %7.0f us a step (%.2f iterations, %.3f factorisations), tip at z = %.6f m", what, time,
              double(r.iterations) / double(r.steps), double(r.factorisations) / double(r.steps), x.q[7 * 63 + 2]);
  std::printf("\n");
}

/// Prints the times of an analysis and of one factorisation of the tangent in the reference state [µs].
template <class M>
void orders(char const* what, M const& model) {
  System system(model);
  State const x = model.reference_state();
  PatternSink pattern;
  system.evaluate(x.q, x.v, 0.0);
  system.tangent({1.0, 1.0, 1.0}, SecondOrder::omitted, x.lambda, pattern);
  double analyse = 1e300, factor = 1e300;
  for (int i = 0; i < 21; ++i) {
    BlockSolver solver;
    auto start = Clock::now();
    solver.analyse(system.size(), pattern.blocks);
    analyse = std::min(analyse, microseconds(start));
    auto const write = [&](BlockSink& sink) {
      system.tangent({1.5, 5e-4, 2.5e-7}, SecondOrder::omitted, x.lambda, sink);
    };
    write_and_factor(solver, write);
    start = Clock::now();
    write_and_factor(solver, write);
    factor = std::min(factor, microseconds(start));
  }
  std::printf("  %-34s order %6.0f us, matrix and factorisation %5.0f us, analysis %.1f times as much\n", what, analyse,
              factor, analyse / factor);
}

void analyse_without_coupling(benchmark::State& state) {
  ChainOnWheels<false> const c;
  System system(c.model);
  State const x = c.model.reference_state();
  PatternSink pattern;
  system.evaluate(x.q, x.v, 0.0);
  system.tangent({1.0, 1.0, 1.0}, SecondOrder::omitted, x.lambda, pattern);
  for (auto _ : state) {
    BlockSolver solver;
    solver.analyse(system.size(), pattern.blocks);
    benchmark::DoNotOptimize(solver);
  }
}
BENCHMARK(analyse_without_coupling)->Unit(benchmark::kMicrosecond);

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  ChainOnWheels<false> const apart, free(false);
  ChainOnWheels<true> const slots;
  std::printf("\nchain of 64 links on five wheels, 320 candidate pairs, h = 1 ms, 0.5 s\n");
  report("no contacts", free.model);
  report("link-wheel blocks left out", apart.model);
  report("a slot for every pair", slots.model);
  orders("link-wheel blocks left out", apart.model);
  orders("a slot for every pair", slots.model);
}
