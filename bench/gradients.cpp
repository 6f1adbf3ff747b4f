// What derivatives of a whole run cost beside the run itself under the same options: chains of links, each of whose
// masses and lengths may be a parameter.   bench_gradients
#include <cstdio>
#include <ctime>

#include <benchmark/benchmark.h>

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
        bodies.push_back(model.add(B::from(bar, 1)));
      else
        bodies.push_back(model.add(B::from(bar)));
      if (i == 0)
        model.connect(Pin{}, model.ground().at({0, 0, 0}), bodies[0].at(0.0));
      else
        model.connect(Pin{}, bodies[std::size_t(i - 1)].at(0.1), bodies[std::size_t(i)].at(0.0));
    }
    State const start = model.reference_state();
    auto const tip = bodies.back();
    std::vector<Output<M>> outputs{
        {"tip z [m]", [tip](M const& m, State const& x) { return position(m, x, tip.at(0.1))[2]; }}};
    return Scenario<M>{std::move(model), start, {.until = 0.2, .step = 1e-3}, std::move(outputs)};
  }
};

template <class B>
void print(char const* name, int links) {
  Chain<B> const make{links};
  GeneralizedAlpha const integrator{.tolerance = 1e-12};
  auto scenario = make({});
  double run = 1e9, derived[2] = {1e9, 1e9};
  int const counts[2] = {1, 9};
  double left = 0.0;
  for (int again = 0; again < 3; ++again) {
    State x = scenario.start;
    double begin = cpu();
    simulate(scenario.model, x, integrator, scenario.options).run();
    run = std::min(run, cpu() - begin);
    for (int k = 0; k < 2; ++k) {
      std::vector<Parameter> parameters;
      for (int i = 0; i < counts[k]; ++i) parameters.push_back({"mass of link " + std::to_string(i) + " [1]", 1.0});
      begin = cpu();
      left = sensitivities(make, parameters, integrator).left;
      derived[k] = std::min(derived[k], cpu() - begin);
    }
  }
  double const each = (derived[1] - derived[0]) / double(counts[1] - counts[0]);
  std::printf("| %s | %d | %.2f | %.2f | %.2f | %.1e |\n", name, links, 1e3 * run, (derived[0] - each) / run,
              each / run, left);
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  std::printf(
      "0.2 s in steps of 1 ms, tolerance 1e-12\n\n| links | | run [ms] | derivatives: runs | and a parameter | left "
      "|\n|---|---|---|---|---|---|\n");
  print<Rigid<>>("rigid", 16);
  print<Rigid<>>("rigid", 64);
  print<AncfCable<>>("cables", 16);
}
