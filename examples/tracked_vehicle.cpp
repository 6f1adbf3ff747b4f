// The tracked vehicle of Chapter 3 (Figures 3.6 to 3.15, Table 3.4) with its tracks under five joint formulations, and
// under every combination of links, pins and integrator.
//   tracked_vehicle --policy penalty --until 3
//   tracked_vehicle --compare
//   tracked_vehicle --compare cost                                                 # of the pins, at equal error
//   tracked_vehicle --figure 3.11
//   tracked_vehicle --body ffr --policy bushing --integrator adams --until 0.5     # --list: the combinations
//   tracked_vehicle --compare combinations --body rigid,lrvf --until 0.3           # at equal error
//   tracked_vehicle --figure 3.11 --viewer build/release/polybody_viewer.html

#include <map>
#include <tuple>

#include <polybody/polybody.hpp>

#include "support/vehicle_film.hpp"
#include "tracked_vehicle/cost.hpp"
#include "tracked_vehicle/measures.hpp"
#include "tracked_vehicle/pins.hpp"

using namespace chapter3;

namespace {

// Runs of one program call. Figures with the same settings share a run.
class RunsMade {
 public:
  // Returns the runs of `formulations` in this order.
  Runs operator()(Options const& o, std::vector<Pins> const& formulations) {
    Runs all;
    std::vector<Comparison> apart;
    for (Pins const& pins : formulations) {
      if (o.left != o.right && !pins.combination.links.turns && formulations.size() > 1) {
        std::cout << pins.name << " is omitted, because tracks of cables cannot turn.\n";
        continue;
      }
      require_turning(o, pins.combination.links);
      Runs const& one = made(o, pins);
      apart.push_back(one.comparison);
      all.outcomes.insert(all.outcomes.end(), one.outcomes.begin(), one.outcomes.end());
      all.sampling = one.sampling;
    }
    all.comparison = join(apart);
    return all;
  }

 private:
  // Key of a run within one call: pins, suspension, preload and step.
  using Key = std::tuple<std::string, bool, double, double>;
  Runs const& made(Options const& o, Pins const& pins) {
    Key const key{pins.name, o.suspension, o.preload, o.step};
    auto const found = made_.find(key);
    if (found != made_.end()) return found->second;
    Options mine = o;
    if (!filmed(o, pins)) mine.film = nullptr;
    return made_.emplace(key, pins.run(mine)).first->second;
  }

  // A film of several formulations shows only rigid links on ideal pins and cables.
  static bool filmed(Options const& o, Pins const& pins) {
    bool const alone = o.figure.empty() && o.compare.empty();
    return o.suspension && (alone || pins.name == "constraint" || pins.name == "ancf");
  }

  std::map<Key, Runs> made_;
};

void report(Options const& o, Runs const& runs, Lines& lines) {
  write_report(runs.comparison, o.out / "comparison", !o.no_plot);
  std::cout << runs.comparison << '\n';
  for (std::size_t k = 0; k < runs.comparison.runs.size(); ++k) run_lines(lines, o, runs, k);
}

// Coordinates and constraints in the count of the thesis: the ground is a body with four Euler parameters and a weld.
void table_3_4(Options const& o) {
  std::cout << "Table 3.4\n";
  Lines lines;
  auto const count = [&](char const* name, ProblemSize const& c, char const* thesis) {
    lines(std::string("Table 3.4, ") + name,
          {{"coordinates", double(c.coordinates), 0},
           {"degrees of freedom", double(c.degrees_of_freedom), 0},
           {"constraints", double(c.constraints), 0}},
          std::string("thesis: ") + thesis);
  };
  count("pin joint", ideal_pins(o).count(o), "1092, 168, 924");
  count("penalty", penalty_pins(o, o.spring_pins).count(o), "1092, 798, 294");
  count("bushing", bushing_pins(o).count(o), "1092, 798, 294");
  count("ANCF", cable_pins(o).count(o), "1227, 1060, 167");
  std::cout
      << "  The 1227 ANCF coordinates of the thesis are those of 29 bodies with 7 and 128 links with 8. This vehicle "
         "has 28 such bodies,\n"
         "  including the ground: 1220, 1054, 166. The thesis does not name the 29th body.\n";
}

// Makes the first curve the widest and the last the narrowest, so that curves that agree are all visible.
Figure nested(Figure f) {
  double width = 1.0;
  for (auto curve = f.curves.rbegin(); curve != f.curves.rend(); ++curve, width += 1.0) curve->width = width;
  return f;
}

// Draws the selected figures of the chapter and prints their numbers.
class Figures {
 public:
  explicit Figures(Options const& o) : o_(o) {}

