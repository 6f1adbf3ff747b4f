// The vehicle of Chapter 3 in independent coordinates, as the thesis integrates it (§3.3). The thesis names no
// integrator: Adams–Bashforth–Moulton of variable order and step is our choice. The pins have five formulations at one
// tolerance. The program prints the processor time per second of motion, its ratio to ideal pins (thesis: penalty 1e9,
// bushing and ANCF take 6, 3 and 5 times as long), and the limit of the steps: the fastest rate of the motion, an
// eigenvalue by power iteration.
//   track_times --until 0.2
//   track_times --names
#include <ctime>
#include <iostream>
#include <polybody/polybody.hpp>

#include "m113/settled_track.hpp"
#include "m113/vehicle.hpp"
#include "support/command_line.hpp"
#include "support/lines.hpp"

using namespace polybody;

namespace {

struct Options {
  double end_time = 0.2, tolerance = 1e-6, limit = 60.0, speed = 20.0;
  bool names = false;
};

double processor_time() { return double(std::clock()) / CLOCKS_PER_SEC; }

/// Largest |eigenvalue| of the motion linearised at x [1/s], by power iteration with differences of accelerations. The
/// result is the mean growth over the last 200 of 400 iterations, because iterates of complex eigenvalues rotate.
double fastest_rate(System& system, State const& x) {
  ForwardDynamics<> forward(system);
  Index const n = system.velocities();
  VecX place = VecX::Random(n), speed = VecX::Random(n), q = x.q, v = x.v, a = x.a, lambda = x.lambda;
  forward.accelerations(system, {x.q, x.v, x.t}, a, lambda);
  VecX const before = a;
  double grown = 0.0, scale = 1.0;  // factor of displacements in the norm, near ω [1/s]
  for (int k = 0; k < 400; ++k) {
    double const size = 1e-4 / (scale * place.norm() + speed.norm());
    system.plus(x.q, size * place, q);
    forward.accelerations(system, {q, x.v + size * speed, x.t}, a, lambda);
    VecX const faster = (a - before) / size;
    double const was = std::hypot(scale * place.norm(), speed.norm());
    place = speed;
    speed = faster;
    double const is = std::hypot(scale * place.norm(), speed.norm());
    if (k >= 200) grown += std::log(is / was) / 200.0;
    scale = std::max(scale, is / was);
    place /= is;
    speed /= is;
  }
  return std::exp(grown);
}

// Cost of a run, and the limit of its steps.
struct Taken {
  System const& system;
  RunReport const& report;
  double simulated, spent, rate;  // simulated time [s], processor time [s], fastest rate [1/s]
  Violation worst;

  double per_second() const { return spent / simulated; }
};
void write(Lines& lines, std::string const& name, Taken const& t, double of_pins) {
  double const step = t.simulated / double(t.report.steps);
  lines("steps, " + name, {{"speeds", double(t.system.velocities()), 0},
                           {"rows", double(t.system.rows()), 0},
                           {"simulated", t.simulated, 3, "s"},
                           {"steps", double(t.report.steps), 0},
                           {"refused", double(t.report.rejected), 0},
                           {"evaluations", double(t.report.evaluations), 0},
                           {"mean step", 1e6 * step, 2, "us"}});
  lines("time, " + name, {{"CPU for a second", t.per_second(), 1, "s"},
                          {"of ideal pins", of_pins > 0.0 ? t.per_second() / of_pins : 1.0, 1}});
  lines("limits, " + name, {{"fastest rate", t.rate, -2, "1/s"}, {"rate times step", t.rate * step, 2}});
  lines("joints, " + name, {{"open", t.worst.position, -1, "m"},
                            {"velocity", t.worst.velocity, -1, "m/s"},
                            {"acceleration", t.worst.acceleration, -1, "m/s^2"},
                            {"independent coordinates chosen", double(t.report.last.choices), 0, "times"}});
}

template <class Body, class Policy>
double measure(Options const& o, std::string const& name, Policy const& policy, double of_pins) {
  m113::VehicleOptions options;
  options.start = m113::settled_track(options);
  Ramp const drive{.target = o.speed, .duration = 0.5, .start = 0.1, .rounding = 0.1};
  m113::Vehicle<Body, Policy> const vehicle(policy, {drive, drive}, options);
  auto const& model = vehicle.model;
  State x = model.reference_state();
  System system(model);
  AdamsBashforthMoulton<CoordinatePartitioning> const integrator{.relative_tolerance = o.tolerance,
                                                                 .absolute_tolerance = o.tolerance};
  auto run = simulate(model, x, integrator, {.end_time = o.end_time, .step = 1e-5});
  Violation worst;
  double spent = 0.0;
  long seen = 0;
  Progress progress(0.0, o.end_time, name);
  while (!run.done() && spent < o.limit) {
    double const start = processor_time();
    run.advance();
    spent += processor_time() - start;
    if (seen++ % 100 != 0) continue;
    Violation const open = largest_violation(system, x);
    worst.position = std::max(worst.position, open.position);
    worst.velocity = std::max(worst.velocity, open.velocity);
    worst.acceleration = std::max(worst.acceleration, open.acceleration);
    progress.update(x.t);
  }
  progress.finish();
  System stepped = stepped_system(model);
  Taken const taken{stepped, run.report(), x.t, spent, fastest_rate(stepped, reduce(stepped, x)), worst};
  Lines lines;
  write(lines, name, taken, of_pins);
  if (o.names && of_pins == 0.0) {
    std::vector<std::string> const independent =
        independent_velocities(stepped, reduce(stepped, model.reference_state()));
    lines("partition, " + name, {{"independent speeds", double(independent.size()), 0}});
    for (std::string const& each : independent) std::cout << "    " << each << '\n';
  }
  return taken.per_second();
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  CommandLine line{"The vehicle by coordinate partitioning and Adams-Bashforth-Moulton: processor times of its pins."};
  line.positive("--until", &o.end_time, "end of the runs [s]");
  line.positive("--tolerance", &o.tolerance, "relative and absolute tolerance of all runs");
  line.positive("--limit", &o.limit, "processor time after which a run ends [s]");
  line.option("--speed", &o.speed, "speed of the sprockets from 0.6 s on [rad/s]");
  line.flag("--names", &o.names, "lists the independent speeds of ideal pins by name");
  if (auto const code = line.parse(argc, argv)) return *code;
  try {
    double const pins = measure<Rigid<>>(o, "ideal", Constraint{}, 0.0);
    measure<Rigid<>>(o, "penalty 1e9", m113::penalty_pin(1e9), pins);
    measure<Rigid<>>(o, "penalty 1e7", m113::penalty_pin(1e7), pins);
    measure<Rigid<>>(o, "bushing", m113::bushing_pin(m113::pin_stiffness), pins);
    measure<AncfCable<>>(o, "ANCF", AncfLinear{}, pins);
  } catch (Error const& e) {
    std::cerr << e.what() << '\n';
    return 1;
  }
}
