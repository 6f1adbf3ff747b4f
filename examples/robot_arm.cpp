// The flexible robot arm of Chapter 2 (Figures 2.4 to 2.8) under several formulations, side by side.
//   robot_arm --case all --out out/robot_arm
//   robot_arm --case figures --body se3                               # Figures 2.5 to 2.8 with another body
//   robot_arm --case compare --body lrvf,ancf --error 1e-2,1e-3       # at equal error
//   robot_arm --case run --body ffr-modal --integrator hht,radau      # --list: the combinations
//   robot_arm --case equal-mesh --viewer build/release/polybody_viewer.html --film arm.html

#include "chapter2_energy.hpp"
#include "chapter2_film.hpp"
#include "chapter2_formulations.hpp"
#include "chapter2_meshes.hpp"
#include "chapter2_plots.hpp"
#include "support/command_line.hpp"

using namespace chapter2;
namespace fs = std::filesystem;

namespace {

struct Options : FormulationOptions {
  std::string body;  // of the figures
  double density = 7850.0;
  double slow_ramp = 10.0;
  double end_time = 0.0;
  double window = 20.0;
  double stiffer = 1.0;
  fs::path out = "out/robot_arm";
  fs::path viewer, film;
  bool no_plot = false;
};

// Prescribed rotation of the arm, with a snapshot every second.
struct Case {
  std::string name, title, file;
  Stiffness stiffness;
  double ramp;
  double axial_force = 0.0;
};

std::vector<Case> cases(Options const& o) {
  auto const scaled = [&](Stiffness s) {
    s.EA *= o.stiffer;
    s.GA *= o.stiffer;
    return s;
  };
  return {{"high", "Figure 2.5: high stiffness", "figure_2_5_high", scaled(high), o.slow_ramp},
          {"medium", "Figure 2.6: medium stiffness", "figure_2_6_medium", scaled(medium), o.slow_ramp},
          {"fast-medium", "Figure 2.7: fast, stiffness of Figure 2.6 (by the text)", "figure_2_7_fast_medium",
           scaled(medium), 4.5},
          {"fast-low", "Figure 2.7: fast, low stiffness (by the caption)", "figure_2_7_fast_low", scaled(low), 4.5},
          {"axial", "Figure 2.8: low stiffness, 100 kN along the tip", "figure_2_8_axial", scaled(low), 4.5, 100e3}};
}

void figure_2_4(Options const& o) {
  Figure f{.title = "Figure 2.4: prescribed angle of the pin", .x_label = "t [s]", .y_label = "angle [rad]"};
  int colour = 0;
  for (double ramp : {o.slow_ramp, 4.5}) {
    Ramp const law{.target = angle, .duration = ramp};
    Curve c{.label = colour == 0 ? "slow (Figures 2.5, 2.6)" : "fast (Figures 2.7, 2.8)", .colour = colour};
    for (double t : {0.0, ramp, o.slow_ramp * 1.2}) {
      c.x.push_back(t);
      c.y.push_back(law(t).value);
    }
    f.curves.push_back(c);
    ++colour;
  }
  draw(f, o.out / "figure_2_4_angle", !o.no_plot);
}

// Observer of the two meshes of a beam during a run.
template <class B>
struct MeshWatch {
  Case const& of;
  double widest = 0.0, longest = 0.0, implied = 0.0;  // [m]
  double interpolation = 0.0;                         // of all nodes of all snapshots [m]
  std::vector<std::vector<double>> points = {};

