// The vehicle in real time, driven by keys or by a file of orders:
//   drive                                                   arrows or w a s d; x: straight on; space: stop; q: end
//   drive --links ancf --drive ../examples/drive/eight.csv
//   drive --record mine.csv                                 writes the orders to a file for --drive
// At the end the program prints the number of late frames, the computing times of the steps and the counts of Newton's
// method.
#include <cstdio>
#include <iostream>
#include <numeric>

#include <polybody/polybody.hpp>

#include "drive/clock.hpp"
#include "drive/keyboard.hpp"
#include "drive/vehicles.hpp"
#include "m113/settled_track.hpp"
#include "support/command_line.hpp"
#include "support/lines.hpp"

namespace {

using namespace polybody;
using namespace drive;
namespace fs = std::filesystem;

struct Options {
  std::string links = "rigid";
  bool bumps = false, clock = true;
  double end_time = 3600.0, step = 1e-3, frame = 0.02, rho = 0.5, tolerance = 1e-5, budget = 12.0;
  int threads = 1;
  fs::path drive, record;
};

/// Source of the orders for the drives: the keyboard or a file.
class Pilot {
 public:
  Pilot(Options const& o, Throttles const& throttles) : throttles_(throttles) {
    if (o.drive.empty())
      keyboard_ = std::make_unique<Keyboard>();
    else
      orders_ = read_orders(o.drive);
  }
  // Passes the orders up to time t [s] to the drives. Returns false if the driver has pressed q.
  bool steer(double t) {
    if (!keyboard_) {
      for (; next_ < orders_.size() && orders_[next_].t <= t; ++next_)
        order(t, orders_[next_].left, orders_[next_].right);
      return true;
    }
    for (Key key = keyboard_->next(); key != Key::none; key = keyboard_->next()) {
      if (key == Key::quit) return false;
      if (key == Key::faster) speed_ = std::min(speed_ + 2.0, fastest);
      if (key == Key::slower) speed_ = std::max(speed_ - 2.0, -fastest);
      if (key == Key::left) turn_ = std::min(turn_ + 1.0, 8.0);
      if (key == Key::right) turn_ = std::max(turn_ - 1.0, -8.0);
      if (key == Key::straight || key == Key::stop) turn_ = 0.0;
      if (key == Key::stop) speed_ = 0.0;
      order(t, speed_ - turn_, speed_ + turn_);
    }
    return true;
  }
  std::vector<Order> const& given() const { return given_; }

 private:
  static constexpr double fastest = 40.0;  // greatest speed of the sprockets [rad/s]

  void order(double t, double left, double right) {
    throttles_[0].ask(t, left);
    throttles_[1].ask(t, right);
    given_.push_back({t, left, right});
  }

