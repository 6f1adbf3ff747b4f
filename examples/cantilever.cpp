// The clamped beam of Chapter 2 under a moment at its tip (Figures 2.9 and 2.10), and the same beam rolled into a full
// circle under several formulations.
//   cantilever --case all --out out/cantilever
//   cantilever --case compare --body lrvf,ancf --error 1e-2,1e-3      # at equal error
//   cantilever --case run --body ffr-modal --integrator hht,radau     # --list: the combinations
//   cantilever --case space                                           # the two meshes of beams in space
//   cantilever --case equal-mesh --viewer build/release/polybody_viewer.html --film beam.html
#include <numbers>

#include "cantilever/space.hpp"
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
  double end_time = 20.0;
  double moment = 30e3;
  fs::path out = "out/cantilever";
  fs::path viewer, film;
  bool no_plot = false;
};

using Lrvf = Cantilever<planar::Lrvf>;

// Prints the position of the tip on each of the two meshes.
void tell_tips(Lrvf const& beam, State const& now) {
  auto const q = coordinates_of(beam.model, now, beam.beam);
  MeshDiagnostics const d = mesh_diagnostics(beam.beam.body(), q);
  Vec2 const p = d.position_nodes.back(), r = d.rotation_nodes.back();
  char row[32];
  std::snprintf(row, sizeof row, "t = %g s", now.t);
  say(row, "tip x of the position mesh", p[0], "m");
  say(row, "tip y of the position mesh", p[1], "m");
  say(row, "tip x of the rotation mesh", r[0], "m");
  say(row, "tip y of the rotation mesh", r[1], "m");
  say(row, "tips apart", (p - r).norm(), "m");
  meshes_head();
  meshes_row("tip-moment", now.t, meshes_apart(beam.beam.body(), q));
}

// Figure 2.10: curvature of both meshes along the beam.
void curvatures(Options const& o, Lrvf const& beam, State const& x) {
  MeshDiagnostics const d = mesh_diagnostics(beam.beam.body(), coordinates_of(beam.model, x, beam.beam));
  Curve rotation{.label = "rotation mesh: constant in each element", .colour = 1},
      position{.label = "position mesh: zero", .colour = 0},
      still{.x = {0.0, length},
            .y = {o.moment / low.EI, o.moment / low.EI},
            .label = "M/EI at rest",
            .style = "dashed",
            .colour = 2};
  double const l = length / double(o.elements);
  double jump = 0.0, largest = 0.0, straight = 0.0;
  for (std::size_t e = 0; e < d.rotation_curvature.size(); ++e) {
    for (double end : {0.0, 1.0}) {
      rotation.x.push_back((double(e) + end) * l);
      rotation.y.push_back(d.rotation_curvature[e]);
      position.x.push_back((double(e) + end) * l);
      position.y.push_back(d.position_curvature[e]);
    }
    if (e > 0) jump = std::max(jump, std::abs(d.rotation_curvature[e] - d.rotation_curvature[e - 1]));
    largest = std::max(largest, std::abs(d.rotation_curvature[e]));
    straight = std::max(straight, d.position_curvature[e]);
  }
  write_table(o.out / "figure_2_10_curvature.csv", {"s [m]", "rotation mesh [1/m]", "position mesh [1/m]"},
              {rotation.x, rotation.y, position.y});
  draw({.title = "Figure 2.10: curvature of the two meshes at t = " + std::to_string(int(o.end_time)) + " s",
        .x_label = "s [m]",
        .y_label = "curvature [1/m]",
        .curves = {position, rotation, still},
        .y_range = std::array{std::min(-0.1 * largest, 1.1 * *std::ranges::min_element(rotation.y)), 1.1 * largest}},
       o.out / "figure_2_10_curvature", !o.no_plot);
  say("curvature", "largest jump", jump, "1/m");
  say("curvature", "largest on the rotation mesh", largest, "1/m");
  say("curvature", "largest on the position mesh", straight, "1/m");
}

