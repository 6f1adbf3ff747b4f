// Cost of the derivatives of a run: chains with factors of the masses of the links as parameters, 2 s in 2000 steps,
// and the tracked vehicle with the stiffnesses of springs on its links as parameters, 0.2 s in 200 steps. The tolerance
// is 1e-12. Benchmarks: the run itself, `sensitivities` (direct) and `gradient` (adjoint), also with 50 snapshots.
// Counters: time as a multiple of the run, difference between direct and adjoint derivatives, relative to their norm,
// and number and memory of the snapshots. `bench/table --linear` prints the fixed cost and the cost per parameter.
#include <ctime>

#include <polybody/gradients/gradient.hpp>
#include <polybody/gradients/sensitivities.hpp>
#include <polybody/polybody.hpp>

#include "m113/vehicle.hpp"
#include "registered.hpp"

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

std::vector<Parameter> parameters(int count, std::string const& what, std::string const& touched) {
  std::vector<Parameter> all;
  for (int i = 0; i < count; ++i)
    all.push_back({what + " " + std::to_string(i) + " [1]", 1.0, 0.0, {touched + " " + std::to_string(i)}});
  return all;
}

/// Registers the run of the scenario `make(p)` and its derivatives, with respect to one parameter and to `all`.
template <class Make>
void add(std::string const& name, Make const& make, std::vector<Parameter> const& all,
         GeneralisedAlpha const& integrator) {
  auto const run_once = [=](auto const& scenario) {
    State x = scenario.start;
    simulate(scenario.model, x, integrator, scenario.options).run();
  };
  registered::add("run/" + name, [=](benchmark::State& state) {
    auto const scenario = make(std::span<double const>());
    ProblemSize const size = problem_size(scenario.model);
    State x;
    registered::time_runs(state, size.velocities + size.rows, [&] {
      x = scenario.start;
      return simulate(scenario.model, x, integrator, scenario.options);
    });
  });
  auto const multiples = [=](benchmark::State& state) {  // the unit is the time of the run instead of 1 ns
    auto const scenario = make(std::span<double const>());
    registered::count_ns(state, "runs", 1e9 * least([&] { run_once(scenario); }));
  };
  for (std::size_t const count : {std::size_t(1), all.size()}) {
    std::vector<Parameter> const some(all.begin(), all.begin() + std::ptrdiff_t(count));
    std::string const of = name + "/parameters:" + std::to_string(count);
    registered::add("sensitivities/" + of, [=](benchmark::State& state) {
      for (auto _ : state) benchmark::DoNotOptimize(sensitivities(make, some, integrator));
      multiples(state);
    });
    for (std::size_t const snapshots : {0u, 50u}) {
      if (snapshots > 0 && count > 1) continue;
      registered::add("gradient/" + of + (snapshots > 0 ? "/snapshots:50" : ""), [=](benchmark::State& state) {
        GradientResult adjoint;
        for (auto _ : state) adjoint = gradient(make, some, integrator, {.snapshots = snapshots});
        multiples(state);
        VecX const direct = sensitivities(make, some, integrator).derivatives.back().row(0).transpose();
        state.counters["error"] = (adjoint.derivatives - direct).norm() / direct.norm();
        state.counters["computed_steps"] = double(adjoint.reversal.taken);
        state.counters["megabytes"] = 1e-6 * double(adjoint.snapshot_size) * double(adjoint.reversal.snapshots);
      });
    }
  }
}
template <class B>
void add_chain(std::string const& name, int links, double turn = 0.0) {
  add(name + "/links:" + std::to_string(links), Chain<B>{links, 2.0, turn},
      parameters(std::min(links, 33), "mass of link", "link"), GeneralisedAlpha{.tolerance = 1e-12});
}

}  // namespace

int main(int argc, char** argv) {
  add_chain<Rigid<>>("Rigid", 16);
  add_chain<Rigid<>>("Rigid", 64);
  add_chain<AncfCable<>>("AncfCable", 16);
  add_chain<AncfCable<>>("AncfCable", 64);
  add_chain<Rigid<>>("Rigid_turning", 16, 2.0);
  add_chain<Rigid<>>("Rigid_turning", 64, 2.0);
  add_chain<AncfCable<>>("AncfCable_turning", 64, 2.0);
  add("vehicle", Vehicle{0.2}, parameters(100, "stiffness of spring", "spring"),
      GeneralisedAlpha{.rho_inf = 0.5, .tolerance = 1e-12, .start_correction = false});
  return registered::run(argc, argv);
}