  Throttles throttles_;
  std::unique_ptr<Keyboard> keyboard_;
  std::vector<Order> orders_, given_;
  std::size_t next_ = 0;
  double speed_ = 0.0, turn_ = 0.0;
};

DrivenVehicle vehicle_of(Options const& o, Throttles const& throttles) {
  BumpCourse const ground = o.bumps ? BumpCourse({{.x = 8.0, .length = 1.0, .height = 0.1}}) : BumpCourse({});
  m113::VehicleOptions options;
  options.start = m113::settled_track(options, ground);
  if (o.links == "ancf") return cable_links(throttles, options, ground);
  if (o.links == "ffr") return modal_links(throttles, options, ground);
  return rigid_links(throttles, options, ground);
}

void write_report(WallClock const& clock, RunReport const& report, double simulated) {
  Lines lines;
  std::vector<double> const steps = clock.sorted_steps();
  if (steps.empty()) return;
  double const sum = std::accumulate(steps.begin(), steps.end(), 0.0);
  auto const share = [&](double part) { return 1e6 * steps[std::size_t(part * double(steps.size() - 1))]; };
  lines("clock", {{"computed in", sum / simulated, 3, "of its time"},
                  {"frames", double(clock.frames()), 0},
                  {"late", double(clock.missed()), 0},
                  {"latest", 1e3 * clock.latest(), 1, "ms"},
                  {"set back by", clock.slipped(), 2, "s"}});
  lines("step", {{"mean", 1e6 * sum / double(steps.size()), 0, "us"},
                 {"median", share(0.5), 0, "us"},
                 {"99.9 %", share(0.999), 0, "us"},
                 {"largest", share(1.0), 0, "us"}});
  double const n = double(std::max(report.steps, 1L));
  lines("Newton", {{"iterations", double(report.iterations) / n, 2},
                   {"factorisations", double(report.factorisations) / n, 2, "a step"},
                   {"cut short", double(report.over_budget), 0, "steps"},
                   {"left", report.left, 0, "times what is tolerated"},
                   {"halved", double(report.rejected), 0, "steps"}});
}

void run(Options const& o) {
  Throttles throttles;
  DrivenVehicle const vehicle = vehicle_of(o, throttles);
  Pilot pilot(o, throttles);
  State x = vehicle.model.reference_state();
  GeneralisedAlpha const alpha{.rho_inf = o.rho, .tolerance = o.tolerance, .newton = {.budget = o.budget}};
  auto simulation = simulate(vehicle.model, x, alpha,
                             {.end_time = o.end_time, .step = o.step, .max_step_halvings = 6, .threads = o.threads});
  int const steps_of_frame = std::max(1, int(std::lround(o.frame / o.step)));
  WallClock clock(o.clock, 0.2);
  while (!simulation.done() && pilot.steer(x.t)) {
    for (int i = 0; i < steps_of_frame && !simulation.done(); ++i) {
      clock.begin_step();
      simulation.advance();
      clock.end_step();
    }
    clock.frame(x.t);
    if (clock.frames() % 5 != 0 || !o.clock) continue;
    Frame<> const hull = vehicle.tracks->hull(x);
    double const ahead = hull.A.col(0).dot(hull.v);
    std::fprintf(stderr,
                 "\r%7.1f s  %5.1f km/h  at %7.2f %7.2f m  heading %5.0f deg  drives %3.0f %3.0f rad/s  %ld late ", x.t,
                 3.6 * ahead, hull.r.x(), hull.r.y(), std::atan2(hull.A(1, 0), hull.A(0, 0)) * 180.0 / M_PI,
                 throttles[0].target(), throttles[1].target(), clock.missed());
  }
  std::fprintf(stderr, "\n");
  if (!o.record.empty()) {
    Csv csv(o.record, {"t", "left", "right"});
    for (Order const& order : pilot.given()) csv.row(order.t, order.left, order.right);
    csv.close();
  }
  Frame<> const hull = vehicle.tracks->hull(x);
  std::printf("  end: t %.3f s, x %.3f m, y %.3f m\n", x.t, hull.r.x(), hull.r.y());
  write_report(clock, simulation.report(), x.t);
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  CommandLine line{"The tracked vehicle in real time, by keys or by a file of orders."};
  line.one_of("--links", &o.links, {"rigid", "ancf", "ffr"}, "formulation of the tracks");
  line.option("--drive", &o.drive, "file of orders with lines t,left,right [s, rad/s]; if omitted, keys are read");
  line.option("--record", &o.record, "file to which the orders are written");
  line.flag("--bumps", &o.bumps, "ground with a bump of 10 cm at x = 8 m");
  line.flag("!--no-clock", &o.clock, "run as fast as the processor permits, not in real time");
  line.positive("--until", &o.end_time, "end of the run [s]");
  line.positive("--step", &o.step, "time step [s]");
  line.positive("--frame", &o.frame, "time between readings of the clock and of the keys [s]");
  line.positive("--tolerance", &o.tolerance, "tolerance of Newton's method");
  line.not_negative("--budget", &o.budget,
                    "limit of Newton iterations per step, with a factorisation counted as three; 0: no limit");
  line.between("--rho", &o.rho, 0.0, 1.0, "spectral radius of generalised-alpha at infinity");
  line.positive("--threads", &o.threads, "number of threads that compute one step");
  if (auto const code = line.parse(argc, argv)) return *code;
  try {
    run(o);
  } catch (Error const& e) {
    std::cerr << e.what() << '\n';
    return 1;
  }
}