// Figures 2.9 and 2.10: a constant moment acts on a beam that is straight and at rest at the start. The beam oscillates
// about its static shape.
template <class B>
void tip_moment(Options const& o) {
  Cantilever<B> beam(bar(low, o.density), o.elements, o.moment);
  State x = beam.model.reference_state();
  Figure shapes{.title = "Figure 2.9: 30 kN m at the tip of the clamped beam\n" + stiffness_text(low) + ", " +
                         std::to_string(o.elements) + " elements",
                .x_label = "x [m]",
                .y_label = "y [m]",
                .equal_axes = true};
  std::vector<double> const wanted{0.0, 1.0, 2.0, 3.0, 4.0, 20.0};
  std::size_t next = 0;
  std::vector<std::vector<double>> columns(5);
  Progress progress(0.0, o.end_time, "tip moment");
  for (auto const& now :
       simulate(beam.model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = o.end_time, .step = o.step})) {
    Vec3 const tip = now.position(beam.beam.at(length));
    Energy const e = now.energy();
    std::vector<double> const row{now.t, tip[0], tip[1], e.kinetic, e.strain};
    for (std::size_t i = 0; i < row.size(); ++i) columns[i].push_back(row[i]);
    if (next < wanted.size() && now.t >= wanted[next] - 1e-9) {
      add_snapshot(shapes, beam.model, now, beam.beam, length);
      if constexpr (std::is_same_v<B, planar::Lrvf>) tell_tips(beam, now);
      ++next;
    }
    progress.update(now.t);
  }
  progress.finish();
  std::string const suffix = std::is_same_v<B, planar::Lrvf> ? "" : "_" + o.body;
  write_table(o.out / ("figure_2_9_tip_moment" + suffix + ".csv"),
              {"t [s]", "tip x [m]", "tip y [m]", "kinetic energy [J]", "strain energy [J]"}, columns);
  fit(shapes);
  draw(shapes, o.out / ("figure_2_9_tip_moment" + suffix), !o.no_plot);
  if constexpr (std::is_same_v<B, planar::Lrvf>) curvatures(o, beam, x);
}

// Static solution in one formulation. The moment M = 2 pi EI/L closes a Bernoulli-Euler beam to an exact circle.
template <class B>
double roll_up(Options const& o, Figure& shapes, std::string const& name, Index elements, int colour) {
  double const full = 2.0 * std::numbers::pi * low.EI / length;
  Cantilever<B> beam(bar(low, o.density), elements, full);
  State x = beam.model.reference_state();
  EquilibriumReport const report = equilibrium(beam.model, x, {.load_steps = 10});
  Curve c = shape_of(beam.model, x, beam.beam, length, 120);
  c.label = name;
  c.colour = colour;
  c.style = colour == 0 ? "lines" : "dashed";
  shapes.curves.push_back(c);
  double const open = position(beam.model, x, beam.beam.at(length)).norm();
  say("roll-up of " + name, "elements", double(elements));
  say("roll-up of " + name, "open", open, "m");
  say("roll-up of " + name, "Newton iterations", double(report.iterations));
  return open;
}

void roll_up_all(Options const& o) {
  Figure shapes{.title = "A moment of 2 pi EI/L closes the beam to a circle",
                .x_label = "x [m]",
                .y_label = "y [m]",
                .equal_axes = true};
  roll_up<planar::Lrvf>(o, shapes, "LRVF", o.elements, 0);
  roll_up<planar::AncfCable<EngineeringStrain>>(o, shapes, "ANCF with engineering strain", 16, 1);
  roll_up<planar::AncfCable<GreenStrain>>(o, shapes, "ANCF with Green strain", 16, 2);
  fit(shapes);
  draw(shapes, o.out / "roll_up", !o.no_plot);
}

// Case for `compare`: the beam under a sudden tip moment in one formulation.
struct BeamCase {
  Options const& o;
  std::shared_ptr<Film> film = nullptr;

