// The flexible robot arm of Chapter 2 (Figures 2.4 to 2.8) under several formulations, side by side.
//   robot_arm --case all --out out/robot_arm

#include "chapter2_plots.hpp"
#include "support/command_line.hpp"

using namespace chapter2;
namespace fs = std::filesystem;

namespace {

struct Options {
  std::string which = "all";
  std::string body = "lrvf";
  Index elements = 10;
  double step = 5e-3;
  double density = 7850.0;
  double slow_ramp = 10.0;
  double until = 0.0;
  fs::path out = "out/robot_arm";
  bool no_plot = false;
};

// One repositioning: a snapshot every second while the arm is driven.
struct Case {
  std::string name, title, file;
  Stiffness stiffness;
  double ramp;
  double axial_force = 0.0;
};

std::vector<Case> cases(Options const& o) {
  return {
      {"high", "Figure 2.5: high stiffness", "figure_2_5_high", high, o.slow_ramp},
      {"medium", "Figure 2.6: medium stiffness", "figure_2_6_medium", medium, o.slow_ramp},
      {"fast-medium", "Figure 2.7: fast, stiffness of Figure 2.6 (by the text)", "figure_2_7_fast_medium", medium, 4.5},
      {"fast-low", "Figure 2.7: fast, low stiffness (by the caption)", "figure_2_7_fast_low", low, 4.5},
      {"axial", "Figure 2.8: low stiffness, 100 kN along the tip", "figure_2_8_axial", low, 4.5, 100e3}};
}

void figure_2_4(Options const& o) {
  Figure f{.title = "Figure 2.4: prescribed angle of the pin", .x_label = "t [s]", .y_label = "angle [rad]"};
  int color = 0;
  for (double ramp : {o.slow_ramp, 4.5}) {
    Ramp const law{.target = angle, .duration = ramp};
    Curve c{.label = color == 0 ? "slow (Figures 2.5, 2.6)" : "fast (Figures 2.7, 2.8)", .color = color};
    for (double t : {0.0, ramp, o.slow_ramp * 1.2}) {
      c.x.push_back(t);
      c.y.push_back(law(t).value);
    }
    f.curves.push_back(c);
    ++color;
  }
  draw(f, o.out / "figure_2_4_angle", !o.no_plot);
}

template <class B>
void run_case(Options const& o, Case const& c) {
  RobotArm<B> arm(bar(c.stiffness, o.density), o.elements, c.ramp, c.axial_force);
  State x = arm.model.reference_state();
  double const until = o.until > 0.0 ? o.until : c.ramp;
  Figure snapshots{
      .title = c.title + ", one shape a second", .x_label = "x [m]", .y_label = "y [m]", .equal_axes = true};
  std::vector<std::string> heads{"t [s]", "tip x [m]", "tip y [m]", "kinetic energy [J]", "strain energy [J]"};
  std::vector<std::vector<double>> columns(5);
  bool constexpr two_meshes = std::is_same_v<B, planar::Lrvf>;
  if constexpr (two_meshes) {
    heads.insert(heads.end(), {"node gap [m]", "length of the position mesh [m]", "length of the rotation mesh [m]"});
    columns.resize(8);
  }
  double widest = 0.0, longest = 0.0, next_snapshot = 0.0;
  Progress progress(0.0, until, c.name);
  for (State const& now : simulate(arm.model, x, GeneralizedAlpha{.rho_inf = 0.8}, {.until = until, .step = o.step})) {
    Vec3 const tip = position(arm.model, now, arm.arm.at(length));
    Energy const e = energy(arm.model, now);
    std::vector<double> row{now.t, tip[0], tip[1], e.kinetic, e.strain};
    if constexpr (two_meshes) {
      MeshDiagnostics const d = mesh_diagnostics(arm.arm.body(), coordinates_of(arm.model, now, arm.arm));
      row.insert(row.end(), {d.largest_gap, d.position_length, d.rotation_length});
      widest = std::max(widest, d.largest_gap);
      longest = std::max(longest, d.position_length);
    }
    for (std::size_t i = 0; i < row.size(); ++i) columns[i].push_back(row[i]);
    if (now.t >= next_snapshot - 1e-9) {
      add_snapshot(snapshots, arm.model, now, arm.arm, length);
      next_snapshot += 1.0;
    }
    progress.update(now.t);
  }
  progress.finish();
  std::string const stem = two_meshes ? c.file : c.file + "_" + o.body;
  write_table(o.out / (stem + ".csv"), heads, columns);
  fit(snapshots);
  draw(snapshots, o.out / stem, !o.no_plot);
  if constexpr (two_meshes)
    std::printf(
        "  %-12s largest gap between the meshes' nodes %.4f m; longest position mesh %.3f m, rotation mesh %.3f m\n",
        c.name.c_str(), widest, longest, columns[7].back());
}

// The same arm under other bodies, joints and integrators.
struct ArmCase {
  Options const& o;
  Stiffness stiffness;
  double ramp;

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
    outputs.push_back({"lag of the tip [m]", [tip, this](M const& m, State const& x) {
                         double const psi = Ramp{.target = angle, .duration = ramp}(x.t).value;
                         Vec3 const r = position(m, x, tip);
                         return std::cos(psi) * r[1] - std::sin(psi) * r[0];
                       }});
    return Scenario<M>{std::move(arm.model),
                       start,
                       {.until = o.until > 0.0 ? o.until : 1.5 * ramp, .step = o.step},
                       std::move(outputs)};
  }
};

