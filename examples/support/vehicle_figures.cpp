// Histories of runs of the tracked vehicle, measured, filtered and drawn.
#include <polybody/signals/filter.hpp>

#include "../tracked_vehicle.hpp"

namespace chapter3 {

std::vector<double> const& Runs::history(std::size_t run, std::string const& name) const {
  auto const& r = comparison.runs[run];
  auto const at = std::find(r.output_names.begin(), r.output_names.end(), name);
  return r.outputs[std::size_t(at - r.output_names.begin())];
}

std::span<double const> Runs::filtered_times(std::size_t run) const {
  return std::span(times(run)).first(times(run).size() - (comparison.runs[run].run.stopped ? 1 : 0));
}

std::vector<double> filtered_values(Runs const& runs, std::size_t run, std::vector<double> const& values,
                                    double cut_off) {
  auto const times = runs.filtered_times(run);
  return low_pass(times, std::span(values).first(times.size()), {.cut_off = cut_off, .mirrored = true});
}

Filtered filtered(Runs const& runs, std::size_t run, std::string const& output, double cut_off) {
  auto const times = runs.filtered_times(run);
  auto const values = std::span(runs.history(run, output)).first(times.size());
  Filtered f{{times.begin(), times.end()}, {values.begin(), values.end()}};
  if (runs.sampling > 0.0) {  // a recorded state is up to one step later than its sampling time
    f.values = resampled(f.times, f.values, runs.sampling, 2.5 * runs.sampling);
    double const start = f.times.front();
    f.times.clear();
    while (f.times.size() < f.values.size()) f.times.push_back(start + double(f.times.size()) * runs.sampling);
  }
  f.values = low_pass(f.times, f.values, {.cut_off = cut_off, .mirrored = true});
  return f;
}

Span span_of(std::vector<double> const& times, std::vector<double> const& x, double from, double to) {
  Span s;
  std::size_t count = 0;
  for (std::size_t i = 0; i < std::min(times.size(), x.size()); ++i) {
    if (times[i] < from || times[i] > to) continue;
    s.mean += x[i];
    ++count;
    if (x[i] < s.least) s.least = x[i], s.at_least = times[i];
    if (x[i] > s.most) s.most = x[i], s.at_most = times[i];
  }
  s.mean /= double(std::max<std::size_t>(count, 1));
  return s;
}

double yaw_rate(Runs const& runs, std::size_t run, double from) {
  auto const &t = runs.times(run), &yaw = runs.history(run, "yaw [rad]");
  std::size_t const first = std::min(std::size_t(std::lower_bound(t.begin(), t.end(), from) - t.begin()), t.size() - 2);
  double turned = 0.0;  // the yaw angle jumps by 2π at ±π
  for (std::size_t i = first + 1; i < t.size(); ++i)
    turned += std::remainder(yaw[i] - yaw[i - 1], 2.0 * std::numbers::pi);
  return turned / (t.back() - t[first]);
}

// A curve of every `every`-th sample, so that files stay small.
Curve curve(std::string label, std::vector<double> const& x, std::vector<double> const& y, int colour, double scale,
            std::size_t every) {
  Curve c{.label = std::move(label), .colour = colour};
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); i += every) {
    c.x.push_back(x[i]);
    c.y.push_back(scale * y[i]);
  }
  return c;
}

void draw(Settings const& o, Figure const& f, std::string const& name) {
  write_figure(f, o.out / name, !o.no_plot);
  std::cout << "  " << (o.out / name).string() << (o.no_plot ? ".gp" : ".png") << '\n';
}

Figure history_figure(Runs const& runs, std::string const& output, std::string title, std::string label, double cut_off,
                      double scale) {
  Figure f{.title = std::move(title), .x_label = "t [s]", .y_label = std::move(label)};
  std::size_t const every = cut_off > 0.0 || output.find("force") == std::string::npos ? 4 : 1;
  std::vector<int> const colours = formulation_colours(runs.comparison);
  for (std::size_t k = 0; k < runs.comparison.runs.size(); ++k) {
    Filtered const h =
        cut_off > 0.0 ? filtered(runs, k, output, cut_off) : Filtered{runs.times(k), runs.history(k, output)};
    f.curves.push_back(curve(runs.comparison.runs[k].name, h.times, h.values, colours[k], scale, every));
  }
  return f;
}

void over_time(Settings const& o, Runs const& runs, std::string const& output, std::string title, std::string label,
               std::string const& name, double cut_off, double scale) {
  draw(o, history_figure(runs, output, std::move(title), std::move(label), cut_off, scale), name);
}

// Mean forward velocity after the time `from` [s]. The transient of the ramp may last until 9 s.
double mean_speed(Runs const& runs, std::size_t run, double from) {
  auto const &t = runs.times(run), &x = runs.history(run, "forward position [m]");
  std::size_t first = 0;
  while (first + 1 < t.size() && t[first] < from) ++first;
  return (x.back() - x[first]) / (t.back() - t[first]);
}

}  // namespace chapter3