  template <class F>
  auto operator()(F const& f) const {
    using Beam = Cantilever<typename F::BodyType>;
    using M = typename Beam::Model;
    Beam beam(bar(low, o.density), o.elements, o.moment);
    State const start = beam.model.reference_state();
    auto const tip = beam.beam.at(length);
    std::function<void(M const&, State const&)> observer;
    if (film) observer = BarFilm<M, typename F::BodyType>(scene_of(*film, f), beam.beam, solid_bar(low, o.density));
    return Scenario<M>{std::move(beam.model),
                       start,
                       {.end_time = std::min(o.end_time, 4.0), .step = o.step},
                       {{"tip x [m]", [tip](M const& m, State const& x) { return position(m, x, tip)[0]; }},
                        {"tip y [m]", [tip](M const& m, State const& x) { return position(m, x, tip)[1]; }}},
                       observer};
  }
};

void equal_meshes(Options const& o) {
  GeneralisedAlpha const implicit{.rho_inf = 0.8};
  std::shared_ptr<Film> film;
  if (!o.film.empty())
    film = std::make_shared<Film>(
        film_options(o.viewer, "The clamped beam, " + number(1e-3 * o.moment) + " kN m at its tip"));
  Comparison const c = require_complete(compare(
      BeamCase{o, film}, Formulation<planar::Lrvf, Constraint, GeneralisedAlpha>{"LRVF", {}, implicit},
      Formulation<planar::AncfCable<GreenStrain>, Constraint, GeneralisedAlpha>{"ANCF Green", {}, implicit},
      Formulation<planar::AncfCable<EngineeringStrain>, Constraint, GeneralisedAlpha>{"ANCF engin.", {}, implicit}));
  std::cout << "\nThe clamped beam under the tip moment, three formulations:\n\n";
  report(c, o.out / "comparison", !o.no_plot);
  if (film) film->write(o.film);
}

Problem problem_of(Options const& o) {
  return {.mechanism = Mechanism::cantilever,
          .motion = "clamped beam, " + number(1e-3 * o.moment) + " kN m at its tip",
          .setup = {.stiffness = o.chosen_stiffness(), .density = o.density, .moment = o.moment},
          .end_time = o.which == "run" ? o.end_time : std::min(o.end_time, 4.0),
          .output = "tip x [m]",
          .output_value = [](double, Vec3 const& tip) { return tip[0]; }};
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  o.stiffness = low.name;
  o.meshes = {5, 10, 20, 40, 80, 160};  // with more elements, vibrations due to the sudden moment hide the convergence
  CommandLine line{
      "The clamped beam of Chapter 2: Figures 2.9 and 2.10, roll-up to a circle, two meshes in space, and a comparison "
      "of "
      "formulations"};
  add_formulation_options(line, o, {"moment", "roll-up", "space", "equal-mesh"});
  line.positive("--until", &o.end_time, "end of the run [s]; at most 4 s in comparisons");
  line.option("--moment", &o.moment, "moment at the tip [N m]");
  line.positive("--density", &o.density, "density, which the thesis does not give [kg/m^3]");
  line.option("--out", &o.out, "folder for CSV files and pictures");
  line.option("--viewer", &o.viewer, "page that plays films: polybody_viewer.html, which the target 'viewer' makes");
  line.option("--film", &o.film, "film of the case 'equal-mesh'; with a viewer, film.html in the folder --out");
  line.flag("--no-plot", &o.no_plot, "write the scripts but draw nothing");
  if (auto const code = line.parse(argc, argv)) return *code;
  if (!o.viewer.empty() && o.film.empty()) o.film = o.out / "film.html";
  try {
    if (o.is_of_formulations()) return run_formulations(o, problem_of(o)) ? 0 : 1;
    o.body = o.body_of_figures({"lrvf", "ancf", "ancf-engineering"});
    bool const all = o.which == "all";
    if (all || o.which == "moment") {
      if (o.body == "lrvf") tip_moment<planar::Lrvf>(o);
      if (o.body == "ancf") tip_moment<planar::AncfCable<GreenStrain>>(o);
      if (o.body == "ancf-engineering") tip_moment<planar::AncfCable<EngineeringStrain>>(o);
    }
    if (all || o.which == "roll-up") roll_up_all(o);
    if (all || o.which == "space") meshes_in_space(o.out, !o.no_plot);
    if (all || o.which == "equal-mesh") equal_meshes(o);
  } catch (Error const& e) {
    std::cerr << "cantilever: " << e.what() << '\n';
    return 1;
  }
}
