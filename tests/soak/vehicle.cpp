// Tracked vehicle for a minute of simulated time or more: growth of memory, drift of constraints, balance of energy.
//   soak_vehicle [seconds [step]]
// The test fails if memory grows after the first five seconds or if a pin opens. It also fails if a track leaves its
// sprocket or its middle plane, or if the energy balance is not closed.
#include <unistd.h>

#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>

#include <polybody/polybody.hpp>

#include "m113/settled_track.hpp"
#include "m113/track_checks.hpp"

using namespace polybody;

namespace {

// Resident memory of this process [kB]; 0 if the system does not provide it.
long memory() {
  std::ifstream in("/proc/self/statm");
  long whole = 0, resident = 0;
  in >> whole >> resident;
  return in ? resident * (sysconf(_SC_PAGESIZE) / 1024) : 0;
}

struct Worst {
  double gap = 0.0, spring = 0.0;  // [m], of the ideal pins and of the track's closing spring (10⁹ N/m)
  double sideways = 0.0, off_path = 0.0;
};

Worst worst_of(m113::TrackedVehicle const& vehicle, System& system, State const& x,
               m113::VehicleOptions const& options) {
  system.evaluate(x.q, x.v, x.t);
  Worst w;
  for (m113::Side const side : {m113::Side::left, m113::Side::right}) {
    m113::Track const& track = vehicle.track(side);
    for (std::size_t i = 0; i < track.front.size(); ++i) {
      double& gap = i == std::size_t(options.cut) ? w.spring : w.gap;
      gap = std::max(gap,
                     (track.front[i](x).r - track.rear[(i + track.rear.size() - 1) % track.rear.size()](x).r).norm());
    }
    m113::TrackDerailment const fault = m113::track_derailment(vehicle, system, x, side, options.start);
    w.sideways = std::max(w.sideways, fault.sideways);
    w.off_path = std::max(w.off_path, fault.off_path);
  }
  return w;
}

bool drive(double end_time, double step) {
  m113::VehicleOptions options;
  options.start = m113::settled_track(options, BumpCourse({}));
  Ramp const speed = m113::drive(m113::moderate_sprocket_speed, 0.1);
  m113::Vehicle<Rigid<>, Constraint, BumpCourse> const vehicle(Constraint{}, {speed, speed}, options, BumpCourse({}));
  State x = vehicle.model.reference_state();
  System system(vehicle.model, with<Capabilities::motion>);
  EnergyAudit audit(vehicle.model);

  std::printf("%6s %12s %10s %12s %12s %12s %12s %12s %10s %8s\n", "t [s]", "forward [m]", "yaw [rad]", "of pins [m]",
              "spring [m]", "off plane", "off path [m]", "work [kJ]", "lost [%]", "kB");
  Worst early, late;
  long early_memory = 0, late_memory = 0;
  double next = 1.0;
  std::string trouble;
  auto run = simulate(vehicle.model, x, GeneralisedAlpha{.rho_inf = 0.8, .tolerance = 1e-5},
                      {.end_time = end_time, .step = step, .max_step_halvings = 6});
  for (State const& now : run) {
    audit.record(now);
    if (now.t < next - 1e-9) continue;
    next += 1.0;
    if (trouble.empty()) trouble = m113::track_warning(vehicle, now);
    Worst const w = worst_of(vehicle, system, now, options);
    Worst& of = now.t < 0.25 * end_time ? early : late;
    of.gap = std::max(of.gap, w.gap);
    of.spring = std::max(of.spring, w.spring);
    of.sideways = std::max(of.sideways, w.sideways);
    of.off_path = std::max(of.off_path, w.off_path);
    if (early_memory == 0 && now.t > 4.9) early_memory = memory();
    late_memory = memory();
    Frame<double> const hull = vehicle.hull(now);
    std::printf("%6.1f %12.4f %10.2e %12.2e %12.2e %12.2e %12.2e %12.2f %10.4f %8ld\n", now.t,
                hull.r.x() - m113::chassis.x, std::atan2(hull.A(1, 0), hull.A(0, 0)), w.gap, w.spring, w.sideways,
                w.off_path, 1e-3 * audit.work_of_drives(), 1e2 * audit.relative(), late_memory);
    std::fflush(stdout);
  }
  std::printf("%.1f s of processor time for %.1f s\n", double(std::clock()) / CLOCKS_PER_SEC, x.t);

  bool good = true;
  auto const ask = [&](bool holds, char const* what) {
    if (!holds) std::printf("FAILED: %s\n", what);
    good = good && holds;
  };
  ask(x.t >= end_time - 1e-9, "the run ends early");
  ask(trouble.empty(), trouble.c_str());
  ask(late_memory <= early_memory + 512, "memory grows");
  ask(late.gap <= 1e-7, "a pin opens by more than 1e-7 m");
  ask(late.spring <= 5e-5, "the spring that closes a track opens by more than 50 kN explain");
  ask(late.sideways <= m113::horn_play, "links drift off the middle plane by more than the play of their horns");
  ask(late.off_path <= 1.5 * early.off_path + 1e-3, "links drift off the path of the start");
  ask(audit.relative() <= 0.01, "more than one per cent of the energy is not accounted for");
  return good;
}

}  // namespace

int main(int argc, char** argv) {
  double const end_time = argc > 1 ? std::atof(argv[1]) : 60.0, step = argc > 2 ? std::atof(argv[2]) : 5e-4;
  if (!(end_time > 0.0 && step > 0.0)) {
    std::cerr << "soak_vehicle [seconds [step]], both above zero\n";
    return 2;
  }
  try {
    return drive(end_time, step) ? 0 : 1;
  } catch (Error const& e) {
    std::cerr << e.what() << '\n';
    return 1;
  }
}
