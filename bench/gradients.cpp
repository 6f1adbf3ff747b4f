// What derivatives of a whole run cost beside the run itself under the same options: chains of links, each of whose
// masses and lengths may be a parameter.   bench_gradients
#include <cstdio>
#include <ctime>

#include <benchmark/benchmark.h>

#include <polybody/gradients/gradient.hpp>
#include <polybody/gradients/sensitivities.hpp>
#include <polybody/polybody.hpp>

namespace {

using namespace polybody;

double cpu() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// A chain of rigid links or cables of 0.1 m on pins, let go from the side; parameters are factors of links' masses.
template <class B>
struct Chain {
  int links;
  double until;

  auto operator()(std::span<double const> p) const {
    using Pin = Joint<Spherical, Constraint>;
    using M = Model<Bodies<B>, Joints<Pin>>;
    M model{Gravity{0, 0, -9.81}};
    Bar bar{.length = 0.1, .section = Circle{.radius = 0.005}, .material = Material{.density = 0.0, .young = 2e9}};
    std::vector<BodyHandle<B>> bodies;
    for (int i = 0; i < links; ++i) {
      bar.placement = Placement::at({0.1 * i, 0, 0});
      bar.material->density = 7800.0 * (std::size_t(i) < p.size() ? p[std::size_t(i)] : 1.0);
      if constexpr (requires { B::from(bar, 1); })
        bodies.push_back(model.add(B::from(bar, 1), "link " + std::to_string(i)));
      else
        bodies.push_back(model.add(B::from(bar), "link " + std::to_string(i)));
      if (i == 0)
        model.connect(Pin{}, model.ground().at({0, 0, 0}), bodies[0].at(0.0));
      else
        model.connect(Pin{}, bodies[std::size_t(i - 1)].at(0.1), bodies[std::size_t(i)].at(0.0));
    }
    State const start = model.reference_state();
    auto const tip = bodies.back();
    std::vector<Output<M>> outputs{
        {"tip z [m]", [tip](M const& m, State const& x) { return position(m, x, tip.at(0.1))[2]; }}};
    return rated(Scenario<M>{std::move(model), start, {.until = until, .step = 1e-3}, std::move(outputs)},
                 [tip](auto const& m, auto const& x) { return position(m, x, tip.at(0.1))[2]; });
  }
};

/// Seconds that f takes, the least of three.
template <class F>
double least(F&& f) {
  double best = 1e9;
  for (int again = 0; again < 3; ++again) {
    double const begin = cpu();
    f();
    best = std::min(best, cpu() - begin);
  }
  return best;
}

template <class B>
void print(char const* name, int links) {
  Chain<B> const make{links, 2.0};
  GeneralizedAlpha const integrator{.tolerance = 1e-12};
  auto const of = [](int count) {
    std::vector<Parameter> parameters;
    for (int i = 0; i < count; ++i)
      parameters.push_back({"mass of link " + std::to_string(i) + " [1]", 1.0, 0.0, {"link " + std::to_string(i)}});
    return parameters;
  };
  auto const scenario = make({});
  double const run = least([&] {
    State x = scenario.start;
    simulate(scenario.model, x, integrator, scenario.options).run();
  });
  int const counts[2] = {1, std::min(links, 33)};
  double direct[2], adjoint[2];
  VecX by_direct, by_adjoint;
  for (int k = 0; k < 2; ++k) {
    auto const parameters = of(counts[k]);
    direct[k] =
        least([&] { by_direct = sensitivities(make, parameters, integrator).slopes.back().row(0).transpose(); });
    adjoint[k] = least([&] { by_adjoint = gradient(make, parameters, integrator).slopes; });
  }
  Gradient few;
  double const with_few = least([&] { few = gradient(make, of(1), integrator, {.snapshots = 50}); });
  auto const each = [&](double const* t) { return (t[1] - t[0]) / double(counts[1] - counts[0]); };
  std::printf("| %s | %d | %.0f | %.2f | %.2f | %.2f | %.2f | %.2f, %zu steps, %.1f MB | %.0e |\n", name, links,
              1e3 * run, (direct[0] - each(direct)) / run, each(direct) / run, (adjoint[0] - each(adjoint)) / run,
              each(adjoint) / run, (with_few - each(adjoint)) / run, few.reversal.taken,
              1e-6 * few.snapshot_size * double(few.reversal.snapshots),
              (by_direct - by_adjoint).norm() / by_direct.norm());
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  std::printf(
      "2 s in 2000 steps, tolerance 1e-12; cost in runs\n\n| links | | run [ms] | direct | and a parameter | adjoint | "
      "and a parameter | adjoint with 50 snapshots | apart |\n|---|---|---|---|---|---|---|---|---|\n");
  print<Rigid<>>("rigid", 16);
  print<Rigid<>>("rigid", 64);
  print<AncfCable<>>("cables", 16);
  print<AncfCable<>>("cables", 64);
}
