#pragma once
// Results of the vehicle's runs, printed in lines.
#include <polybody/signals/samples.hpp>
#include <polybody/vehicle/track_checks.hpp>

#include "../support/lines.hpp"
#include "../tracked_vehicle.hpp"

namespace chapter3 {

inline Span span_of(Runs const& runs, std::size_t k, std::string const& output, double from = 0.0) {
  return span_of(runs.times(k), runs.history(k, output), from);
}
inline double largest(Runs const& runs, std::size_t k, std::string const& output, double from = 0.0) {
  Span const s = span_of(runs, k, output, from);
  return std::max(std::abs(s.least), std::abs(s.most));
}
inline std::string const& name_of(Runs const& runs, std::size_t k) { return runs.comparison.runs[k].name; }

inline constexpr double force_cut_off = 30.0;  // [Hz]  [thesis §3.6]

// An interval of a run [s].
struct Interval {
  double from = 1.0, to = 4.0;
};

// Relative root mean square difference between two runs of the force in the watched pin, low-passed at 30 Hz: of the
// longitudinal and the vertical component together, or of `outputs`.
inline double force_difference(Runs const& first, std::size_t k, Runs const& runs, std::size_t run,
                               std::vector<std::string> const& outputs = {"joint force x [N]", "joint force z [N]"},
                               Interval const& in = {}) {
  RmsDifference d(in.from, in.to);
  for (std::string const& output : outputs) {
    Filtered const a = filtered(first, k, output, force_cut_off), b = filtered(runs, run, output, force_cut_off);
    d.add({b.times, b.values}, {a.times, a.values});
  }
  return d.value();
}

// Largest distance of the path of the watched link, relative to the chassis, from the path of the first run [m].
// `slack`: in the upper run between sprocket and idler; `taut`: elsewhere.
struct PathDistance {
  double taut = 0.0, slack = 0.0;
};
inline PathDistance path_distance(Runs const& runs, std::size_t run) {
  auto const path = [&](std::size_t k, std::size_t every) {
    auto const &x = runs.history(k, "link x in chassis [m]"), &z = runs.history(k, "link z in chassis [m]");
    std::vector<Vec2> points;
    for (std::size_t i = 0; i < x.size(); i += every) points.emplace_back(x[i], z[i]);
    return points;
  };
  std::vector<Vec2> const first = path(0, 1);
  PathDistance worst;
  for (Vec2 const& p : path(run, 8)) {
    double const x = p[0] + m113::chassis.x, z = p[1] + m113::chassis.z;
    bool const hangs = z > m113::sprocket_z && x < 0.0 && x > m113::idler_start_x;
    double& most = hangs ? worst.slack : worst.taut;
    most = std::max(most, distance_to_path(p, first));
  }
  return worst;
}

// Largest difference of a history of a run from the first run.
inline double most_apart(Runs const& runs, std::size_t run, std::string const& output) {
  auto const& r = runs.comparison.runs[run];
  return r.difference[std::size_t(std::find(r.output_names.begin(), r.output_names.end(), output) -
                                  r.output_names.begin())];
}

// Mean yaw rate and path radius of the chassis after a time. `rolling_rate` and `rolling_radius` are the values for
// tracks that roll without slip.
struct Turning {
  double rate = 0.0, radius = 0.0, rolling_rate = 0.0, rolling_radius = 0.0;  // [rad/s], [m]
};
inline Turning turning(Settings const& o, Runs const& runs, std::size_t k, double from) {
  auto const &t = runs.times(k), &x = runs.history(k, "forward position [m]"),
             &y = runs.history(k, "sideways position [m]");
  std::size_t const first = std::min(std::size_t(std::lower_bound(t.begin(), t.end(), from) - t.begin()), t.size() - 2);
  double const rate = yaw_rate(runs, k, from);
  double way = 0.0;
  for (std::size_t i = first + 1; i < t.size(); ++i) way += std::hypot(x[i] - x[i - 1], y[i] - y[i - 1]);
  double const apart = o.left - o.right, duration = t.back() - t[first];
  return {std::abs(rate), std::abs(way / (rate * duration)),
          std::abs(o.speed * apart) * m113::rolling_radius / (2.0 * m113::track_y),
          std::abs((o.left + o.right) / apart) * m113::track_y};
}

// Forward distance of tracks that roll without slip until the time t [m].
inline double rolled(Settings const& o, double t) {
  Ramp drive = m113::drive(o.speed, 0.1);
  drive.duration = o.ramp;
  return drive.integral(t) * m113::rolling_radius;
}

// Vertical displacement of the chassis in the first second, before the drives begin.
inline Span first_second(Runs const& runs, std::size_t k, double from = 0.0) {
  return span_of(runs.times(k), runs.history(k, "vertical displacement [m]"), from, 1.0);
}

// Line with the first dip and with the rest position of the chassis at the start of the drives.
inline void drop_line(Lines& lines, std::string const& name, Runs const& runs, std::size_t k) {
  Span const first = first_second(runs, k);
  std::vector<Value> numbers{{"first dip", -1e2 * first.least, 2, "cm"}, {"at", first.at_least, 2, "s"}};
  if (runs.times(k).back() >= 1.0) numbers.push_back({"settled", -1e2 * first_second(runs, k, 0.9).mean, 2, "cm"});
  lines("drop, " + name, numbers);
}

inline void motion_line(Lines& lines, Settings const& o, Runs const& runs, std::size_t k) {
  std::vector<Value> numbers{{"forward", runs.history(k, "forward position [m]").back(), 2, "m"},
                             {"top speed", span_of(runs, k, "forward velocity [m/s]").most, 2, "m/s"}};
  if (o.left == o.right) numbers.push_back({"rolling", rolled(o, runs.times(k).back()), 2, "m"});
  if (k > 0) {
    numbers.push_back({"position apart", 1e3 * most_apart(runs, k, "forward position [m]"), 1, "mm"});
    numbers.push_back({"speed apart", 1e3 * most_apart(runs, k, "forward velocity [m/s]"), 1, "mm/s"});
  }
  lines("motion, " + name_of(runs, k), numbers);
}

// Line with the distance of the path of run k from the path of the first run.
inline void path_line(Lines& lines, Runs const& runs, std::size_t k) {
  PathDistance const off = path_distance(runs, k);
  lines("path, " + name_of(runs, k), {{"taut", 1e3 * off.taut, 1, "mm"}, {"slack", 1e3 * off.slack, 1, "mm"}});
}

// Difference of the filtered force in the watched pin between two runs, for each interval that both runs cover.
inline std::vector<Value> force_differences(Runs const& first, std::size_t k, Runs const& runs, std::size_t run) {
  std::vector<Value> numbers{{"apart", 1e2 * force_difference(first, k, runs, run), 2, "%"},
                             {"Fx apart", 1e2 * force_difference(first, k, runs, run, {"joint force x [N]"}), 2, "%"},
                             {"Fz apart", 1e2 * force_difference(first, k, runs, run, {"joint force z [N]"}), 2, "%"}};
  for (auto const& [name, in] :
       {std::pair{"apart to 10 s", Interval{1.0, 10.0}}, std::pair{"apart from 4 to 6 s", Interval{4.0, 6.0}}})
    if (std::min(first.times(k).back(), runs.times(run).back()) >= in.to - 1e-9)
      numbers.push_back(
          {name, 1e2 * force_difference(first, k, runs, run, {"joint force x [N]", "joint force z [N]"}, in), 2, "%"});
  return numbers;
}

// Force in the watched pin, filtered and unfiltered, and its difference from the first run of `runs`.
inline void force_line(Lines& lines, Runs const& runs, std::size_t k) {
  std::vector<Value> numbers;
  auto const filters = [&](std::size_t run, double least) {  // true if the run is long enough and has equal steps
    return runs.times(run).back() >= least && !runs.comparison.runs[run].run.stopped;
  };
  double const end = runs.times(k).back();
  if (!filters(k, 2.0 / force_cut_off)) return;
  if (k > 0 && filters(0, 4.0) && filters(k, 4.0)) numbers = force_differences(runs, 0, runs, k);
  for (char const* const axis : {"x", "z"}) {
    std::string const output = std::string("joint force ") + axis + " [N]";
    Filtered const f = filtered(runs, k, output, force_cut_off);
    Span const low = span_of(f.times, f.values), raw = span_of(runs, k, output);
    std::string const name = std::string("F") + axis;
    numbers.insert(numbers.end(), {{name + " from", 1e-3 * low.least, 1, "kN"},
                                   {name + " to", 1e-3 * low.most, 1, "kN"},
                                   {"raw " + name + " from", 1e-3 * raw.least, 1, "kN"},
                                   {"raw " + name + " to", 1e-3 * raw.most, 1, "kN"}});
  }
  Filtered const pull = filtered(runs, k, "joint force [N]", force_cut_off);
  Span const from_1 = span_of(pull.times, pull.values, std::min(1.0, 0.5 * end));
  numbers.insert(numbers.end(),
                 {{"pull from", 1e-3 * from_1.least, 1, "kN"}, {"pull to", 1e-3 * from_1.most, 1, "kN"}});
  lines("30 Hz force, " + name_of(runs, k), numbers);
}

inline void gap_line(Lines& lines, Runs const& runs, std::size_t k) {
  Span const watched = span_of(runs, k, "joint gap [m]"), all = span_of(runs, k, "largest joint gap [m]");
  lines("gap, " + name_of(runs, k), {{"most", 1e3 * watched.most, 4, "mm"},
                                     {"mean", 1e3 * watched.mean, 4, "mm"},
                                     {"most of all pins", 1e3 * all.most, 4, "mm"}});
}

// Line with the positions of the links, the depth of contacts, and the speed of the vehicle at the largest depth.
inline void track_line(Lines& lines, Runs const& runs, std::size_t k) {
  Outcome const& out = runs.outcomes[k];
  auto const& t = runs.times(k);
  auto const then =
      std::min(std::size_t(std::lower_bound(t.begin(), t.end(), out.deepest_time) - t.begin()), t.size() - 1);
  lines("track, " + name_of(runs, k),
        {{"deepest contact", 1e3 * out.depth, 2, "mm"},
         {"at", out.deepest_time, 3, "s"},
         {"speed then", runs.history(k, "forward velocity [m/s]")[then], 1, "m/s"},
         {"pins off the path of the start", 1e3 * largest(runs, k, "off the path [m]"), 1, "mm"},
         {"links off their plane", 1e3 * largest(runs, k, "off the middle plane [m]"), 2, "mm"},
         {"joints open", 1e3 * largest(runs, k, "largest joint gap [m]"), 4, "mm"}},
        out.deepest);
}

inline void plateau_line(Lines& lines, Settings const& o, Runs const& runs, std::size_t k) {
  if (runs.times(k).back() <= 10.0 || o.left != o.right) return;
  double const speed = mean_speed(runs, k), rolling = o.speed * m113::rolling_radius;
  lines("plateau, " + name_of(runs, k), {{"speed from 9 s on", speed, 3, "m/s"},
                                         {"rolling", rolling, 3, "m/s"},
                                         {"more", 1e2 * (speed / rolling - 1.0), 1, "%"},
                                         {"top speed", span_of(runs, k, "forward velocity [m/s]").most, 2, "m/s"}});
}

inline void turning_line(Lines& lines, Settings const& o, Runs const& runs, std::size_t k) {
  if (o.left == o.right || runs.times(k).size() < 3) return;
  double const end = runs.times(k).back();
  Turning const turn = turning(o, runs, k, std::min(9.0, 0.9 * end));
  lines("turning, " + name_of(runs, k), {{"rate", turn.rate, 2, "rad/s"},
                                         {"rolling rate", turn.rolling_rate, 2, "rad/s"},
                                         {"radius", turn.radius, 1, "m"},
                                         {"rolling radius", turn.rolling_radius, 1, "m"}});
}

inline void time_line(Lines& lines, Runs const& runs, std::size_t k) {
  auto const &r = runs.comparison.runs[k], &first = runs.comparison.runs[0];
  double const steps = double(std::max(r.run.steps, 1L)), simulated = std::max(r.times.back(), 1e-9);
  lines("time, " + r.name, {{"CPU", r.cpu, 2, "s"},
                            {"of real time", r.cpu / simulated, 2},
                            {"of the first", r.cpu / std::max(first.cpu, 1e-9), 2},
                            {"iterations a step", double(r.run.iterations) / steps, 1},
                            {"factorisations a step", double(r.run.factorisations) / steps, 2}});
}

inline void energy_line(Lines& lines, Runs const& runs, std::size_t k) {
  Outcome const& out = runs.outcomes[k];
  if (out.relative < 0.0) return;
  lines("energy, " + name_of(runs, k), {{"drives", 1e-3 * out.drives, 1, "kJ"},
                                        {"gravity", 1e-3 * out.gravity, 1, "kJ"},
                                        {"kinetic", 1e-3 * out.kinetic, 1, "kJ"},
                                        {"stored", 1e-3 * out.stored, 1, "kJ"},
                                        {"dissipated", 1e-3 * out.dissipated, 1, "kJ"},
                                        {"left", 1e-3 * out.unaccounted, 2, "kJ"},
                                        {"left of the turnover", 1e2 * out.relative, 2, "%"}});
}

// All lines of one run.
inline void run_lines(Lines& lines, Settings const& o, Runs const& runs, std::size_t k) {
  time_line(lines, runs, k);
  track_line(lines, runs, k);
  drop_line(lines, name_of(runs, k), runs, k);
  motion_line(lines, o, runs, k);
  plateau_line(lines, o, runs, k);
  turning_line(lines, o, runs, k);
  if (k > 0) path_line(lines, runs, k);
  force_line(lines, runs, k);
  energy_line(lines, runs, k);
  if (!runs.outcomes[k].trouble.empty()) std::cout << "  " << runs.outcomes[k].trouble << '\n';
}

}  // namespace chapter3
