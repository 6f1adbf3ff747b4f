// N four-bars in a row through their singular configurations [A02, González et al. 2006]: error of implicit methods
// after 10 s compared with the closed form. The results are the counters `error` [m] and `energy` [J]; a failed run
// reports its error. All runs take some minutes; select with --benchmark_filter='Hht.*/2/'.
#include <benchmark/benchmark.h>

#include <cmath>
#include <polybody/polybody.hpp>

#include "support/linkages.hpp"

namespace {

using namespace polybody;

/// Angle θ of the bars from the vertical at time t [rad], the solution of
///   θ¨ = A sin θ, A = g ((N + 1)/2 + N)/((N + 1)/3 + N), θ(0) = 0, θ˙(0) = 1.
/// With φ = θ/2 and k² = A/(¼ + A) this gives φ˙² = (¼ + A)(1 − k² cos² φ). Hence
///   √(¼ + A) t = F(φ + π/2, k) − K(k)
/// with the elliptic integrals F and K of the first kind.
double angle(int n, double t) {
  double const a = 9.81 * (0.5 * (n + 1) + n) / ((n + 1) / 3.0 + n), omega = std::sqrt(0.25 + a);
  double const k = std::sqrt(a) / omega, quarter = std::comp_ellint_1(k), half_pi = 0.5 * std::numbers::pi;
  double phi = half_pi * omega * t / quarter;
  for (int i = 0; i < 50; ++i) {
    double const c = std::cos(phi);
    phi -= (std::ellint_1(k, phi + half_pi) - quarter - omega * t) * std::sqrt(1.0 - k * k * c * c);
  }
  return 2.0 * phi;
}

template <class I>
void turn(benchmark::State& state, I const& integrator) {
  int const n = int(state.range(0));
  double const step = 1e-3 / double(state.range(1)), end_time = 10.0;
  for (auto _ : state) {
    FourBars<InPlane<Constraint>> bars(n);
    double const before = energy(bars.model, bars.x).total();
    try {
      RunReport const report = simulate(bars.model, bars.x, integrator, {.end_time = end_time, .step = step}).run();
      state.counters["newton_iterations"] = double(report.iterations) / double(report.steps);
    } catch (Error const& e) {
      state.SkipWithError(e.what());
      break;
    }
    double const theta = angle(n, end_time);
    state.counters["error"] = (bars.corner() - Vec3(std::sin(theta), std::cos(theta), 0.0)).norm();
    state.counters["energy"] = energy(bars.model, bars.x).total() - before;
  }
}

template <class I>
void list(char const* name, I const& integrator) {
  benchmark::RegisterBenchmark(name, [integrator](benchmark::State& state) { turn(state, integrator); })
      ->ArgNames({"N", "steps_per_ms"})
      ->ArgsProduct({{1, 2, 3, 5, 10, 20, 40}, {1, 2, 4, 8, 16}})
      ->Iterations(1)
      ->Unit(benchmark::kSecond);
}

}  // namespace

int main(int argc, char** argv) {
  list("GeneralisedAlpha", GeneralisedAlpha{});
  list("GeneralizedAlpha_0.95", GeneralisedAlpha{.rho_inf = 0.95});
  list("GeneralizedAlpha_stabilised", GeneralisedAlpha{.rho_inf = 0.95, .stabilised = true});
  list("HhtAlpha", HhtAlpha{});
  list("Newmark", Newmark{.gamma = 0.6, .beta = 0.3025});
  list("EnergyMomentum", EnergyMomentum{});
  list("EnergyDecaying", EnergyDecaying{.rho_inf = 0.95});
  list("Radau", Radau{});
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
