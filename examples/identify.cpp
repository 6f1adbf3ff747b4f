// Identification of the stiffness and damping of a mount from a noisy record of the motion of a flexible arm on the
// mount. The method is least squares with the exact derivatives of runs, under four formulations of the arm, with
// confidence intervals.
//   identify --out out/identify
#include <iostream>

#include "identify/arm.hpp"
#include "support/command_line.hpp"

using namespace identify;
namespace fs = std::filesystem;

namespace {

struct Options {
  Experiment experiment;
  Numbers truth{2000.0, 30.0, 25.0, 0.25};
  double noise = 5e-4, off = 1.5;
  std::ptrdiff_t seed = 1;
  fs::path out = "out/identify";
  bool no_plot = false;
};

void print_numbers(Options const& o, std::vector<Estimate> const& found) {
  std::printf("%-8s", "");
  for (char const* const name : names) std::printf(" %22s", name);
  std::printf("\n%-8s", "true");
  for (double const x : o.truth) std::printf(" %22.4g", x);
  for (Estimate const& e : found) {
    std::printf("\n%-8s", e.name.c_str());
    for (std::size_t j = 0; j < names.size(); ++j) {
      char text[64];
      std::snprintf(text, sizeof text, "%.4g ± %.2g", e.value[j], e.interval(j));
      std::printf(" %23s", text);  // ± has two bytes
    }
  }
  std::printf("\n\noff the true value, in intervals of 95 %%\n");
  for (Estimate const& e : found) {
    std::printf("%-8s", e.name.c_str());
    for (std::size_t j = 0; j < names.size(); ++j) std::printf(" %22.2f", (e.value[j] - o.truth[j]) / e.interval(j));
    std::printf("\n");
  }
  std::printf("\n%-8s %14s %11s %6s %10s %8s\n", "", "residual [mm]", "iterations", "runs", "gradients", "cpu [s]");
  for (Estimate const& e : found)
    std::printf("%-8s %14.3f %11zu %6d %10d %8.2f%s\n", e.name.c_str(), 1e3 * e.deviation, e.sums.size() - 1, e.runs,
                e.gradients, e.seconds, e.converged ? "" : "  not converged");
}

template <class F>
double seconds_of(F&& f) {
  std::clock_t const begin = std::clock();
  f();
  return double(std::clock() - begin) / CLOCKS_PER_SEC;
}

// Prints the cost of the exact derivatives in runs of the same formulation, and the errors of finite differences
// relative to the exact derivatives.
void print_gradients(std::vector<Candidate> const& candidates, Numbers const& p) {
  std::printf(
      "\na gradient of %zu numbers, in runs; largest error of its columns, relative\n%-8s %10s %10s %18s %18s\n",
      names.size(), "", "run [ms]", "exact", "one-sided", "two-sided");
  for (Candidate const& c : candidates) {
    VecX tip;
    MatX exact, forward, central;
    double const run = seconds_of([&] { tip = c.tip(p); }), derived = seconds_of([&] { exact = c.derivatives(p); });
    forward = central = MatX(exact.rows(), exact.cols());
    auto const moved = [&](std::size_t j, double by) {
      Numbers other = p;
      other[j] += by * p[j];
      return c.tip(other);
    };
    for (std::size_t j = 0; j < p.size(); ++j) {
      forward.col(Index(j)) = (moved(j, 1e-6) - tip) / (1e-6 * p[j]);
      central.col(Index(j)) = (moved(j, 1e-4) - moved(j, -1e-4)) / (2e-4 * p[j]);
    }
    auto const error = [&](MatX const& other) {
      return ((other - exact).colwise().norm().array() / exact.colwise().norm().array()).maxCoeff();
    };
    std::printf("%-8s %10.2f %10.1f %8d, %8.1e %8d, %8.1e\n", c.name.c_str(), 1e3 * run, derived / run, 5,
                error(forward), 8, error(central));
  }
}

Curve curve_of(Options const& o, VecX const& tip, Index axis) {
  Curve curve;
  for (Index i = axis; i < tip.size(); i += 2) {
    curve.x.push_back(o.experiment.sampling * (double(i / 2) + 1.0));
    curve.y.push_back(1e3 * tip[i]);
  }
  return curve;
}

void draw_record(Options const& o, VecX const& record, std::vector<Candidate> const& candidates,
                 std::vector<Estimate> const& found) {
  Figure fits{.title = "Height of the arm's tip: the record and what was fitted to it",
              .x_label = "t [s]",
              .y_label = "tip y [mm]"},
      rest{.title = "What the fits leave of the record", .x_label = "t [s]", .y_label = "tip y, record − fit [mm]"};
  Curve points = curve_of(o, record, 1);
  points.label = "record";
  points.style = "points";
  points.colour = 6;
  points.width = 0.8;
  fits.curves.push_back(points);
  for (std::size_t k = 0; k < found.size(); ++k) {
    VecX const tip = candidates[k].tip(found[k].value);
    Curve fit = curve_of(o, tip, 1), left = curve_of(o, record - tip, 1);
    fit.label = left.label = found[k].name;
    fit.colour = left.colour = int(k);
    fit.style = k == 0 ? "dashed" : "lines";
    fits.curves.push_back(fit);
    rest.curves.push_back(left);
  }
  write_panels({fits, rest}, 1, o.out / "record", !o.no_plot);
}

void draw_descent(Options const& o, std::vector<Estimate> const& found, Index values) {
  Figure figure{.title = "Descent of the residual", .x_label = "iteration", .y_label = "residual [mm]", .log_y = true};
  for (std::size_t k = 0; k < found.size(); ++k) {
    Curve c{.label = found[k].name, .style = "linespoints", .colour = int(k)};
    for (std::size_t i = 0; i < found[k].sums.size(); ++i) {
      c.x.push_back(double(i));
      c.y.push_back(1e3 * std::sqrt(2.0 * found[k].sums[i] / double(values - Index(names.size()))));
    }
    figure.curves.push_back(c);
  }
  write_figure(figure, o.out / "descent", !o.no_plot);
}

// Ellipse (p − p̂)ᵀ C⁻¹ (p − p̂) = 5.99 of two parameters p, relative to their true values. The ellipse contains both
// parameters with a probability of 95 %.
Curve ellipse(Options const& o, Estimate const& e, std::size_t i, std::size_t j) {
  auto const a = Index(i), b = Index(j);
  double const l11 = std::sqrt(e.covariance(a, a)), l21 = e.covariance(b, a) / l11,
               l22 = std::sqrt(e.covariance(b, b) - l21 * l21), radius = std::sqrt(5.991);
  Curve c{.label = e.name};
  for (int k = 0; k <= 120; ++k) {
    double const phi = 2.0 * std::numbers::pi * k / 120.0, u = radius * std::cos(phi), v = radius * std::sin(phi);
    c.x.push_back((e.value[i] + l11 * u) / o.truth[i]);
    c.y.push_back((e.value[j] + l21 * u + l22 * v) / o.truth[j]);
  }
  return c;
}

void draw_ellipses(Options const& o, std::vector<Estimate> const& found) {
  std::vector<Figure> panels;
  for (std::size_t const first : {std::size_t(0), std::size_t(1)})
    for (std::size_t const i : {std::size_t(0), std::size_t(2)}) {
      Figure panel{.title = std::string(i == 0 ? "Slides of the mount" : "Turn of the mount") +
                            (first == 0 ? ": 95 % of all formulations" : ", the flexible arms alone"),
                   .x_label = std::string(i == 0 ? "k" : "k_t") + ", over the true one",
                   .y_label = std::string(i == 0 ? "c" : "c_t") + ", over the true one"};
      for (std::size_t k = first; k < found.size(); ++k) {
        Curve c = ellipse(o, found[k], i, i + 1);
        c.colour = int(k);
        panel.curves.push_back(std::move(c));
      }
      panel.curves.push_back({.x = {1.0}, .y = {1.0}, .label = "true", .style = "points", .colour = 6, .width = 2.5});
      panels.push_back(std::move(panel));
    }
  write_panels(panels, 2, o.out / "ellipses", !o.no_plot);
}

void run(Options const& o) {
  VecX const record = with_noise(exact_record(o.experiment, o.truth), o.noise, std::uint64_t(o.seed));
  std::vector<Candidate> const candidates{
      candidate<planar::Rigid>("rigid", o.experiment), candidate<planar::Ffr>("Ffr", o.experiment, 3),
      candidate<planar::AncfCable<>>("ANCF", o.experiment, 4), candidate<planar::Lrvf>("Lrvf", o.experiment, 10)};
  Numbers start = o.truth;
  for (std::size_t j = 0; j < start.size(); ++j) start[j] *= j % 2 == 0 ? o.off : 1.0 / o.off;
  std::printf("%td samples of the tip with noise of %g mm; the arm that was recorded is none of those below\n\n",
              record.size() / 2, 1e3 * o.noise);
  std::vector<Estimate> found;
  for (Candidate const& c : candidates) found.push_back(estimate(c, record, start));
  print_numbers(o, found);
  print_gradients(candidates, o.truth);
  draw_record(o, record, candidates, found);
  draw_descent(o, found, record.size());
  draw_ellipses(o, found);
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  CommandLine line{"The stiffness and damping of an arm's mount from a noisy record, under four formulations."};
  line.positive("--stiffness", &o.truth[0], "stiffness of the recorded mount [N/m]");
  line.positive("--damping", &o.truth[1], "damping of the recorded mount [N s/m]");
  line.positive("--turn-stiffness", &o.truth[2], "rotational stiffness of the recorded mount [N m/rad]");
  line.positive("--turn-damping", &o.truth[3], "rotational damping of the recorded mount [N m s/rad]");
  line.positive("--noise", &o.noise, "standard deviation of the noise of the record [m]");
  line.between("--off", &o.off, 1.0, 5.0, "factor between the initial values and the true values");
  line.option("--seed", &o.seed, "seed of the noise");
  line.positive("--until", &o.experiment.end_time, "end of the record [s]");
  line.option("--out", &o.out, "folder of the pictures");
  line.flag("--no-plot", &o.no_plot, "write data and scripts, but draw nothing");
  if (auto const code = line.parse(argc, argv)) return *code;
  try {
    run(o);
  } catch (Error const& e) {
    std::cerr << "identify: " << e.what() << '\n';
    return 1;
  }
}