  void draw_all() {
    if (wanted("3.6")) drive();
    if (wanted("3.7")) drop();
    if (wanted("3.8") || wanted("3.9") || wanted("3.10") || !o_.compare.empty()) formulations();
    if (wanted("3.11") || wanted("3.12")) forces(m113::pin_stiffness, "11", "12");
    if (wanted("3.13") || wanted("3.14")) forces(m113::soft_pin_stiffness, "13", "14");
    if (wanted("3.11") || wanted("3.12") || wanted("3.13") || wanted("3.14"))
      for (auto* const pins : {ideal_pins, cable_pins}) force_spread(pins);
    if (wanted("3.15")) gaps();
  }

 private:
  bool wanted(std::string const& figure) const { return o_.figure == "all" || o_.figure == figure; }
  static std::string name(std::string const& number) { return "figure_3_" + number; }

  void drive() const {
    Figure f{
        .title = "Figure 3.6: sprocket angular velocity", .x_label = "t [s]", .y_label = "angular velocity [rad/s]"};
    Curve c;
    for (int i = 0; i <= 1000; ++i) {
      c.x.push_back(0.01 * i);
      c.y.push_back(m113::drive(o_.speed, 0.1)(0.01 * i).value);
    }
    f.curves.push_back(c);
    draw(o_, f, name("6"));
  }

  void drop() {
    Options bare = o_;
    bare.suspension = false;
    Runs const with = runs_(o_, {ideal_pins(o_)}), without = runs_(bare, {ideal_pins(o_)});
    Figure f{.title = "Figure 3.7: chassis vertical displacement", .x_label = "t [s]", .y_label = "displacement [m]"};
    f.curves.push_back(curve("with suspension", with.times(0), with.history(0, "vertical displacement [m]"), 0));
    f.curves.push_back(
        curve("without suspension", without.times(0), without.history(0, "vertical displacement [m]"), 1));
    draw(o_, f, name("7"));
    drop_line(lines_, name_of(with, 0), with, 0);
    drop_line(lines_, "no suspension", without, 0);
    lines_("drops", {{"ratio", first_second(with, 0).least / first_second(without, 0).least, 1}});
  }

  // Positions, speeds and paths of all formulations.
  void formulations() {
    Runs const all = runs_(o_, {ideal_pins(o_), penalty_pins(o_, m113::pin_stiffness), bushing_pins(o_), cable_pins(o_),
                                joint_coordinate_pins(o_)});
    std::size_t const count = all.comparison.runs.size();
    if (wanted("3.8"))
      over_time(all, "forward position [m]", "Figure 3.8: chassis forward position", "position [m]", "8");
    if (wanted("3.9"))
      over_time(all, "forward velocity [m/s]", "Figure 3.9: chassis forward velocity", "velocity [m/s]", "9");
    if (wanted("3.8") || wanted("3.9"))
      for (std::size_t k = 0; k < count; ++k) motion_line(lines_, o_, all, k);
    if (wanted("3.10")) paths(all);
    if (!o_.compare.empty() || o_.figure == "all") report(o_, all, lines_);
  }

  void over_time(Runs const& r, std::string const& output, std::string const& title, std::string const& label,
                 std::string const& number, double cut_off = 0.0) const {
    double const scale = output.find("force") == std::string::npos ? 1.0 : 1e-3;
    draw(o_, nested(history_figure(r, output, title, label, cut_off, scale)), name(number));
  }

  void paths(Runs const& all) {
    Figure f{.title = "Figure 3.10: path of a link in the chassis",
             .x_label = "x [m]",
             .y_label = "z [m]",
             .equal_axes = true,
             .height_px = 400};
    std::vector<int> const colours = formulation_colours(all.comparison);
    for (std::size_t k = 0; k < all.comparison.runs.size(); ++k)
      f.curves.push_back(curve(name_of(all, k), all.history(k, "link x in chassis [m]"),
                               all.history(k, "link z in chassis [m]"), colours[k]));
    draw(o_, nested(f), name("10"));
    for (std::size_t k = 1; k < all.comparison.runs.size(); ++k) path_line(lines_, all, k);
  }

  // Forces in the watched pin, unfiltered (a) and filtered (b), with penalties of this `stiffness` [N/m].
  void forces(double stiffness, std::string const& longitudinal, std::string const& vertical) {
    Runs const r = runs_(o_, {ideal_pins(o_), penalty_pins(o_, stiffness), cable_pins(o_)});
    for (auto const& [number, output, what] :
         {std::tuple(longitudinal, "joint force x [N]", "longitudinal"), {vertical, "joint force z [N]", "vertical"}}) {
      if (!wanted("3." + number)) continue;
      std::string const title = "Figure 3." + number;
      over_time(r, output, title + "a: joint " + what + " force", "force [kN]", number + "a");
      over_time(r, output, title + "b: joint " + what + " force, 30 Hz low pass", "force [kN]", number + "b",
                force_cut_off);
    }
    for (std::size_t k = 0; k < r.comparison.runs.size(); ++k) force_line(lines_, r, k);
  }