void comparison(Options const& o) {
  GeneralizedAlpha const implicit{.rho_inf = 0.8};
  Penalty const stiff{.stiffness = 1e9, .damping = 1e5};
  Comparison const c = compare(
      ArmCase{o, medium, 4.5}, Formulation<planar::Lrvf, Constraint, GeneralizedAlpha>{"LRVF", {}, implicit},
      Formulation<planar::Lrvf, Penalty, GeneralizedAlpha>{"LRVF, penalty", stiff, implicit},
      Formulation<planar::AncfCable<GreenStrain>, Constraint, GeneralizedAlpha>{"ANCF Green", {}, implicit},
      Formulation<planar::AncfCable<EngineeringStrain>, Constraint, GeneralizedAlpha>{"ANCF engin.", {}, implicit},
      Formulation<planar::Rigid, Constraint, GeneralizedAlpha>{"rigid", {}, implicit});
  std::cout << "\nThe arm of medium stiffness, 1.5 rad in 4.5 s, under five formulations:\n\n";
  report(c, o.out / "comparison", !o.no_plot);
}

template <class B>
void run_cases(Options const& o) {
  for (Case const& c : cases(o))
    if (o.which == "all" || o.which == c.name) run_case<B>(o, c);
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  CommandLine line{
      "The flexible robot arm of Chapter 2: Figures 2.4 to 2.8, and the same arm under several formulations"};
  line.one_of("--case", &o.which, {"all", "angle", "high", "medium", "fast-medium", "fast-low", "axial", "compare"},
              "what to run");
  line.one_of("--body", &o.body, {"lrvf", "ancf", "ancf-engineering", "rigid"},
              "formulation of the snapshots; only lrvf has two meshes");
  line.positive("--elements", &o.elements, "elements along the arm");
  line.positive("--step", &o.step, "time step [s]");
  line.not_negative("--until", &o.until, "end of the run [s]; 0: the end of the ramp");
  line.positive("--density", &o.density, "density, not printed in the thesis [kg/m^3]");
  line.positive("--slow-ramp", &o.slow_ramp, "duration of the slow ramp, not printed in the thesis [s]");
  line.option("--out", &o.out, "folder for CSV files and pictures");
  line.flag("--no-plot", &o.no_plot, "write the scripts but draw nothing");
  if (auto const code = line.parse(argc, argv)) return *code;
  try {
    if (o.which == "all" || o.which == "angle") figure_2_4(o);
    if (o.body == "lrvf") run_cases<planar::Lrvf>(o);
    if (o.body == "ancf") run_cases<planar::AncfCable<GreenStrain>>(o);
    if (o.body == "ancf-engineering") run_cases<planar::AncfCable<EngineeringStrain>>(o);
    if (o.body == "rigid") run_cases<planar::Rigid>(o);
    if (o.which == "all" || o.which == "compare") comparison(o);
  } catch (Error const& e) {
    std::cerr << "robot_arm: " << e.what() << '\n';
    return 1;
  }
}