  template <class M>
  void see(RobotArm<B> const& arm, M const& now, std::vector<double>& row) {
    MeshDiagnostics const d = mesh_diagnostics(arm.arm.body(), coordinates_of(arm.model, now, arm.arm));
    row.insert(row.end(), {d.largest_gap, d.position_length, d.rotation_length});
    widest = std::max(widest, d.largest_gap);
    longest = std::max(longest, d.position_length);
    implied = d.rotation_length;
  }
  void snapshot(RobotArm<B> const& arm, State const& now) {
    Apart const a = meshes_apart(arm.arm.body(), coordinates_of(arm.model, now, arm.arm));
    meshes_row(of.name, now.t, a);
    interpolation = std::max(interpolation, a.interpolation_of_all);
    add_points(points, now.t, arm.model, now, arm.arm);
  }
  void tell(fs::path const& table) const {
    say(of.name, "largest gap", widest, "m");
    say(of.name, "gap in lengths", 100.0 * widest / length, "%");
    say(of.name, "largest interpolation part", interpolation, "m");
    say(of.name, "longest position mesh", longest, "m");
    say(of.name, "rotation mesh", implied, "m");
    if (of.axial_force != 0.0) say(of.name, "static position mesh", static_length(), "m");
    write_table(table,
                {"t [s]", "s [m]", "x, positions [m]", "y, positions [m]", "x, rotations [m]", "y, rotations [m]"},
                points);
  }
  // Length of the position mesh in static equilibrium under the axial force [m].
  double static_length() const {
    RobotArm<B> arm(bar(of.stiffness, 1.0), 10, of.ramp, of.axial_force);
    State x = arm.model.reference_state();
    equilibrium(arm.model, x, {});
    return mesh_diagnostics(arm.arm.body(), coordinates_of(arm.model, x, arm.arm)).position_length;
  }
};
template <class B>
void run_case(Options const& o, Case const& c) {
  RobotArm<B> arm(bar(c.stiffness, o.density), o.elements, c.ramp, c.axial_force);
  State x = arm.model.reference_state();
  double const end_time = o.end_time > 0.0 ? o.end_time : c.ramp;
  Figure snapshots{
      .title = c.title + '\n' + stiffness_text(c.stiffness) + ", " + std::to_string(o.elements) + " elements",
      .x_label = "x [m]",
      .y_label = "y [m]",
      .equal_axes = true};
  std::vector<std::string> heads{"t [s]", "tip x [m]", "tip y [m]", "kinetic energy [J]", "strain energy [J]"};
  bool constexpr two_meshes = HasTwoMeshes<B>;
  if (two_meshes)
    heads.insert(heads.end(), {"node gap [m]", "length of the position mesh [m]", "length of the rotation mesh [m]"});
  std::vector<std::vector<double>> columns(heads.size());
  MeshWatch<B> watch{.of = c};
  double next_checkpoint = 0.0;
  if (two_meshes) meshes_head();
  Progress progress(0.0, end_time, c.name);
  for (auto const& now :
       simulate(arm.model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = end_time, .step = o.step})) {
    Vec3 const tip = now.position(arm.arm.at(length));
    Energy const e = now.energy();
    std::vector<double> row{now.t, tip[0], tip[1], e.kinetic, e.strain};
    if constexpr (two_meshes) watch.see(arm, now, row);
    for (std::size_t i = 0; i < row.size(); ++i) columns[i].push_back(row[i]);
    if (now.t >= next_checkpoint - 1e-9) {
      add_snapshot(snapshots, arm.model, now, arm.arm, length);
      if constexpr (two_meshes) watch.snapshot(arm, now);
      next_checkpoint += 1.0;
    }
    progress.update(now.t);
  }
  progress.finish();
  std::string const stem = o.body == "lrvf" ? c.file : c.file + "_" + o.body;
  write_table(o.out / (stem + ".csv"), heads, columns);
  fit(snapshots);
  draw(snapshots, o.out / stem, !o.no_plot);
  if constexpr (two_meshes) watch.tell(o.out / (stem + "_meshes.csv"));
}

// Case for `compare`: the arm in one formulation.
struct ArmCase {
  Options const& o;
  Stiffness stiffness;
  double ramp;
  std::shared_ptr<Film> film = nullptr;

  template <class F>
  auto operator()(F const& f) const {
    using Arm = RobotArm<typename F::BodyType, typename F::PolicyType>;
    Arm arm(bar(stiffness, o.density), o.elements, ramp, 0.0, f.policy);
    State const start = arm.model.reference_state();
    auto const tip = arm.arm.at(length);
    using M = typename Arm::Model;
    std::vector<Output<M>> outputs;
    outputs.push_back({"tip x [m]", [tip](M const& m, State const& x) { return position(m, x, tip)[0]; }});
    outputs.push_back({"tip y [m]", [tip](M const& m, State const& x) { return position(m, x, tip)[1]; }});
    outputs.push_back({"lag of the tip [m]",
                       [tip, this](M const& m, State const& x) { return lag_of(x.t, position(m, x, tip), ramp); }});
    std::function<void(M const&, State const&)> observer;
    if (film) observer = BarFilm<M, typename F::BodyType>(scene_of(*film, f), arm.arm, solid_bar(stiffness, o.density));
    return Scenario<M>{std::move(arm.model),
                       start,
                       {.end_time = o.end_time > 0.0 ? o.end_time : 1.5 * ramp, .step = o.step},
                       std::move(outputs),
                       observer};
  }
};

