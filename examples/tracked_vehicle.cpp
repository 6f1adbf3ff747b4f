// The tracked vehicle of Chapter 3 (Figures 3.6 to 3.15, Table 3.4) with its tracks under five joint formulations.
//   tracked_vehicle --track penalty --until 3
//   tracked_vehicle --compare
//   tracked_vehicle --figure 3.11
//   tracked_vehicle --integrator adams --until 0.5

#include <map>

#include <polybody/compare/join.hpp>

#include "support/command_line.hpp"
#include "tracked_vehicle/pins.hpp"

using namespace chapter3;

namespace {

Runs run(Options const& o, std::vector<Pins> const& formulations) {
  Options stepped = o;
  if (o.step == 0.0) stepped.step = implicit_step;
  warn_of_drive(stepped);
  Runs all;
  std::vector<Comparison> apart;
  for (Pins const& pins : formulations) {
    if (o.left != o.right && !pins.cannot_turn.empty()) {
      if (formulations.size() == 1) throw InvalidInput(pins.cannot_turn);
      std::cout << pins.cannot_turn << '\n';
      continue;
    }
    Runs one = pins.run(o);
    apart.push_back(std::move(one.comparison));
    all.outcomes.insert(all.outcomes.end(), one.outcomes.begin(), one.outcomes.end());
    all.sampling = one.sampling;
  }
  all.comparison = join(apart);
  return all;
}

// Forces in the watched pin from 1 to 4 s, longitudinal and vertical, up to 30 Hz: how far those of `run` are off those
// of `first`, as root mean squares.
double force_difference(Runs const& first, std::size_t k, Runs const& runs, std::size_t run) {
  RmsDifference d(1.0, 4.0);
  for (char const* const output : {"joint force x [N]", "joint force z [N]"}) {
    Filtered const a = filtered(first, k, output, 30.0), b = filtered(runs, run, output, 30.0);
    d.add({b.times, b.values}, {a.times, a.values});
  }
  return d.value();
}

// The path of the watched link in the chassis against that of the first run: how far it is off at most, in the upper
// strand, which hangs between sprocket and idler, and elsewhere [m].
struct PathDistance {
  double taut = 0.0, slack = 0.0;
};
PathDistance path_distance(Runs const& runs, std::size_t run) {
  auto const path = [&](std::size_t k, std::size_t every) {
    auto const &x = runs.history(k, "link x in chassis [m]"), &z = runs.history(k, "link z in chassis [m]");
    std::vector<Vec2> points;
    for (std::size_t i = 0; i < x.size(); i += every) points.emplace_back(x[i], z[i]);
    return points;
  };
  std::vector<Vec2> const first = path(0, 1), other = path(run, 8);
  PathDistance worst;
  for (Vec2 const& p : other) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < first.size(); ++i) {
      Vec2 const along = first[i + 1] - first[i], to = p - first[i];
      double const share = std::clamp(to.dot(along) / std::max(along.squaredNorm(), 1e-20), 0.0, 1.0);
      nearest = std::min(nearest, (to - share * along).squaredNorm());
    }
    double const x = p[0] + m113::chassis.x, z = p[1] + m113::chassis.z;
    bool const hangs = z > m113::sprocket_z && x < 0.0 && x > m113::idler_start_x;
    double& most = hangs ? worst.slack : worst.taut;
    most = std::max(most, std::sqrt(nearest));
  }
  return worst;
}

