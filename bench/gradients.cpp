// Cost of the derivatives of a run, as multiples of the run with the same options: chains with factors of the masses of
// the links as parameters, and the tracked vehicle with the stiffnesses of springs on its links as parameters.
#include <cstdio>
#include <ctime>

#include <benchmark/benchmark.h>

#include <polybody/gradients/gradient.hpp>
#include <polybody/gradients/sensitivities.hpp>
#include <polybody/polybody.hpp>

#include "m113/vehicle.hpp"

namespace {

using namespace polybody;

double cpu() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// Chain of rigid links or cables of 0.1 m on spherical joints, released from the horizontal, at rest or rotating about
/// the vertical. The parameters are factors of the masses of the links.
template <class B>
struct Chain {
  int links;
  double end_time;
  double turn = 0.0;  // initial angular velocity about the vertical [rad/s]

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
    State start = model.reference_state();
    for (auto const& link : bodies) model.set_velocity(start, link, {0, 0, 0}, {0, 0, turn});
    auto const tip = bodies.back();
    std::vector<Output<M>> outputs{
        {"tip z [m]", [tip](M const& m, State const& x) { return position(m, x, tip.at(0.1))[2]; }}};
    return with_objective(
        Scenario<M>{std::move(model), start, {.end_time = end_time, .step = 1e-3}, std::move(outputs)},
        [tip](auto const& m, auto const& x) { return position(m, x, tip.at(0.1))[2]; });
  }
};

/// Vehicle that drops onto its tracks, with springs from 100 of its links to the ground. The parameters are factors of
/// the stiffnesses of the springs.
struct Vehicle {
  using Car = m113::Vehicle<>;
  double end_time;
  m113::VehicleOptions options = {};

  auto operator()(std::span<double const> p) const {
    Car car(Constraint{}, {m113::drive(25.0), m113::drive(25.0)}, options);
    for (std::size_t i = 0; i < 100; ++i) {
      Vec2 const& at = options.start.links[i / 2].centre;
      Vec3 const above(at[0], i % 2 == 0 ? 1.0 : -1.0, at[1] + 1.0);
      car.model.apply(SpringDamper{.stiffness = 1e3 * (i < p.size() ? p[i] : 1.0), .damping = 10.0, .free_length = 1.0},
                      car.model.ground().at(above), car.sides[i % 2].front[i / 2], "spring " + std::to_string(i));
    }
    State const start = car.model.reference_state();
    auto const height = [hull = car.chassis[0]](auto const& m, auto const& x) {
      return position(m, x, hull.at(Vec3(0, 0, 0)))[2];
    };
    std::vector<Output<Car::ModelType>> outputs{{"z [m]", height}};
    return with_objective(
        Scenario<Car::ModelType>{std::move(car.model), start, {.end_time = end_time, .step = 1e-3}, outputs}, height);
  }
};

/// Processor time of f [s], the least of three calls.
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

/// Prints a row of the table: cost of the derivatives of the run of the scenario `make(p)`, with respect to one
/// parameter and to `all` parameters.
template <class Make, class I>
void print(char const* name, int links, Make const& make, std::vector<Parameter> const& all, I const& integrator) {
  auto const of = [&](std::size_t count) {
    return std::vector<Parameter>(all.begin(), all.begin() + std::ptrdiff_t(count));
  };
  auto const scenario = make(std::span<double const>());
  double const run = least([&] {
    State x = scenario.start;
    simulate(scenario.model, x, integrator, scenario.options).run();
  });
  std::size_t const counts[2] = {1, all.size()};
  double direct[2], adjoint[2];
  VecX by_direct, by_adjoint;
  for (int k = 0; k < 2; ++k) {
    auto const parameters = of(counts[k]);
    direct[k] =
        least([&] { by_direct = sensitivities(make, parameters, integrator).derivatives.back().row(0).transpose(); });
    adjoint[k] = least([&] { by_adjoint = gradient(make, parameters, integrator).derivatives; });
  }
  GradientResult few;
  double const with_few = least([&] { few = gradient(make, of(1), integrator, {.snapshots = 50}); });
  auto const each = [&](double const* t) { return (t[1] - t[0]) / double(counts[1] - counts[0]); };
  std::printf("| %s | %d | %zu | %.0f | %.2f | %.2f | %.2f | %.3f | %.2f, %zu steps, %.1f MB | %.0e |\n", name, links,
              all.size(), 1e3 * run, (direct[0] - each(direct)) / run, each(direct) / run,
              (adjoint[0] - each(adjoint)) / run, each(adjoint) / run, (with_few - each(adjoint)) / run,
              few.reversal.taken, 1e-6 * few.snapshot_size * double(few.reversal.snapshots),
              (by_direct - by_adjoint).norm() / by_direct.norm());
  std::fflush(stdout);
}

std::vector<Parameter> parameters(int count, std::string const& what, std::string const& touched) {
  std::vector<Parameter> all;
  for (int i = 0; i < count; ++i)
    all.push_back({what + " " + std::to_string(i) + " [1]", 1.0, 0.0, {touched + " " + std::to_string(i)}});
  return all;
}
template <class B>
void print_chain(char const* name, int links, double turn = 0.0) {
  print(name, links, Chain<B>{links, 2.0, turn}, parameters(std::min(links, 33), "mass of link", "link"),
        GeneralisedAlpha{.tolerance = 1e-12});
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  std::printf(
      "chains: 2 s in 2000 steps, from rest in a plane or turning at 2 rad/s; vehicle: 0.2 s in 200; tolerance 1e-12; "
      "cost in runs\n\n| | links | parameters | run "
      "[ms] | direct | and a parameter | adjoint | and a parameter | adjoint with 50 snapshots | apart "
      "|\n|---|---|---|---|---|---|---|---|---|---|\n");
  print_chain<Rigid<>>("rigid", 16);
  print_chain<Rigid<>>("rigid", 64);
  print_chain<AncfCable<>>("`AncfCable`", 16);
  print_chain<AncfCable<>>("`AncfCable`", 64);
  print_chain<Rigid<>>("rigid, turning", 16, 2.0);
  print_chain<Rigid<>>("rigid, turning", 64, 2.0);
  print_chain<AncfCable<>>("`AncfCable`, turning", 64, 2.0);
  print("vehicle", 128, Vehicle{0.2}, parameters(100, "stiffness of spring", "spring"),
        GeneralisedAlpha{.rho_inf = 0.5, .tolerance = 1e-12, .start_correction = false});
}