  // Difference of the forces in two runs with the same pins, the second with a preload that differs in the last place.
  void force_spread(Pins (*pins_of)(Options const&)) {
    if (o_.end_time < 4.0) return;
    Options perturbed = o_;
    perturbed.film = nullptr;
    perturbed.animate = 0.0;
    perturbed.preload = std::nextafter(o_.preload, std::numeric_limits<double>::infinity());
    Pins const pins = pins_of(o_);
    Runs const first = runs_(o_, {pins}), second = runs_(perturbed, {pins_of(perturbed)});
    if (first.times(0).back() >= 4.0)
      lines_("30 Hz force, " + pins.name + " perturbed", force_differences(first, 0, second, 0));
  }

  void gaps() {
    Runs const r = runs_(o_, {penalty_pins(o_, m113::pin_stiffness), penalty_pins(o_, m113::soft_pin_stiffness)});
    Figure f{.title = "Figure 3.15: joint constraint violation, penalty method",
             .x_label = "t [s]",
             .y_label = "gap [mm]",
             .log_y = true,
             .y_range = {{1e-4, 10.0}}};
    for (std::size_t k = 0; k < 2; ++k) {
      std::vector<double> gap = r.history(k, "joint gap [m]");
      for (double& g : gap) g = std::max(g, 1e-7);
      f.curves.push_back(curve(k == 0 ? "k = 1e9 N/m" : "k = 1e7 N/m", r.times(k), gap, int(k), 1e3));
      gap_line(lines_, r, k);
    }
    draw(o_, f, name("15"));
  }

