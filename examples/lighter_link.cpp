// Design of the lightest link that rotates a mass by 90° with a bounded stress, with the exact derivatives of runs,
// under four formulations of the link. Each design is then evaluated under the other formulations.
//   lighter_link --out out/lighter_link
#include <iostream>

#include "lighter_link/search.hpp"
#include "support/command_line.hpp"

using namespace lighter_link;
namespace fs = std::filesystem;

namespace {

struct Options {
  Task task;
  Aggregate aggregate;
  Bounds bounds;
  fs::path out = "out/lighter_link";
  bool no_plot = false;
};

void print_designs(std::vector<Lightest> const& found) {
  std::printf("%-8s %10s %26s %12s %12s %6s %8s\n", "", "mass [kg]", "heights [mm]", "aggregate", "largest", "runs",
              "cpu [s]");
  for (Lightest const& d : found) {
    std::string heights;
    for (double const h : d.heights) {
      char text[16];
      std::snprintf(text, sizeof text, " %.2f", 1e3 * h);
      heights += text;
    }
    std::printf("%-8s %10.4f %26s %12.4f %12.4f %6zu %8.2f  %s%s\n", d.name.c_str(), d.mass, heights.c_str(),
                d.aggregate, d.stress, d.masses.size(), d.seconds, d.why.c_str(), d.converged ? "" : ", not converged");
  }
  std::printf("\nthe aggregate lies above the largest stress by\n");
  for (Lightest const& d : found) std::printf("%-8s %.2f %%\n", d.name.c_str(), 100.0 * (d.aggregate / d.stress - 1.0));
}

// Prints the largest stress of each design under each formulation, relative to the allowed stress.
void print_crosswise(std::vector<Candidate> const& candidates, std::vector<Lightest> const& found) {
  std::printf("\nlargest stress, over what is allowed, of the design of\n%-14s", "under");
  for (Lightest const& d : found) std::printf(" %8s", d.name.c_str());
  for (Candidate const& c : candidates) {
    std::printf("\n%-14s", c.name.c_str());
    for (Lightest const& d : found) std::printf(" %8.4f", c.stresses(d.heights).maxCoeff());
  }
  std::printf("\n");
}

Curve counted(std::vector<double> const& y, std::string label, int colour, std::string style) {
  Curve c{.y = y, .label = std::move(label), .style = std::move(style), .colour = colour};
  for (std::size_t i = 0; i < y.size(); ++i) c.x.push_back(double(i + 1));
  return c;
}

void draw_descent(Options const& o, std::vector<Lightest> const& found) {
  Figure mass{.title = "Mass of the designs that were tried", .x_label = "run", .y_label = "mass [kg]"},
      stress{.title = "Their stress, aggregated (lines) and largest (dashed)",
             .x_label = "run",
             .y_label = "stress, over what is allowed",
             .y_range = std::array{0.5, 1.5}};
  for (std::size_t k = 0; k < found.size(); ++k) {
    mass.curves.push_back(counted(found[k].masses, found[k].name, int(k), "linespoints"));
    stress.curves.push_back(counted(found[k].aggregates, found[k].name, int(k), "lines"));
    stress.curves.push_back(counted(found[k].stresses, "", int(k), "dashed"));
  }
  write_panels({mass, stress}, 1, o.out / "descent", !o.no_plot);
}

void draw_designs(Options const& o, std::vector<Lightest> const& found) {
  Figure figure{.title = "The lightest link under each formulation", .x_label = "x [m]", .y_label = "y [mm]"};
  for (std::size_t k = 0; k < found.size(); ++k) {
    Curve c{.label = found[k].name, .colour = int(k)};
    auto const edge = [&](double side) {
      for (std::size_t n = 0; n < found[k].heights.size(); ++n) {
        std::size_t const i = side > 0.0 ? n : found[k].heights.size() - 1 - n;
        for (int const end : {0, 1}) {
          c.x.push_back(o.task.section_length() * double(side > 0.0 ? i + std::size_t(end) : i + std::size_t(1 - end)));
          c.y.push_back(side * 500.0 * found[k].heights[i]);
        }
      }
    };
    edge(1.0);
    edge(-1.0);
    c.x.push_back(c.x.front());
    c.y.push_back(c.y.front());
    figure.curves.push_back(std::move(c));
  }
  write_figure(figure, o.out / "designs", !o.no_plot);
}

// Draws the stress at the root of the first and of the last design, under all formulations.
void draw_stress(Options const& o, std::vector<Candidate> const& candidates, std::vector<Lightest> const& found) {
  std::vector<Figure> panels;
  for (Lightest const* const d : {&found.front(), &found.back()}) {
    Figure panel{.title = "Stress at the root of the design of \"" + d->name + "\"",
                 .x_label = "t [s]",
                 .y_label = "stress, over what is allowed"};
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      MatX const s = candidates[k].stresses(d->heights);
      Curve c{.label = candidates[k].name, .style = k == 0 ? "dashed" : "lines", .colour = int(k)};
      for (Index i = 0; i < s.rows(); ++i) {
        c.x.push_back(o.task.end_time * double(i) / double(s.rows() - 1));
        c.y.push_back(s(i, 0));
      }
      panel.curves.push_back(std::move(c));
    }
    panels.push_back(std::move(panel));
  }
  write_panels(panels, 1, o.out / "stress", !o.no_plot);
}

void run(Options const& o) {
  std::vector<Candidate> const candidates{candidate<planar::Rigid>("rigid", o.task, o.aggregate),
                                          candidate<planar::Ffr>("Ffr", o.task, o.aggregate, 1),
                                          candidate<planar::AncfCable<>>("ANCF", o.task, o.aggregate, 1),
                                          candidate<planar::Lrvf>("Lrvf", o.task, o.aggregate, 3)};
  std::printf("the start: %zu sections of %g mm, %.4f kg\n\n", o.task.sections, 1e3 * o.bounds.start,
              o.task.mass(std::vector<double>(o.task.sections, o.bounds.start)));
  std::vector<Lightest> found;
  for (Candidate const& c : candidates) found.push_back(lightest(c, o.task, o.bounds));
  print_designs(found);
  print_crosswise(candidates, found);
  draw_descent(o, found);
  draw_designs(o, found);
  draw_stress(o, candidates, found);
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  double megapascals = 1e-6 * o.task.allowed;
  std::ptrdiff_t sections = std::ptrdiff_t(o.task.sections);
  CommandLine line{"The lightest link that rotates a mass with a bounded stress, under four formulations."};
  line.positive("--allowed", &megapascals, "allowed stress [N/mm^2]");
  line.positive("--payload", &o.task.payload, "mass at the link's end [kg]");
  line.positive("--time", &o.task.turn.time, "time constant of the turn, about a quarter of its duration [s]");
  line.positive("--sharpness", &o.aggregate.sharpness,
                "sharpness of the aggregate of all stresses; a greater value brings it nearer to the largest stress");
  line.between("--sections", &sections, 1, 8, "number of sections of the link, each with its own height");
  line.positive("--step", &o.task.step, "time step [s]");
  line.option("--out", &o.out, "folder of the pictures");
  line.flag("--no-plot", &o.no_plot, "write data and scripts, but draw nothing");
  if (auto const code = line.parse(argc, argv)) return *code;
  o.task.allowed = 1e6 * megapascals;
  o.task.sections = std::size_t(sections);
  o.task.turn.middle = 4.0 * o.task.turn.time;
  o.task.end_time = 7.5 * o.task.turn.time;
  try {
    run(o);
  } catch (Error const& e) {
    std::cerr << "lighter_link: " << e.what() << '\n';
    return 1;
  }
}
