#include "ensemble.hpp"

#include <polybody/signals/filter.hpp>

#include "measures.hpp"

namespace chapter4 {

namespace {

// Plausible ranges of the data that the thesis does not give. The section of a cable need not give the mass of a rigid
// link: the box with the inertia of Table 3.1 is 1.7 times as high as the section with this mass.
std::vector<std::pair<std::string, Options>> plausible(Options const& o) {
  std::vector<std::pair<std::string, Options>> all{{"as given", o}};
  auto const with = [&](std::string const& name, auto const& change) {
    all.emplace_back(name, o);
    all.back().second.film = nullptr;
    change(all.back().second);
  };
  with("preload 10 kN", [](Options& s) { s.preload = 1e4; });
  with("preload 40 kN", [](Options& s) { s.preload = 4e4; });
  with("ramp of 3.5 s", [](Options& s) { s.ramp = 3.5; });
  with("rho 0", [](Options& s) { s.rho = 0.0; });
  with("rho 0.8, 0.5 ms", [](Options& s) {
    s.rho = 0.8;
    s.step = 0.5e-3;
  });
  with("0.5 ms", [](Options& s) { s.step = 0.5e-3; });
  with("contacts at their places", [](Options& s) { s.contacts = m113::ContactsAct::at_their_places; });
  with("links of half the section", [](Options& s) {
    s.section = 0.5;
    s.masses = m113::with_steel_links(s.masses, section_height(s));
  });
  for (auto const& [name, section] : {std::pair("cables of 1.7 link masses", 1.7),
                                      {"cables of half the mass", 0.5},
                                      {"cables of a third", 1.0 / 3.0}})
    with(name, [&](Options& s) { s.section = section; });
  return all;
}

void print(SettingRuns const& setting) {
  Options const& o = setting.options;
  StressRuns const& r = setting.runs;
  double const from = plateau(r.times(0));
  auto const mean = [&](std::size_t k, std::vector<double> const& x) {
    return 1e5 * span_of(r.times(k), r.filtered(k, x, o.cut_off), from).mean;
  };
  double const a = mean(0, r.raw(0)), b = mean(1, r.raw(1));
  Ranges const of_a = ranges_of(cycles_of(r.raw(0))), of_b = ranges_of(cycles_of(r.raw(1)));
  std::printf("%-26s %9.3f %9.3f %9.3f %8.3f %9.2f %9.2f %8.2f, %8.2f %8.3f, %8.3f\n", setting.name.c_str(), a,
              mean(0, r.vibrating(0)), b, a / b, 1e2 * off(o, r, 0, r, 1, std::min(1.0, 0.25 * o.end_time)),
              1e2 * off(o, r, 0, r, 0, from, &StressRuns::vibrating, &StressRuns::raw), 1e-6 * of_a.largest,
              1e-6 * of_b.largest, 1e-6 * of_a.equivalent, 1e-6 * of_b.equivalent);
  std::fflush(stdout);
}

void print_heads(Options const& o) {
  std::printf(
      "%g rad/s, %g s; from 8.5 s on, or half of the run: strain, low pass %g Hz, in the mean [1e-5]: decoupled, "
      "by vibrations, coupled (ANCF cables); their ratio; rms differences; ranges of stress, unfiltered [MPa]\n",
      o.speed, o.end_time, o.cut_off);
  std::printf("%-26s %9s %9s %9s %8s %9s %9s %18s %18s\n", "", "decoupled", "vibrating", "coupled", "ratio", "off [%]",
              "vib. [%]", "largest", "equivalent");
}

}  // namespace

Filtered filtered_strain(StressRuns const& runs, std::size_t k, double cut_off) {
  auto const times = runs.filtered_times(k);
  return {{times.begin(), times.end()}, runs.filtered(k, cut_off)};
}

std::vector<SettingRuns> runs_of_settings(Options const& o) {
  print_heads(o);
  std::vector<SettingRuns> all;
  auto const add = [&](std::string const& name, Options const& setting, StressRuns runs) {
    all.push_back({name, setting, std::move(runs)});
    print(all.back());
  };
  for (auto const& [name, setting] : plausible(o))
    add(name, setting, run(setting, {combination(setting, "rigid"), combination(setting, "ancf")}));
  // The run by Adams has rigid links only, because cables would need steps of less than a microsecond. The cables in
  // its results are those of the first setting.
  Options adams = o;
  adams.film = nullptr;
  adams.selection.integrators = {"adams"};
  StressRuns by_adams = run_of(adams, combination(adams, "rigid"), "rigid, Adams");
  StressRuns const& given = all.front().runs;
  by_adams.comparison.runs.push_back(given.comparison.runs[1]);
  by_adams.outcomes.push_back(given.outcomes[1]);
  by_adams.links.push_back(given.links[1]);
  add("rigid links by Adams", o, std::move(by_adams));
  return all;
}

Band::Band(std::vector<SettingRuns> const& settings, std::function<Filtered(SettingRuns const&)> const& history) {
  double const step = settings.front().options.step;
  for (SettingRuns const& setting : settings) {
    Filtered const h = history(setting);
    std::vector<double> const x = resampled(h.times, h.values, step, 2.5 * step);
    for (std::size_t i = times_.size(); i < x.size(); ++i) {
      times_.push_back(h.times.front() + double(i) * step);
      least_.push_back(x[i]);
      most_.push_back(x[i]);
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
      least_[i] = std::min(least_[i], x[i]);
      most_[i] = std::max(most_[i], x[i]);
    }
  }
}

Curve Band::curve(std::string label, int colour, double scale, std::size_t every) const {
  Curve c{.label = std::move(label), .style = "filled", .colour = colour};
  auto const add = [&](std::size_t i, std::vector<double> const& y) {
    c.x.push_back(times_[i]);
    c.y.push_back(scale * y[i]);
  };
  std::size_t const last = (times_.size() - 1) / every;
  for (std::size_t i = 0; i <= last; ++i) add(i * every, most_);
  for (std::size_t i = last + 1; i-- > 0;) add(i * every, least_);
  return c;
}

void ensemble(Options const& o) {
  std::vector<SettingRuns> const settings = runs_of_settings(o);
  Figure f{.title = "Axial strain of a link, " + number(o.speed) + " rad/s, " + number(o.cut_off) +
                    " Hz low pass: the range over settings",
           .x_label = "t [s]",
           .y_label = "axial strain [10⁻⁵]",
           .x_range = {{0.0, o.end_time}}};
  std::vector<int> const colours = formulation_colours(settings.front().runs.comparison);
  char const* const names[] = {"rigid, decoupled", "ANCF cables"};
  for (std::size_t k = 0; k < 2; ++k)
    f.curves.push_back(Band(settings, [&](SettingRuns const& s) {
                         return filtered_strain(s.runs, k, o.cut_off);
                       }).curve(names[k], colours[k], 1e5));
  draw(o, f, "ensemble");
}

void compare_stiffnesses(Options o) {
  std::printf(
      "%g rad/s, %g s; from half of the run on, or the plateau: strain times E/(steel's E), low pass %g Hz, in the "
      "mean [1e-5]: decoupled and coupled (ANCF cables); their ratio; rms difference; position at the end, apart\n",
      o.speed, o.end_time, o.cut_off);
  std::printf("%-12s %12s %9s %9s %8s %9s %11s\n", "E/steel's E", "EA/p [MN/m]", "decoupled", "coupled", "ratio",
              "off [%]", "apart [mm]");
  for (double const young : {1.0, 1e-1, 1e-2, 3e-3, 1e-3, 3e-4}) {
    o.young = young;
    StressRuns const r = run(o, {combination(o, "rigid"), combination(o, "ancf")});
    double const from = plateau(r.times(0));
    auto const force_like = [&](std::size_t k) {
      return 1e5 * young * span_of(r.times(k), r.filtered(k, o.cut_off), from).mean;
    };
    double const axial = 1e-6 * young * constants(m113::link_bar({}, section_height(o))).EA / m113::pitch;
    std::printf(
        "%-12g %12.2f %9.4f %9.4f %8.4f %9.2f %11.2f\n", young, axial, force_like(0), force_like(1),
        force_like(0) / force_like(1), 1e2 * off(o, r, 0, r, 1, from),
        1e3 * std::abs(r.history(1, "forward position [m]").back() - r.history(0, "forward position [m]").back()));
    std::fflush(stdout);
  }
}

}  // namespace chapter4