std::shared_ptr<Film> film_of(Options const& o) {
  if (o.film.empty()) return nullptr;
  return std::make_shared<Film>(film_options(o.viewer, "The robot arm of medium stiffness, 1.5 rad in 4.5 s"));
}

// Kinetic energy of all runs, with a text at the largest loss of a run when the speed of the drive jumps to zero.
void draw_jump(Options const& o, Comparison const& c, double ramp) {
  Figure f{.title = "Kinetic energy of the arm, medium stiffness, 1.5 rad in 4.5 s",
           .x_label = "t [s]",
           .y_label = "energy [J]"};
  double largest = 0.0;
  std::vector<int> const colours = formulation_colours(c);
  for (std::size_t i = 0; i < c.runs.size(); ++i) {
    ComparedRun const& run = c.runs[i];
    Curve curve{.x = run.times, .label = run.name, .style = i == 0 ? "lines" : "dashed", .colour = colours[i]};
    for (std::size_t k = 0; k < run.energies.size(); ++k) {
      curve.y.push_back(run.energies[k].kinetic);
      double const loss = k > 0 ? curve.y[k - 1] - curve.y[k] : 0.0;
      if (loss <= largest || std::abs(run.times[k] - ramp) > 1.5 * o.step) continue;
      largest = loss;
      f.texts = {{ramp, 0.5 * loss,
                  "The speed of the drive\njumps to zero, and the\n" + run.name + " arm loses " +
                      number(std::round(1e-3 * loss)) + " kJ."}};
    }
    f.curves.push_back(std::move(curve));
  }
  draw(f, o.out / "kinetic_energy", !o.no_plot);
}

void equal_meshes(Options const& o) {
  GeneralisedAlpha const implicit{.rho_inf = 0.8};
  Penalty const stiff{.stiffness = 1e9, .damping = 1e5};
  std::shared_ptr<Film> const film = film_of(o);
  Comparison const c = require_complete(compare(
      ArmCase{o, medium, 4.5, film}, Formulation<planar::Lrvf, Constraint, GeneralisedAlpha>{"LRVF", {}, implicit},
      Formulation<planar::Lrvf, Penalty, GeneralisedAlpha>{"LRVF, penalty", stiff, implicit},
      Formulation<planar::AncfCable<GreenStrain>, Constraint, GeneralisedAlpha>{"ANCF Green", {}, implicit},
      Formulation<planar::AncfCable<EngineeringStrain>, Constraint, GeneralisedAlpha>{"ANCF engin.", {}, implicit},
      Formulation<planar::Rigid, Constraint, GeneralisedAlpha>{"rigid", {}, implicit}));
  std::cout << "\nThe arm of medium stiffness, 1.5 rad in 4.5 s, under five formulations:\n\n";
  report(c, o.out / "comparison", !o.no_plot);
  draw_jump(o, c, 4.5);
  if (film) film->write(o.film);
}

// Energy drift of one formulation with one integrator after the drive has stopped.
template <class B, class I>
void drift(Options const& o, Figure& figure, std::string const& name, I const& integrator, double step) {
  EnergyDrift const d =
      energy_drift<B>({.density = o.density, .window = o.window, .step = step}, o.elements, integrator);
  std::printf("  energy %-14s %-16s %8.3f %12.1f %12.2e %12.2e\n", name.c_str(), I::name, 1e3 * step, d.start,
              d.largest, d.end);
  if (std::is_same_v<I, GeneralisedAlpha> && step < o.step) return;
  Curve c{.label = name + ", " + I::name, .colour = int(figure.curves.size())};
  if constexpr (std::is_same_v<I, EnergyMomentum>) c.style = "dashed";
  c.x = d.t;
  for (double off : d.off) c.y.push_back(1e6 * off);
  figure.curves.push_back(c);
}

