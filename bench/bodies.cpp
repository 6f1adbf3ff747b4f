// Every body formulation: nanoseconds per element for M a − f and for its tangent, the number of operations of M a −
// f (a counting scalar counts each +, −, ×, ÷, root or sine as one) and their rate.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdio>
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/polybody.hpp>

namespace {

/// Number that counts the operations on numbers of its type.
struct Counted {
  double x = 0.0;
  static inline long operations = 0;

  Counted() = default;
  Counted(double value) : x(value) {}  // NOLINT(google-explicit-constructor): a constant is a number
  static Counted done(double value) {
    ++operations;
    return value;
  }
  friend Counted operator+(Counted a, Counted b) { return done(a.x + b.x); }
  friend Counted operator-(Counted a, Counted b) { return done(a.x - b.x); }
  friend Counted operator*(Counted a, Counted b) { return done(a.x * b.x); }
  friend Counted operator/(Counted a, Counted b) { return done(a.x / b.x); }
  friend Counted operator-(Counted a) { return done(-a.x); }
  Counted& operator+=(Counted b) { return *this = *this + b; }
  Counted& operator-=(Counted b) { return *this = *this - b; }
  Counted& operator*=(Counted b) { return *this = *this * b; }
  Counted& operator/=(Counted b) { return *this = *this / b; }
  friend Counted sqrt(Counted a) { return done(std::sqrt(a.x)); }
  friend Counted sin(Counted a) { return done(std::sin(a.x)); }
  friend Counted cos(Counted a) { return done(std::cos(a.x)); }
  friend Counted atan(Counted a) { return done(std::atan(a.x)); }
  friend Counted atan2(Counted a, Counted b) { return done(std::atan2(a.x, b.x)); }
  friend double value_of(Counted a) { return a.x; }
};

}  // namespace

template <>
struct Eigen::NumTraits<Counted> : Eigen::NumTraits<double> {
  using Real = Counted;
  using NonInteger = Counted;
  using Nested = Counted;
  using Literal = double;
};
template <class Operation>
struct Eigen::ScalarBinaryOpTraits<Counted, double, Operation> {
  using ReturnType = Counted;
};
template <class Operation>
struct Eigen::ScalarBinaryOpTraits<double, Counted, Operation> {
  using ReturnType = Counted;
};

namespace {

using namespace polybody;
using Clock = std::chrono::steady_clock;

template <class F>
double fastest(Index elements, F&& pass) {
  double best = 1e300;
  for (int i = 0; i < 300; ++i) {
    auto const start = Clock::now();
    pass();
    best = std::min(best, std::chrono::duration<double, std::nano>(Clock::now() - start).count() / double(elements));
  }
  return best;
}

Bar bar() {
  return {.length = 4.0,
          .section = Rectangle{.height = 0.03, .width = 0.02},
          .material = Material{.density = 7800.0, .young = 2e11, .poisson = 0.3}};
}

template <class B>
void measure(char const* name, B const& body) {
  VecX q(body.coordinates());
  body.reference({q.data(), std::size_t(q.size())});
  VecX delta(body.velocities()), v(body.velocities()), a(body.velocities());
  for (Index i = 0; i < delta.size(); ++i) {
    delta[i] = 1e-3 * std::sin(7.0 * double(i));
    v[i] = 0.1 * std::sin(3.0 * double(i));
    a[i] = std::cos(5.0 * double(i));
  }
  VecX at(q.size());
  auto const span = [](auto const& x) {
    return std::span<typename std::decay_t<decltype(x)>::Scalar const>(x.data(), std::size_t(x.size()));
  };
  body.template plus<double>(span(q), span(delta), {at.data(), std::size_t(at.size())});
  Index const elements = body.elements();

  auto const use = [](Index, auto const& x) {  // uses all entries, so that the compiler cannot omit any
    benchmark::DoNotOptimize(x.data());
    benchmark::ClobberMemory();
  };
  ForceScratch<B, double> force(body);
  TangentScratch<B> tangent(body);
  int const repeats = elements < 16 ? 64 : 1;  // because one pass is too short for the clock
  double const ns = fastest(elements * repeats, [&] {
    for (int i = 0; i < repeats; ++i)
      for_each_residual<B, double>(body, {0, elements}, {span(at), span(v), span(a)}, force, use);
  });
  double const tangent_ns = fastest(elements * repeats, [&] {
    for (int i = 0; i < repeats; ++i)
      for_each_element_tangent<B>(body, {0, elements}, {span(at), span(v)}, {1.5, 0.1, 1.0}, tangent, use);
  });

  VecXOf<Counted> const qc = at.cast<Counted>(), vc = v.cast<Counted>(), ac = a.cast<Counted>();
  ForceScratch<B, Counted> counted(body);
  Counted::operations = 0;
  body.template inertia<Counted>(0, span(qc), span(ac), counted.x);
  body.template force<Counted>(0, span(qc), span(vc), counted.force);
  long const operations = Counted::operations + long(element_columns(body));
  std::printf("  %-30s %8.1f ns, %6ld operations, %5.2f per ns;   tangent %8.1f ns, both %8.1f ns\n", name, ns,
              operations, double(operations) / ns, tangent_ns, ns + tangent_ns);
}

void all_bodies(benchmark::State& state) {
  for (auto _ : state) {
    Index const n = 64;
    std::printf("\nan element (Rigid, Ffr: the body), packs of %d where alike elements go in packs\n", simd_size);
    measure("Rigid<>", Rigid<>::from(bar()));
    measure("Rigid<EulerParameters>", Rigid<EulerParameters>::from(bar()));
    measure("AncfCable<>", AncfCable<>::from(bar(), n));
    measure("AncfBeam<ElasticLine>", AncfBeam<ElasticLine>::from(bar(), n));
    measure("AncfBeam<Continuum<>>", AncfBeam<Continuum<>>::from(bar(), n));
    measure("Lrvf<RelativeRotation>", Lrvf<>::from(bar(), n));
    measure("Lrvf<Direct>", Lrvf<Direct>::from(bar(), n));
    Structure const s = structure_of(bar(), 8);
    measure("Ffr, 6 modes", Ffr(s, fixed_interface_modes(s, 6)));
    measure("Ffr, 6 modes, stiffening", Ffr(s, fixed_interface_modes(s, 6), {.stiffening = true}));
    measure("Ffr, 48 nodal coordinates", Ffr(s, nodal_coordinates(s)));
    measure("planar::Rigid", planar::Rigid::from(bar()));
    measure("planar::AncfCable<>", planar::AncfCable<>::from(bar(), n));
    measure("planar::Lrvf", planar::Lrvf::from(bar(), n));
    measure("planar::Ffr, 24 nodal", planar::Ffr::from(bar(), 8));
  }
}
BENCHMARK(all_bodies)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
