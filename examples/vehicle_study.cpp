// The tracked vehicle with two uncertain parameters: the preload of its tensioners and the friction of its tracks. A
// Latin hypercube of both parameters gives the distribution of the force in a pin and of the distance that the vehicle
// travels. The study can be interrupted and continued, on threads or on MPI ranks:
//   vehicle_study --threads 2 --out out/vehicle_study
//   mpirun -np 2 vehicle_study --out out/vehicle_study
#include <iostream>
#include <polybody/polybody.hpp>
#include <polybody/study.hpp>

#include "m113/settled_track.hpp"
#include "m113/track_checks.hpp"
#include "m113/vehicle.hpp"
#include "support/command_line.hpp"
#include "support/ranks.hpp"

using namespace polybody;
namespace fs = std::filesystem;

namespace {

struct Options {
  int samples = 24, seed = 1, threads = 1;
  double end_time = 1.5, speed = 10.0, step = 1e-3;
  fs::path out = "out/vehicle_study";
  bool retry = false, no_plot = false;
};

constexpr int watched_pin = 20;  // number of a pin of the left track that is on the ground at the start

// Largest and mean force in the watched pin [kN], and distance travelled [m].
std::array<double, 3> drive(Options const& o, Point const& p) {
  m113::VehicleOptions options{.preload = 1e3 * p["preload"], .friction_factor = p["friction factor"]};
  options.start = m113::settled_track(options);
  Ramp const ramp{.target = o.speed, .duration = 0.6 * o.end_time, .start = 0.1 * o.end_time, .rounding = 0.1};
  m113::Vehicle<Rigid<>, Constraint> const vehicle(Constraint{}, {ramp, ramp}, options);
  State x = vehicle.model.reference_state();
  double const begin = vehicle.hull(x).r.x();
  double most = 0.0, sum = 0.0;
  long steps = 0;
  for (auto const& now : simulate(vehicle.model, x, GeneralisedAlpha{.rho_inf = 0.0},
                                  {.end_time = o.end_time, .step = o.step, .max_step_halvings = 8})) {
    double const force = 1e-3 * now.reaction(vehicle.side(m113::Side::left).pins[watched_pin]).f.norm();
    most = std::max(most, force);
    sum += force;
    ++steps;
    if (std::string const trouble = m113::track_warning(vehicle, now); !trouble.empty()) throw Diverged{trouble};
  }
  return {most, sum / double(steps), vehicle.hull(x).r.x() - begin};
}

void report(Options const& o, StudyResults const& found) {
  write_table(found, o.out / "vehicle.csv");
  std::cout << found.points.size() << " vehicles, " << found.resumed << " of them from an earlier run, "
            << found.failed() << " failed\n";
  if (found.finished() - found.failed() < 2) return;
  std::vector<Figure> panels;
  for (StudyOutput const& output : found.outputs) {
    Statistics const s = statistics(found, output.head);
    std::printf(
        "%-26s %8.4g in the mean, %8.3g deviation, %8.4g to %8.4g; rank correlation with preload %5.2f, friction "
        "%5.2f\n",
        output.head.c_str(), s.mean, s.deviation, s.sorted.front(), s.sorted.back(),
        rank_correlation(found, "preload", output.head), rank_correlation(found, "friction factor", output.head));
    for (Column const& parameter : found.points.columns()) {
      Figure panel{.x_label = parameter.head(), .y_label = output.head};
      panel.title = output.head + " over " + parameter.name;
      panel.curves = curves_of(found, parameter.name, output.head);
      panel.curves.front().style = "points";
      panels.push_back(std::move(panel));
    }
  }
  write_panels(panels, 2, o.out / "ensemble", !o.no_plot);
}

void run(Options const& o, Ranks const& ranks) {
  Study const study({o.out / "vehicle.study", "M113, sprockets to " + number(o.speed) + " rad/s, " +
                                                  number(o.end_time) + " s in steps of " + number(o.step) + " s"},
                    latin_hypercube(std::size_t(o.samples), std::uint64_t(o.seed),
                                    {uniform("preload", "kN", 10.0, 40.0), uniform("friction factor", "", 0.5, 1.5)}),
                    outputs("largest pin force [kN]", "mean pin force [kN]", "way [m]"));
  StudyResults const found = run_over_ranks(ranks, study, [&](Point const& p) { return drive(o, p); },
                                            {.threads = o.threads, .retry_failed = o.retry});
  if (ranks.first()) report(o, found);
}

}  // namespace

int main(int argc, char** argv) {
  Ranks const ranks(argc, argv);
  Options o;
  CommandLine line{"Study of the tracked vehicle with random preload and friction."};
  line.between("--samples", &o.samples, 1, 100000, "number of vehicles");
  line.between("--seed", &o.seed, 0, 1e9, "seed of the Latin hypercube");
  line.positive("--until", &o.end_time, "end of the runs [s]");
  line.positive("--step", &o.step, "time step [s]");
  line.option("--speed", &o.speed, "speed of the sprockets after 0.7 of the run [rad/s]");
  line.between("--threads", &o.threads, 1, 4096, "number of threads that compute points");
  line.option("--out", &o.out, "folder of the record, the tables and the pictures");
  line.flag("--retry", &o.retry, "computes the failed points again");
  line.flag("--no-plot", &o.no_plot, "write data and scripts, but draw nothing");
  if (auto const code = line.parse(argc, argv)) return *code;
  try {
    run(o, ranks);
  } catch (Error const& e) {
    if (ranks.first()) std::cerr << e.what() << '\n';
    return 1;
  }
}
