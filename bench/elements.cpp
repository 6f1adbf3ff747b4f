// Element kernels: nanoseconds per element for force and tangent, for single elements, for packs (structure of arrays)
// and with two threads. The compiler may vectorise the loop over single elements. -fno-tree-vectorize makes this loop
// scalar and does not change the packs.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdio>
#include <polybody/polybody.hpp>
#include <polybody/se3_beam.hpp>

namespace {

using namespace polybody;
using Clock = std::chrono::steady_clock;

constexpr Index count = 1024;

/// Calls `pass`. Each pass is a function of its own, so that the compiler optimises it as in a small program.
template <class F>
[[gnu::noinline]] void run(F&& pass) {
  pass();
}
/// Time per element in the fastest of 200 passes [ns].
template <class F>
double fastest(F&& pass) {
  double best = 1e300;
  for (int i = 0; i < 200; ++i) {
    auto const start = Clock::now();
    run(pass);
    best = std::min(best, std::chrono::duration<double, std::nano>(Clock::now() - start).count() / double(count));
  }
  return best;
}

template <class B>
struct Swaying {
  Damping damping;
  B body = B::from({.length = 64.0,
                    .section = Rectangle{.height = 0.02, .width = 0.015},
                    .material = Material{.density = 7800.0, .young = 2e11, .poisson = 0.3},
                    .damping = damping},
                   count);
  std::vector<double> q, v, a;
  explicit Swaying(Damping const& d = {}) : damping(d), q(std::size_t(body.coordinates())), v(q.size()), a(q.size()) {
    body.reference(q);
    for (std::size_t i = 0; i < q.size(); ++i) {
      q[i] += 1e-3 * std::sin(7.0 * double(i));
      v[i] = 0.1 * std::sin(3.0 * double(i));
      a[i] = std::cos(5.0 * double(i));
    }
  }
  std::span<double const> qs() const { return q; }
  std::span<double const> vs() const { return v; }
  std::span<double const> as() const { return a; }
};

template <class B>
void compare(char const* name, Damping const& damping = {}) {
  constexpr int n = B::element_columns;
  Swaying<B> const s(damping);
  auto const use = [](Index, auto const& x) {  // uses all entries, so that the compiler cannot omit any
    benchmark::DoNotOptimize(x.data());
    benchmark::ClobberMemory();
  };
  double const force = fastest([&] {
    Vec<double, n> x, f;
    for (Index e = 0; e < count; ++e) {
      s.body.template inertia<double>(e, s.qs(), s.as(), x);
      s.body.template force<double>(e, s.qs(), s.vs(), f);
      x -= f;
      use(e, x);
    }
  });
  double const forces =
      fastest([&] { for_each_residual<B, double>(s.body, {0, count}, {s.qs(), s.vs(), s.as()}, use); });
  double const tangent = fastest([&] {
    Mat<double, n, n> k, m;
    s.body.mass(0, s.qs(), m);
    m *= 1.5;
    for (Index e = 0; e < count; ++e) {
      s.body.tangent(e, s.qs(), s.vs(), 1.0, 0.1, k);
      k += m;
      use(e, k);
    }
  });
  double const tangents =
      fastest([&] { for_each_element_tangent<B>(s.body, {0, count}, {s.qs(), s.vs()}, {1.5, 0.1, 1.0}, use); });
  std::printf(
      "  %-37s M a - f: %6.1f, in packs %6.1f, ratio %4.2f;   tangent: %7.1f, in packs %6.1f, ratio %4.2f;   both: "
      "ratio %4.2f\n",
      name, force, forces, force / forces, tangent, tangents, tangent / tangents,
      (force + tangent) / (forces + tangents));
}

/// Residual and tangent of a model of one body with `count` elements, with one thread and with two threads.
template <class B>
void share_loops(char const* name) {
  Model<Bodies<B>, Joints<>> model{Gravity{0, -9.81, 0}};
  Swaying<B> s;
  model.add(s.body);
  System alone(model), shared(model);
  shared.use_threads(2);
  State const x = model.reference_state();
  VecX const q = Eigen::Map<VecX const>(s.q.data(), Index(s.q.size())), v = 0.0 * q;
  VecX r = v;
  struct Sum {
    double total = 0.0;
    void add(Index, Index, BlockView const& b) { total += b(0, 0); }
  } sum;
  auto const residual = [&](auto& system) { return fastest([&] { system.residual(v, x.lambda, r); }); };
  auto const tangent = [&](auto& system) {
    return fastest([&] { system.tangent({1.5, 5e-4, 2.5e-7}, SecondOrder::omitted, x.lambda, sum); });
  };
  alone.evaluate(q, v, 0.0);
  shared.evaluate(q, v, 0.0);
  double const r1 = residual(alone), r2 = residual(shared), t1 = tangent(alone), t2 = tangent(shared);
  std::printf(
      "  %-37s residual: %6.1f, two threads %6.1f, ratio %4.2f;   tangent: %6.1f, two threads %6.1f, ratio %4.2f\n",
      name, r1, r2, r1 / r2, t1, t2, t1 / t2);
}

using Green = planar::AncfCable<>;
using Engineering = planar::AncfCable<planar::EngineeringStrain>;

template <class B>
void packs(benchmark::State& state) {
  Swaying<B> const s;
  double sum = 0.0;
  for (auto _ : state)
    for_each_residual<B, double>(s.body, {0, count}, {s.qs(), s.vs(), s.as()},
                                 [&](Index, auto const& x) { sum += x[0]; });
  benchmark::DoNotOptimize(sum);
  state.SetItemsProcessed(state.iterations() * count);
}
BENCHMARK(packs<Green>);
BENCHMARK(packs<planar::Lrvf>);

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  std::printf("\nnanoseconds an element, packs of %d\n", simd_size);
  compare<Green>("planar AncfCable, Green strain");
  compare<Engineering>("planar AncfCable, engineering strain");
  compare<planar::Lrvf>("planar Lrvf");
  compare<planar::Se3Beam>("planar Se3Beam");
  compare<AncfCable<>>("AncfCable in space");
  compare<AncfBeam<ElasticLine>>("AncfBeam<ElasticLine>");
  compare<AncfBeam<Continuum<>>>("AncfBeam<Continuum>");
  Damping const damping{.axial = 1e-4, .shear = 2e-4, .bending = 3e-4};
  compare<planar::Lrvf>("planar Lrvf, damped", damping);
  compare<planar::Se3Beam>("planar Se3Beam, damped", damping);
  compare<AncfCable<>>("AncfCable in space, damped", damping);
  compare<AncfBeam<ElasticLine>>("AncfBeam<ElasticLine>, damped", damping);
  compare<AncfBeam<Continuum<>>>("AncfBeam<Continuum>, damped", damping);
  share_loops<Green>("planar AncfCable, Green strain");
  share_loops<planar::Lrvf>("planar Lrvf");
}