template <class B>
void drifts(Options const& o, Figure& figure, char const* name) {
  for (double part : {1.0, 0.5, 0.25}) drift<B>(o, figure, name, GeneralisedAlpha{.rho_inf = 0.8}, part * o.step);
  drift<B>(o, figure, name, EnergyMomentum{}, o.step);
}

void energies(Options const& o) {
  std::printf("\nThe arm of medium stiffness, total energy from the end of the ramp (4.5 s) for %g s:\n\n", o.window);
  std::printf("  %-21s %-16s %8s %12s %12s %12s\n", "energy", "integrator", "h [ms]", "E0 [J]", "largest",
              "at the end");
  Figure figure{.title = "Relative change of the energy of the arm after its drive has stopped",
                .x_label = "t [s]",
                .y_label = "E/E0 - 1 [1e-6]"};
  drifts<planar::Lrvf>(o, figure, "LRVF");
  drifts<planar::AncfCable<GreenStrain>>(o, figure, "ANCF Green");
  drifts<planar::AncfCable<EngineeringStrain>>(o, figure, "ANCF engin.");
  draw(figure, o.out / "energy_drift", !o.no_plot);
}

template <class B>
void run_cases(Options const& o) {
  for (Case const& c : cases(o))
    if (o.which == "all" || o.which == "figures" || o.which == c.name) run_case<B>(o, c);
}

// Largest distance of a node between the two meshes during the ramp, for densities and ramps that the thesis does not
// give.
void bands(Options const& o) {
  std::printf("\nLargest distance of a node between the meshes, by density and duration of the ramp:\n\n");
  for (double const density : {1000.0, 2700.0, 7850.0})
    for (double const ramp : {4.5, 6.0, 10.0, 15.0})
      for (Stiffness const& s : {high, medium, low}) {
        RobotArm<planar::Lrvf> arm(bar(s, density), o.elements, ramp);
        State x = arm.model.reference_state();
        double gap = 0.0;
        for (auto const& now :
             simulate(arm.model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = ramp, .step = o.step}))
          gap = std::max(gap, mesh_diagnostics(arm.arm.body(), coordinates_of(arm.model, now, arm.arm)).largest_gap);
        say("density " + number(density) + " and ramp " + number(ramp), s.name.c_str(), gap, "m");
      }
}

// The arm of a bar, for EqualErrorStudy.
struct StudiedArm {
  Problem const& problem;
  Bar spec;

  template <class F>
  auto operator()(F const& f) const {
    using Arm = RobotArm<typename F::BodyType, typename F::PolicyType>;
    Arm arm(f.body(spec), problem.setup.ramp, 0.0, f.policy);
    State const start = arm.model.reference_state();
    auto const tip = arm.arm.at(length);
    using M = typename Arm::Model;
    auto const lag = [tip, value = problem.output_value](M const& m, State const& x) {
      return value(x.t, position(m, x, tip));
    };
    return Scenario<M>{std::move(arm.model),
                       start,
                       {.end_time = problem.end_time, .step = 1e-3 * problem.end_time, .max_step_halvings = 6},
                       {{problem.output, lag}}};
  }
};