void report(Options const& o, Runs const& runs) {
  write_report(runs.comparison, o.out / "comparison", !o.no_plot);
  std::cout << runs.comparison << '\n';
  double const first = runs.comparison.runs.front().cpu;
  for (std::size_t k = 0; k < runs.comparison.runs.size(); ++k) {
    auto const& r = runs.comparison.runs[k];
    Outcome const& out = runs.outcomes[k];
    auto const most = [&](std::string const& name) {
      double value = 0.0;
      for (double const x : runs.history(k, name)) value = std::max(value, std::abs(x));
      return value;
    };
    std::printf("%-14s %.2f s of CPU for %.2f s: %.2f of real time, %.2f of %s\n", r.name.c_str(), r.cpu,
                r.times.back(), r.cpu / r.times.back(), r.cpu / first, runs.comparison.runs.front().name.c_str());
    std::printf(
        "               deepest contact %.2f mm (%s, t = %.3f s); pins up to %.1f mm off the path of the start, links "
        "%.2f mm off their plane\n",
        1e3 * out.depth, out.deepest.c_str(), out.deepest_time, 1e3 * most("off the path [m]"),
        1e3 * most("off the middle plane [m]"));
    std::printf("               joints open by up to %.4f mm; first dip %.2f cm\n", 1e3 * most("largest joint gap [m]"),
                1e2 * most("vertical displacement [m]"));
    if (r.times.back() > 10.0)
      std::printf("               mean speed from 9 s on %.4f m/s; rolling without slip it is %.4f m/s\n",
                  mean_speed(runs, k), o.speed * m113::rolling_radius);
    if (k > 0 && r.times.back() >= 4.0 && runs.comparison.runs[0].times.back() >= 4.0)
      std::printf("               forces in pin %d, 30 Hz, 1 to 4 s: %.2f %% (rms) off those of %s\n", watched_pin,
                  1e2 * force_difference(runs, 0, runs, k), runs.comparison.runs.front().name.c_str());
    if (k > 0) {
      PathDistance const off = path_distance(runs, k);
      std::printf(
          "               path of a link in the chassis up to %.1f mm off that of %s, %.1f mm in the upper strand\n",
          1e3 * off.taut, runs.comparison.runs.front().name.c_str(), 1e3 * off.slack);
    }
    if (out.relative >= 0.0)
      std::printf(
          "               work of the drives %.1f kJ + gravity %.1f kJ = kinetic %.1f + stored %.1f + dissipated %.1f "
          "kJ, %.2f kJ (%.2f %%) left\n",
          1e-3 * out.drives, 1e-3 * out.gravity, 1e-3 * out.kinetic, 1e-3 * out.stored, 1e-3 * out.dissipated,
          1e-3 * out.unaccounted, 1e2 * out.relative);
    if (!out.trouble.empty()) std::printf("               %s\n", out.trouble.c_str());
  }
}

// Coordinates and constraints as the thesis counts them: the ground is a body, too, with four Euler parameters and a
// weld.
void table_3_4(Options const& o) {
  auto const count = [](char const* name, Census const& c, char const* thesis) {
    std::printf("  %-10s %6ld coordinates %5ld degrees of freedom %5ld constraints   (thesis: %s)\n", name,
                long(c.coordinates), long(c.degrees_of_freedom), long(c.constraints), thesis);
  };
  std::cout << "Table 3.4\n";
  count("pin joint", ideal_pins().count(o), "1092, 168, 924");
  count("penalty", penalty_pins(o.penalty).count(o), "1092, 798, 294");
  count("bushing", bushing_pins(o.penalty).count(o), "1092, 798, 294");
  count("ANCF", cable_pins().count(o), "1227, 1060, 167");
  std::cout << "  The thesis' 1227 ANCF coordinates are 29 bodies of 7 and 128 links of 8; the vehicle has 27 bodies "
               "beside the links and the ground,\n"
               "  which makes 28: 1220, 1054, 166. What the 29th is the text does not say.\n";
}

bool wanted(Options const& o, std::string const& figure) { return o.figure == "all" || o.figure == figure; }

