// Work-precision map of a chain of rods on penalty pins, released from the horizontal: every combination of pin
// stiffness, step and integrator. The error is the distance between the end of the chain and the end of a chain with
// ideal pins and a fine step. The study can be interrupted and continued, on threads or on MPI ranks:
//   chain_study --threads 2 --out out/chain_study
//   mpirun -np 2 chain_study --out out/chain_study
#include <iostream>
#include <polybody/polybody.hpp>
#include <polybody/study.hpp>

#include "support/command_line.hpp"
#include "support/ranks.hpp"

using namespace polybody;
namespace fs = std::filesystem;

namespace {

struct Options {
  int links = 6, levels = 5, threads = 1;
  double end_time = 0.5;
  fs::path out = "out/chain_study";
  bool retry = false, no_plot = false;
};

// Position of the end of the chain after the run [m], and the processor time of the steps [s].
struct End {
  Vec3 place;
  double seconds;
};

template <class Policy, class Integrator>
End swing(Options const& o, Policy const& policy, Integrator const& integrator, double step) {
  using Pin = Joint<planar::Revolute, Policy>;
  double const length = 0.5, mass = 0.8;
  Model<Bodies<planar::Rigid>, Joints<Pin>> model{Gravity{0, -9.81, 0}};
  auto before =
      model.add(planar::Rigid{mass, mass * length * length / 12.0, Placement::planar(0.5 * length, 0.0)}, "rod 1");
  model.connect(Pin{{}, policy}, model.ground().at({0, 0, 0}), before.at(Vec2(-0.5 * length, 0.0)), "pin 1");
  for (int i = 1; i < o.links; ++i) {
    auto const rod =
        model.add(planar::Rigid{mass, mass * length * length / 12.0, Placement::planar((i + 0.5) * length, 0.0)},
                  "rod " + std::to_string(i + 1));
    model.connect(Pin{{}, policy}, before.at(Vec2(0.5 * length, 0.0)), rod.at(Vec2(-0.5 * length, 0.0)),
                  "pin " + std::to_string(i + 1));
    before = rod;
  }
  State x = model.reference_state();
  auto run = simulate(model, x, integrator, {.end_time = o.end_time, .step = step});
  double const begin = thread_seconds();
  run.run();
  return {position(model, x, before.at(Vec2(0.5 * length, 0.0))), thread_seconds() - begin};
}

std::array<double, 2> error_and_cost(Options const& o, Vec3 const& exact, Point const& p) {
  Penalty const pins{.stiffness = p["stiffness"], .damping = 0.02 * std::sqrt(p["stiffness"])};
  End const end = p.with(
      "integrator", [&](auto const& integrator) { return swing(o, pins, integrator, p["step"]); },
      GeneralisedAlpha{.rho_inf = 0.8}, EnergyMomentum{}, Radau{}, RungeKutta4<>{});
  return {(end.place - exact).norm(), end.seconds};
}

// Powers of ten below the least and above the greatest value, as limits of axes that all panels share.
std::array<double, 2> decades(std::vector<double> const& x) {
  auto const [least, most] = std::ranges::minmax(x);
  return {std::pow(10.0, std::floor(std::log10(least))), std::pow(10.0, std::floor(std::log10(most)) + 1.0)};
}

void draw(Options const& o, StudyResults const& found, char const* x, std::string const& name) {
  std::vector<Figure> panels;
  for (std::string const& integrator : found.points.columns()[0].choices) {
    StudyResults const part = where(found, [&](Point const& p) { return p.chosen("integrator") == integrator; });
    Figure panel{.title = integrator + ": " + std::to_string(part.failed()) + " of " + std::to_string(part.finished()) +
                          " runs fail",
                 .x_label = x,
                 .y_label = "error of the chain's end [m]",
                 .curves = curves_of(part, x, "error [m]", {"stiffness"}),
                 .log_x = true,
                 .log_y = true,
                 .x_range = decades(found.column(x)),
                 .y_range = decades(found.column("error [m]"))};
    if (!panel.curves.empty()) panels.push_back(std::move(panel));
  }
  write_panels(panels, 2, o.out / name, !o.no_plot);
}

void run(Options const& o, Ranks const& ranks) {
  std::size_t const n = std::size_t(o.levels);
  Study const study(
      {o.out / "chain.study", std::to_string(o.links) + " rods, " + number(o.end_time) + " s"},
      grid(formulations("integrator", {"GeneralisedAlpha", "EnergyMomentum", "Radau", "RungeKutta4"}),
           axis("stiffness", "N/m", logarithmic(1e5, 1e9, n)), axis("step", "s", logarithmic(1e-2, 1e-4, n))),
      outputs("error [m]", measured("cpu [s]")));
  Vec3 const exact = swing(o, Constraint{}, Radau{}, 1e-3).place;
  StudyResults const found = run_over_ranks(ranks, study, [&](Point const& p) { return error_and_cost(o, exact, p); },
                                            {.threads = o.threads, .retry_failed = o.retry});
  if (!ranks.first()) return;
  write_table(found, o.out / "chain.csv");
  std::cout << found.points.size() << " points, " << found.resumed << " of them from an earlier run, " << found.failed()
            << " failed\n";
  std::vector<double> const errors = found.column("error [m]");
  if (errors.empty()) return;
  draw(o, found, "cpu [s]", "work_precision");
  draw(o, found, "step [s]", "error_over_step");
  std::cout << "smallest error " << number(*std::ranges::min_element(errors)) << " m\n";
}

}  // namespace

int main(int argc, char** argv) {
  Ranks const ranks(argc, argv);
  Options o;
  CommandLine line{
      "Study of a chain: error of penalty pins for several stiffnesses, steps and integrators, compared with ideal "
      "pins."};
  line.between("--links", &o.links, 1, 100, "number of rods of the chain");
  line.between("--levels", &o.levels, 2, 9, "number of stiffnesses and of steps");
  line.positive("--until", &o.end_time, "end of the runs [s]");
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