// Converged differences between the beam with shear and rotary inertia and the cable with Green strain, in four parts:
// rotary inertia, shear, formulation of the same equations, strain measure. Returns false if every run fails.
bool split(Options const& o, Problem const& problem) {
  EqualErrorStudy study({.elements = o.meshes, .steps = o.steps, .errors = {1e-1}, .repeats = 1});
  Bar const whole = bar(problem.setup.stiffness, problem.setup.density);
  Bar slender = whole;
  slender.constants->rotary_inertia = 1e-6 * whole.constants->rotary_inertia;
  Bar unsheared = slender;
  unsheared.constants->GA = 1e3 * whole.constants->GA;
  using Rotations = Formulation<planar::Lrvf, Constraint, GeneralisedAlpha>;
  GeneralisedAlpha const implicit{.rho_inf = 0.8};
  study.add(StudiedArm{problem, whole}, Rotations{"LRVF", {}, implicit}, {.model = "LRVF"});
  study.add(StudiedArm{problem, slender}, Rotations{"without rotary inertia", {}, implicit},
            {.model = "LRVF without rotary inertia"});
  study.add(StudiedArm{problem, unsheared}, Rotations{"without shear", {}, implicit},
            {.model = "LRVF without rotary inertia and shear"});
  study.add(
      StudiedArm{problem, whole},
      Formulation<planar::AncfCable<EngineeringStrain>, Constraint, GeneralisedAlpha>{"engineering", {}, implicit},
      {.model = "cable of engineering strain"});
  study.add(StudiedArm{problem, whole},
            Formulation<planar::AncfCable<GreenStrain>, Constraint, GeneralisedAlpha>{"Green", {}, implicit},
            {.model = "cable of Green strain"});
  std::cout << problem.title() << ", 0 to " << number(problem.end_time) << " s.\n";
  return combinations::print_report(study.run());
}

Problem problem_of(Options const& o) {
  double const ramp = 4.5;
  return {.mechanism = Mechanism::arm,
          .motion = "arm driven by 1.5 rad in 4.5 s",
          .setup = {.stiffness = o.chosen_stiffness(), .density = o.density, .ramp = ramp},
          .end_time = o.end_time > 0.0 ? o.end_time : 1.5 * ramp,
          .output = "lag of the tip [m]",
          .output_value = [ramp](double t, Vec3 const& tip) { return lag_of(t, tip, ramp); }};
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  o.stiffness = medium.name;
  CommandLine line{
      "The flexible robot arm of Chapter 2: Figures 2.4 to 2.8, and the same arm under several formulations"};
  add_formulation_options(line, o,
                          {"angle", "figures", "high", "medium", "fast-medium", "fast-low", "axial", "equal-mesh",
                           "energy", "bands", "split"});
  line.not_negative(
      "--until", &o.end_time,
      "end of the run [s]; 0: the end of the ramp, or 1.5 times the ramp with run, compare and equal-mesh");
  line.positive("--density", &o.density, "density, not printed in the thesis [kg/m^3]");
  line.positive("--slow-ramp", &o.slow_ramp, "duration of the slow ramp, not printed in the thesis [s]");
  line.positive("--stiffer", &o.stiffer,
                "factor of EA and GA in the snapshots; a large factor prevents stretch and shear");
  line.positive("--window", &o.window, "duration of the case 'energy' after the ramp [s]");
  line.option("--out", &o.out, "folder for CSV files and pictures");
  line.option("--viewer", &o.viewer, "page that plays films: polybody_viewer.html, which the target 'viewer' makes");
  line.option("--film", &o.film, "film of the case 'equal-mesh'; with a viewer, film.html in the folder --out");
  line.flag("--no-plot", &o.no_plot, "write the scripts but draw nothing");
  if (auto const code = line.parse(argc, argv)) return *code;
  if (!o.viewer.empty() && o.film.empty()) o.film = o.out / "film.html";
  try {
    if (o.is_of_formulations()) return run_formulations(o, problem_of(o)) ? 0 : 1;
    o.body = o.body_of_figures({"lrvf", "se3", "ancf", "ancf-engineering", "rigid"});
    if (o.which == "all" || o.which == "angle") figure_2_4(o);
    if (o.body == "lrvf") run_cases<planar::Lrvf>(o);
    if (o.body == "se3") run_cases<planar::Se3Beam>(o);
    if (o.body == "ancf") run_cases<planar::AncfCable<GreenStrain>>(o);
    if (o.body == "ancf-engineering") run_cases<planar::AncfCable<EngineeringStrain>>(o);
    if (o.body == "rigid") run_cases<planar::Rigid>(o);
    if (o.which == "all" || o.which == "equal-mesh") equal_meshes(o);
    if (o.which == "all" || o.which == "energy") energies(o);
    if (o.which == "all" || o.which == "bands") bands(o);
    if (o.which == "split" && !split(o, problem_of(o))) return 1;
  } catch (Error const& e) {
    std::cerr << "robot_arm: " << e.what() << '\n';
    return 1;
  }
}