void figures(Options const& o) {
  auto const name = [](std::string const& number) { return "figure_3_" + number; };
  if (wanted(o, "3.6")) {
    Figure f{
        .title = "Figure 3.6: sprocket angular velocity", .x_label = "t [s]", .y_label = "angular velocity [rad/s]"};
    Curve c;
    for (int i = 0; i <= 1000; ++i) {
      c.x.push_back(0.01 * i);
      c.y.push_back(m113::drive(o.speed, 0.1)(0.01 * i).value);
    }
    f.curves.push_back(c);
    draw(o, f, name("6"));
  }
  if (wanted(o, "3.7")) {
    Options bare = o;
    bare.suspension = false;
    Runs const with = run(o, {ideal_pins()}), without = run(bare, {ideal_pins()});
    Figure f{.title = "Figure 3.7: chassis vertical displacement", .x_label = "t [s]", .y_label = "displacement [m]"};
    f.curves.push_back(curve("with suspension", with.times(0), with.history(0, "vertical displacement [m]"), 0));
    f.curves.push_back(curve("without", without.times(0), without.history(0, "vertical displacement [m]"), 1));
    draw(o, f, name("7"));
    auto const dip = [](Runs const& r) {
      auto const& z = r.history(0, "vertical displacement [m]");
      return -*std::min_element(z.begin(), z.end());
    };
    std::printf("  first dip %.2f cm with suspension, %.2f cm without: ratio %.1f (thesis: 7 cm, 0.64 cm)\n",
                1e2 * dip(with), 1e2 * dip(without), dip(with) / dip(without));
  }
  if (wanted(o, "3.8") || wanted(o, "3.9") || wanted(o, "3.10") || o.compare) {
    Runs const all = run(o, {ideal_pins(), penalty_pins(m113::pin_stiffness), bushing_pins(o.penalty), cable_pins(),
                             joint_coordinates()});
    if (wanted(o, "3.8"))
      over_time(o, all, "forward position [m]", "Figure 3.8: chassis forward position", "position [m]", name("8"));
    if (wanted(o, "3.9"))
      over_time(o, all, "forward velocity [m/s]", "Figure 3.9: chassis forward velocity", "velocity [m/s]", name("9"));
    if (wanted(o, "3.10")) {
      Figure f{.title = "Figure 3.10: path of a link in the chassis",
               .x_label = "x [m]",
               .y_label = "z [m]",
               .equal_axes = true};
      for (std::size_t k = 0; k < all.comparison.runs.size(); ++k)
        f.curves.push_back(curve(all.comparison.runs[k].name, all.history(k, "link x in chassis [m]"),
                                 all.history(k, "link z in chassis [m]"), int(k)));
      draw(o, f, name("10"));
    }
    if (o.compare || o.figure == "all") report(o, all);
  }
  for (auto const& [k, longitudinal, vertical] : {std::tuple(1e9, "11", "12"), {1e7, "13", "14"}}) {
    if (!wanted(o, std::string("3.") + longitudinal) && !wanted(o, std::string("3.") + vertical)) continue;
    Runs const r = run(o, {ideal_pins(), penalty_pins(k), cable_pins()});
    for (auto const& [number, output, what] :
         {std::tuple(longitudinal, "joint force x [N]", "longitudinal"), {vertical, "joint force z [N]", "vertical"}}) {
      std::string const title = std::string("Figure 3.") + number;
      over_time(o, r, output, title + "a: joint " + what + " force", "force [kN]", name(std::string(number) + "a"), 0.0,
                1e-3);
      over_time(o, r, output, title + "b: joint " + what + " force, 30 Hz low pass", "force [kN]",
                name(std::string(number) + "b"), 30.0, 1e-3);
    }
  }
  if (wanted(o, "3.15")) {
    Runs const r = run(o, {penalty_pins(1e9), penalty_pins(1e7)});
    Figure f{.title = "Figure 3.15: joint constraint violation, penalty method",
             .x_label = "t [s]",
             .y_label = "gap [mm]",
             .log_y = true,
             .y_range = {{1e-4, 10.0}}};
    for (std::size_t k = 0; k < 2; ++k) {
      std::vector<double> gap = r.history(k, "joint gap [m]");
      for (double& g : gap) g = std::max(g, 1e-7);
      f.curves.push_back(curve(k == 0 ? "k = 1e9 N/m" : "k = 1e7 N/m", r.times(k), gap, int(k), 1e3));
    }
    draw(o, f, name("15"));
  }
}

void show(Options const& o, Runs const& r) {
  report(o, r);
  over_time(o, r, "vertical displacement [m]", "Chassis vertical displacement", "displacement [m]", "height");
  over_time(o, r, "forward velocity [m/s]", "Chassis forward velocity", "velocity [m/s]", "velocity");
  over_time(o, r, "joint force [N]", "Force in a pin, 30 Hz low pass", "force [kN]", "pin_force", 30.0, 1e-3);
  Figure f{.title = "Path of the chassis", .x_label = "x [m]", .y_label = "y [m]", .equal_axes = true};
  f.curves.push_back(curve("", r.history(0, "forward position [m]"), r.history(0, "sideways position [m]"), 0));
  draw(o, f, "path");
}