  Options const& o_;
  RunsMade runs_;
  Lines lines_;
};

void show(Options const& o, Runs const& r) {
  Lines lines;
  report(o, r, lines);
  over_time(o, r, "vertical displacement [m]", "Chassis vertical displacement", "displacement [m]", "height");
  over_time(o, r, "forward velocity [m/s]", "Chassis forward velocity", "velocity [m/s]", "velocity");
  over_time(o, r, "joint force [N]", "Force in a pin, 30 Hz low pass", "force [kN]", "pin_force", 30.0, 1e-3);
  Figure f{.title = "Path of the chassis", .x_label = "x [m]", .y_label = "y [m]", .equal_axes = true};
  f.curves.push_back(curve("", r.history(0, "forward position [m]"), r.history(0, "sideways position [m]"), 0));
  draw(o, f, "path");
}

void halve(Options const& o) {
  Pins const pins = ideal_pins(o);
  if (has_step_control(pins.combination))
    throw InvalidInput(
        "--halve needs an integrator of fixed steps, but this one controls its step. Change --tolerance instead.");
  if (integrator_name(pins.combination) == "runge-kutta" && o.default_step)
    throw InvalidInput(
        "--halve with --integrator runge-kutta needs a --step at which the pins are stable, such as 1e-4 s.");
  Options half = o;
  half.step = 0.5 * o.step;
  RunsMade runs;
  Runs const coarse = runs(o, {pins}), fine = runs(half, {pins});
  auto const x = [](Runs const& r) { return r.history(0, "forward position [m]").back(); };
  std::vector<Value> numbers{{"step", 1e3 * o.step, 3, "ms"},
                             {"half", 1e3 * half.step, 3, "ms"},
                             {"forward", x(coarse), 4, "m"},
                             {"apart", 1e3 * std::abs(x(fine) - x(coarse)), 3, "mm"}};
  if (o.end_time > 10.0)
    numbers.push_back({"speed apart", 1e3 * (std::abs(mean_speed(fine, 0) - mean_speed(coarse, 0))), 2, "mm/s"});
  if (o.end_time >= 4.0) numbers.push_back({"30 Hz forces apart", 1e2 * force_difference(coarse, 0, fine, 0), 2, "%"});
  Lines{}("halved", numbers);
}

// Throws InvalidInput for options that the selected runs do not have.
void check(Options const& o) {
  bool const selects = !o.selection.bodies.empty() || !o.selection.policies.empty();
  if (selects && (!o.figure.empty() || o.compare == "pins" || o.halve))
    throw InvalidInput(
        "--figure, --compare pins and --halve have their own links and pins. Omit --body and --policy, or use single "
        "runs or --compare combinations.");
}

// `step` and `until` are zero if the command line does not give them.
void add_options(CommandLine& line, Options& o, double& step, double& until) {
  add_combination_options(
      line, o,
      {.body = "body formulation of the links, or a list such as rigid,ffr (default: rigid)",
       .policy = "policy of the pins, or a list (default: ancf-linear for cables and beams of ANCF, else constraint)",
       .steps = ", or for cost 4e-3,2e-3,1e-3,5e-4,2.5e-4",
       .tolerances = ", or for cost 1e-3,1e-4,1e-5",
       .errors = ", or for cost 1e-2,1e-3,1e-4"});
  line.one_of(
      "--compare", &o.compare, {"pins", "combinations", "steps", "cost"},
      "pins: five formulations of the thesis and of joint coordinates, with a report; combinations: the selected "
      "ones at equal error; steps: ten steps of every combination; cost: cost of the pins at equal error of the 30 Hz "
      "force",
      "pins");
  line.one_of("--figure", &o.figure,
              {"3.6", "3.7", "3.8", "3.9", "3.10", "3.11", "3.12", "3.13", "3.14", "3.15", "table", "all"},
              "figure of the thesis with its numbers, Table 3.4, or all");
  line.positive("--until", &until, "end of the run [s]; if omitted, 10, or 1.5 for --compare cost");
  line.positive(
      "--step", &step,
      "step [s], for adams and dormand-prince the longest step; if omitted, 0.5 ms, or for runge-kutta a step "
      "at which the pins are stable");
  line.flag("--halve", &o.halve, "compares ideal pins at this step and at half of this step");
  line.option("--speed", &o.speed, "speed of the sprockets after 8 s [rad/s]");
  line.one_of("--turn", &o.turn, {"pivot", "curve"},
              "pivot: the right track runs backwards; curve: the right track runs at 0.8 of the speed");
  line.flag("!--no-suspension", &o.suspension, "arms welded to the chassis");
  line.option("--preload", &o.preload, "preload of the tensioners [N]");
  line.positive("--penalty", &o.spring_pins, "stiffness of penalty pins and bushings [N/m]");
  line.positive("--penalties", &o.penalties, "stiffnesses of penalty pins of --compare cost [N/m]");
  line.flag("--shared-contacts", &o.shared_contacts,
            "stiffness and damping of Table 3.2 belong to all contact points of a link on one body, not to each point");
  line.between("--cut", &o.cut, 0, m113::links - 1, "pin at which the loop of ideal pins is cut");
  line.between("--rho", &o.rho, 0.0, 1.0, "spectral radius at infinity of the integrator");
  line.flag("--bumps", &o.bumps, "ground with three bumps");
  line.option("--animate", &o.animate, "writes a ParaView animation with a state at this interval [s]");
  line.option("--viewer", &o.viewer, "viewer of films: polybody_viewer.html, which the CMake target 'viewer' builds");
  line.option(
      "--film", &o.film_file,
      "file for a film of the run, or of rigid links and cables; default with --viewer: film.html in the folder --out");
  line.flag("--audit", &o.audit, "prints the energy balance");
  line.option("--out", &o.out, "folder of the results");
  line.flag("--no-plot", &o.no_plot, "write data and scripts, but draw nothing");
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  CommandLine line{
      "The tracked vehicle of Chapter 3: its figures, and runs of every combination of links, pins and integrator."};
  double step = 0.0, until = 0.0;
  add_options(line, o, step, until);
  if (auto const code = line.parse(argc, argv)) return *code;
  if (o.compare == "cost") o.end_time = 1.5;
  if (until > 0.0) o.end_time = until;
  if (o.turn == "pivot") o.right = -1.0;
  if (o.turn == "curve") o.right = 0.8;
  try {
    complete(o, step);
    check(o);
    if (is_of_combinations(o, o.compare)) return run_combinations(o, o.compare) ? 0 : 1;
    if (o.compare == "cost") {
      fs::create_directories(o.out);
      report(o, cost_study(o));
      return 0;
    }
    if (!o.viewer.empty() && o.film_file.empty()) o.film_file = o.out / "film.html";
    if (!o.film_file.empty()) o.film = vehicle_film(o.viewer, "The tracked vehicle M113 of the thesis");
    fs::create_directories(o.out);
    warn_of_drive(o);
    if (o.figure == "table" || o.figure == "all") table_3_4(o);
    if (!o.figure.empty() || !o.compare.empty())
      Figures(o).draw_all();
    else if (o.halve)
      halve(o);
    else
      show(o, RunsMade{}(o, selected_pins(o)));
    if (o.film && o.film->scenes() > 0) o.film->write(o.film_file);
  } catch (Error const& e) {
    std::cerr << e.what() << '\n';
    return 1;
  }
}