void single(Options const& o) {
  if (o.halve) {
    if (o.integrator == "adams" || o.integrator == "dormand-prince")
      throw InvalidInput("--halve needs an integrator of fixed steps; this one controls its step. Change --tolerance.");
    if (o.integrator == "rk" && o.step == 0.0)
      throw InvalidInput("--halve by rk needs a --step that the pins can bear, such as 1e-4 s.");
    Options half = o, whole = o;
    if (o.step == 0.0) whole.step = implicit_step;
    half.step = 0.5 * whole.step;
    Runs const coarse = run(whole, {ideal_pins()}), fine = run(half, {ideal_pins()});
    auto const x = [](Runs const& r) { return r.history(0, "forward position [m]").back(); };
    std::printf("steps of %g and %g ms: forward position %.4f and %.4f m, %.3f %% apart", 1e3 * whole.step,
                1e3 * half.step, x(coarse), x(fine), 1e2 * std::abs(x(fine) / x(coarse) - 1.0));
    if (o.until > 10.0) std::printf("; mean speed %.4f and %.4f m/s", mean_speed(coarse, 0), mean_speed(fine, 0));
    if (o.until >= 4.0)
      std::printf("; forces in pin %d, 30 Hz, 1 to 4 s, %.2f %% (rms)", watched_pin,
                  1e2 * force_difference(coarse, 0, fine, 0));
    std::printf("\n");
    return;
  }
  std::map<std::string, Pins> const formulations{{"constraint", ideal_pins()},
                                                 {"penalty", penalty_pins(o.penalty)},
                                                 {"bushing", bushing_pins(o.penalty)},
                                                 {"ancf", cable_pins()},
                                                 {"recursive", joint_coordinates()}};
  show(o, run(o, {formulations.at(o.track)}));
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  CommandLine line{"The tracked vehicle of Chapter 3 with its tracks under five joint formulations."};
  line.one_of("--track", &o.track, {"constraint", "penalty", "bushing", "ancf", "recursive"},
              "formulation of the pins");
  line.flag("--compare", &o.compare, "all formulations, with a report");
  line.option("--figure", &o.figure, "3.6 to 3.15 of the thesis, table (3.4), or all");
  line.positive("--until", &o.until, "end of the run [s]");
  line.one_of("--integrator", &o.integrator, {"alpha", "hht", "radau", "adams", "dormand-prince", "rk"},
              "alpha, hht, radau: implicit; adams, rk: explicit, by coordinate partitioning; dormand-prince: explicit, "
              "projected");
  line.positive("--step", &o.step,
                "[s], the longest of adams and dormand-prince; without it 0.5 ms, by rk what the pins can bear");
  line.positive("--tolerance", &o.tolerance,
                "of Newton's corrections (without it 1e-5), by adams and dormand-prince of a step's error (1e-6)");
  line.flag("--halve", &o.halve, "ideal pins at this step and at half of it");
  line.option("--speed", &o.speed, "of the sprockets after 8 s [rad/s]");
  line.one_of("--turn", &o.turn, {"pivot", "curve"},
              "pivot: the right track backwards; curve: the right one at 0.8 of the speed");
  line.flag("!--no-suspension", &o.suspension, "arms welded to the chassis");
  line.option("--preload", &o.preload, "of the tensioners [N]");
  line.positive("--penalty", &o.penalty, "stiffness of penalty pins and bushings [N/m]");
  line.between("--cut", &o.cut, 0, m113::links - 1, "pin at which the loop of ideal pins is cut");
  line.between("--rho", &o.rho, 0.0, 1.0, "spectral radius at infinity of the integrator");
  line.flag("--bumps", &o.bumps, "a course with three bumps");
  line.option("--animate", &o.animate, "writes a ParaView animation with a state every so many seconds");
  line.flag("--audit", &o.audit, "works out where the energy went");
  line.option("--out", &o.out, "folder of the results");
  line.flag("--no-plot", &o.no_plot, "data and scripts only");
  if (auto const code = line.parse(argc, argv)) return *code;
  if (o.turn == "pivot") o.right = -1.0;
  if (o.turn == "curve") o.right = 0.8;
  try {
    fs::create_directories(o.out);
    if (o.figure == "table" || o.figure == "all") table_3_4(o);
    if (!o.figure.empty() || o.compare)
      figures(o);
    else
      single(o);
  } catch (Error const& e) {
    std::cerr << e.what() << '\n';
    return 1;
  }
}
