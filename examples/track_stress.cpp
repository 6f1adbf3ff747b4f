// Stress of a track link (Chapter 4, Figures 4.3 to 4.12): decoupled, after a run with rigid links, and coupled, in
// runs with flexible links.
//   track_stress --body ffr --speed 80
//   track_stress --body ffr --policy joint-coordinates --turn curve     # --list: the combinations
//   track_stress --compare
//   track_stress --compare matrix
//   track_stress --compare surface
//   track_stress --figure 4.8
//   track_stress --compare pair --viewer build/release/polybody_viewer.html

#include <cctype>
#include <map>

#include "m113/link_strain.hpp"
#include "support/vehicle_film.hpp"
#include "track_stress/ensemble.hpp"
#include "track_stress/measures.hpp"

using namespace chapter4;

namespace {

// Stores runs that several figures share.
class Cache {
 public:
  explicit Cache(Options const& o) : options_(o) {}
  bool has(double speed) const {
    return std::ranges::any_of(runs_, [&](auto const& made) { return made.first.first == speed; });
  }
  // Runs with the settings of the options. With `bands`, also runs with other values of data that the thesis does not
  // give.
  std::vector<SettingRuns> const& at(double speed, double end_time) {
    auto const key = std::pair(speed, end_time);
    if (auto const found = runs_.find(key); found != runs_.end()) return found->second;
    Options o = options_;
    o.speed = speed;
    o.end_time = end_time;
    if (!runs_.empty()) o.film = nullptr;
    if (o.bands) return runs_.emplace(key, runs_of_settings(o)).first->second;
    SettingRuns as_given{"as given", o, run(o, {combination(o, "rigid"), combination(o, "ancf")})};
    return runs_.emplace(key, std::vector{std::move(as_given)}).first->second;
  }

 private:
  Options const& options_;
  std::map<std::pair<double, double>, std::vector<SettingRuns>> runs_;
};

// Mean tension of the track from the force of the tensioner's spring, without the damper [N]. Both runs of the track
// are assumed to leave the idler horizontally.
double mean_pull(Options const& o, StressRuns const& runs, std::size_t k, double from) {
  double const travel = span_of(runs.times(k), runs.history(k, "idler travel [m]"), from).mean;
  return 0.5 * (o.preload + m113::tensioner.stiffness * travel);
}

// Prints the decoupled and the coupled strain after a low-pass filter, from the start of the plateau on, and their
// largest difference.
void print_strains(Options const& o, StressRuns const& r, double speed) {
  auto const &times = r.times(0), &other_times = r.times(1);
  double const from = plateau(times);
  std::vector<double> const rigid = r.filtered(0, o.cut_off), flexible = r.filtered(1, o.cut_off);
  double apart = 0.0;
  for (std::size_t i = 0; i < std::min(rigid.size(), flexible.size()); ++i)
    if (times[i] >= from) apart = std::max(apart, std::abs(rigid[i] - flexible[i]));
  Span const a = span_of(times, rigid, from), b = span_of(other_times, flexible, from);
  std::printf(
      "%g rad/s, from %.1f to %.1f s, low pass %g Hz: rigid %.3fe-5, %.3f MPa; ancf %.3fe-5, %.3f MPa; at most %.3f "
      "MPa apart; (T0 + m v^2/p)/EA %.3fe-5\n",
      speed, from, times.back(), o.cut_off, 1e5 * a.mean, 1e-6 * m113::youngs_modulus * a.mean, 1e5 * b.mean,
      1e-6 * m113::youngs_modulus * b.mean, 1e-6 * m113::youngs_modulus * apart,
      1e5 * m113::running_strain(mean_speed(r, 0, from), mean_pull(o, r, 0, from)));
}

// Draws the range over several settings behind the curves of rigid links and cables.
void add_bands(Figure& f, std::vector<SettingRuns> const& settings, double scale, std::size_t every,
               std::function<Filtered(SettingRuns const&, std::size_t)> const& history) {
  if (settings.size() < 2) return;
  std::vector<Curve> behind;
  std::vector<int> const colours = formulation_colours(settings.front().runs.comparison);
  for (std::size_t k = 0; k < 2; ++k)
    behind.push_back(
        Band(settings, [&](SettingRuns const& s) {
          return history(s, k);
        }).curve(k == 0 ? "rigid, range over settings" : "ANCF, range over settings", colours[k], scale, every));
  f.curves.insert(f.curves.begin(), behind.begin(), behind.end());
}

void report_bending(StressRuns const& runs, std::size_t k) {
  double const young = 1e-6 * m113::youngs_modulus, from = plateau(runs.times(k)), end = runs.times(k).back();
  Span const bending = span_of(runs.times(k), runs.bending(k), from);
  std::printf("           stress by bending in the middle, unfiltered: %.2f to %.2f MPa, rms from 1 s on %.2f MPa",
              young * bending.least, young * bending.most, young * rms(runs.times(k), runs.bending(k), 1.0));
  if (k > 0 && runs.links[0]->decoupled && end > 3.0)
    std::printf("; off %s by %.1f %% to 3 s, %.1f %% after", runs.name(0).c_str(),
                1e2 * off_unfiltered(runs, k, 0, &StressRuns::bending, 1.0, 3.0),
                1e2 * off_unfiltered(runs, k, 0, &StressRuns::bending, 3.0, end));
  std::printf("\n");
}

void report(Options const& o, StressRuns const& runs) {
  std::printf("%g rad/s, %g s, steps of %g ms, rho %g; strain of left link %d, low pass %g Hz\n", o.speed, o.end_time,
              1e3 * o.step, o.rho, watched_link, o.cut_off);
  std::size_t const last = runs.comparison.runs.size() - 1;
  std::size_t beside = 0;  // index of the ANCF cables if they are among the runs, else 0
  for (std::size_t k = 0; k <= last; ++k)
    if (runs.name(k) == "ancf") beside = k;
  for (std::size_t k = 0; k <= last; ++k) {
    auto const& r = runs.comparison.runs[k];
    double const from = plateau(runs.times(k)), speed = mean_speed(runs, k, from), pull = mean_pull(o, runs, k, from);
    std::vector<double> const strain = runs.filtered(k, o.cut_off);
    Span const e = span_of(runs.times(k), strain, from), raw = span_of(runs.times(k), runs.raw(k), from);
    std::printf(
        "%-10s from %.1f s on: speed %.4f m/s; strain %.3fe-5 (%.3f to %.3f), %.3f MPa; unfiltered %.2f to %.2fe-5\n",
        r.name.c_str(), from, speed, 1e5 * e.mean, 1e5 * e.least, 1e5 * e.most, 1e-6 * m113::youngs_modulus * e.mean,
        1e5 * raw.least, 1e5 * raw.most);
    double const mass = runs.links[k]->decoupled ? o.masses.link.mass : flexible_mass(o);
    std::printf("           (T0 + m v^2/p)/EA with T0 = %.2f kN of the tensioner: %.3fe-5\n", 1e-3 * pull,
                1e5 * m113::running_strain(speed, pull, section_height(o), mass));
    Span const force = span_of(runs.times(k), runs.history(k, "joint force x [N]"), 0.0);
    std::printf(
        "           at the end %.4f m ahead; at most %.3f m/s; longitudinal force in the front pin %.1f to %.1f kN\n",
        runs.history(k, "forward position [m]").back(),
        span_of(runs.times(k), runs.history(k, "forward velocity [m/s]"), 0.0).most, 1e-3 * force.least,
        1e-3 * force.most);
    report_bending(runs, k);
    for (double const since : {1.0, from})
      if (k != beside && since < runs.times(k).back())
        std::printf("           off %s: %.2f %% (rms from %.1f s on)\n", runs.name(beside).c_str(),
                    1e2 * off(o, runs, k, runs, beside, since), since);
    std::printf("           CPU %.1f s, %.2f of %s", r.cpu, r.cpu / runs.comparison.runs.front().cpu,
                runs.name(0).c_str());
    if (runs.links[k]->decoupled)
      std::printf("; record %.2f s, recovery %.2f s, vibrations %.2f s", runs.links[k]->recording,
                  runs.links[k]->recovery, runs.links[k]->vibration);
    std::printf("; %.2f iterations, %.2f factorisations a step; %ld of %ld steps halved\n",
                double(r.run.iterations) / double(r.run.steps), double(r.run.factorisations) / double(r.run.steps),
                r.run.rejected, r.run.steps);
    if (runs.links[k]->decoupled)
      std::printf("           strain by vibrations, low pass: %.2f %% off that without (rms from %.1f s on)\n",
                  1e2 * off(o, runs, k, runs, k, from, &StressRuns::vibrating, &StressRuns::raw), from);
    Outcome const& out = runs.outcomes[k];
    if (out.relative >= 0.0)
      std::printf("           energy: drives %.1f kJ, gravity %.1f kJ; %.3f %% not accounted for\n", 1e-3 * out.drives,
                  1e-3 * out.gravity, 1e2 * out.relative);
    if (!out.trouble.empty()) std::printf("           %s\n", out.trouble.c_str());
  }
}

// Legend entry of the run.
std::string label_of(StressRuns const& runs, std::size_t k) {
  return runs.links[k]->decoupled ? "rigid, decoupled" : links_in_words(runs.name(k));
}

Figure bending_figure(Options const& o, StressRuns const& runs) {
  Figure f{.title = "Stress by bending in the middle of a link, " + number(o.speed) + " rad/s",
           .x_label = "t [s]",
           .y_label = "stress [MPa]",
           .x_range = {{0.95 * o.end_time, o.end_time}}};
  std::vector<int> const colours = formulation_colours(runs.comparison);
  for (std::size_t k = 0; k < runs.comparison.runs.size(); ++k)
    f.curves.push_back(
        curve(label_of(runs, k), runs.times(k), runs.bending(k), colours[k], 1e-6 * m113::youngs_modulus, 1));
  return f;
}

Figure strain_figure(Options const& o, StressRuns const& runs, std::string title, bool filter, double from, double to) {
  Figure f{.title = std::move(title), .x_label = "t [s]", .y_label = "axial strain [10⁻⁵]", .x_range = {{from, to}}};
  std::size_t const count = runs.comparison.runs.size();
  std::vector<int> const colours = formulation_colours(runs.comparison);
  for (std::size_t k = 0; k < count; ++k) {
    f.curves.push_back(curve(label_of(runs, k), runs.times(k), filter ? runs.filtered(k, o.cut_off) : runs.raw(k),
                             colours[k], 1e5, filter ? 4 : 1));
    f.curves.back().width = k == 0 ? 3.0 : 1.2;
  }
  for (std::size_t k = 0; k < count; ++k)
    if (std::vector<double> const& x = runs.vibrating(k); !x.empty()) {
      f.curves.push_back(curve("rigid, vibrating", runs.times(k), filter ? runs.filtered(k, x, o.cut_off) : x,
                               colours[k], 1e5, filter ? 4 : 1));
      f.curves.back().width = 1.2;
      f.curves.back().style = "dashed";
    }
  return f;
}

bool wanted(Options const& o, std::string const& figure) { return o.figure == "all" || o.figure == figure; }

void figures(Options const& o) {
  Cache cache(o);
  double const end_time = std::min(o.end_time, 10.0), twice = 2.0 * end_time;
  bool const longer = wanted(o, "4.11") || wanted(o, "4.12");
  auto const [slow, fast] = m113::fast_sprocket_velocities;
  std::string const filter = ", " + number(o.cut_off) + " Hz low pass";
  auto const runs_at = [&](double speed) -> std::vector<SettingRuns> const& {
    return cache.at(speed, speed == slow && longer ? twice : end_time);
  };
  auto const name_of = [](std::string number) {
    std::replace(number.begin(), number.end(), '.', '_');
    return "figure_" + number;
  };
  auto const history = [&](std::string const& number, double speed, std::string const& output, std::string const& what,
                           std::string const& label, double scale = 1.0) {
    std::vector<SettingRuns> const& settings = runs_at(speed);
    Figure f =
        history_figure(settings.front().runs, output,
                       "Figure " + number + ": " + what + ", " + polybody::number(speed) + " rad/s", label, 0.0, scale);
    for (std::size_t k = 0; k < f.curves.size(); ++k) f.curves[k].label = k == 0 ? "rigid links" : "ANCF links";
    add_bands(f, settings, scale, 1, [&](SettingRuns const& s, std::size_t k) {
      return Filtered{s.runs.times(k), s.runs.history(k, output)};
    });
    f.x_range = {{0.0, end_time}};
    draw(o, f, name_of(number));
  };
  auto const strain = [&](std::string const& number, double speed, bool filtered, double from, double to) {
    std::vector<SettingRuns> const& settings = runs_at(speed);
    Figure f = strain_figure(o, settings.front().runs,
                             "Figure " + number + ": axial strain of a link, " + polybody::number(speed) + " rad/s" +
                                 (filtered ? filter : ""),
                             filtered, from, to);
    add_bands(f, settings, 1e5, filtered ? 4 : 1, [&](SettingRuns const& s, std::size_t k) {
      return filtered ? filtered_strain(s.runs, k, o.cut_off) : Filtered{s.runs.times(k), s.runs.raw(k)};
    });
    return f;
  };
  for (auto const& [speed, letter] : {std::pair(slow, "a"), {fast, "b"}}) {
    if (wanted(o, "4.3")) {
      Figure f{.title = "Figure 4.3" + std::string(letter) + ": sprocket angular velocity",
               .x_label = "t [s]",
               .y_label = "angular velocity [rad/s]"};
      Curve c;
      for (int i = 0; i <= 1000; ++i) {
        c.x.push_back(0.01 * i);
        c.y.push_back(m113::drive(speed, 0.1)(0.01 * i).value);
      }
      f.curves.push_back(c);
      draw(o, f, name_of(std::string("4.3") + letter));
    }
    if (wanted(o, "4.4"))
      history(std::string("4.4") + letter, speed, "forward position [m]", "chassis forward position", "position [m]");
    if (wanted(o, "4.5"))
      history(std::string("4.5") + letter, speed, "forward velocity [m/s]", "chassis forward velocity",
              "velocity [m/s]");
  }
  if (wanted(o, "4.6")) draw(o, strain("4.6", slow, false, 0.0, end_time), name_of("4.6"));
  if (wanted(o, "4.7")) history("4.7", slow, "joint force x [N]", "longitudinal joint force", "force [kN]", 1e-3);
  if (wanted(o, "4.8")) draw(o, strain("4.8", slow, true, 0.0, end_time), name_of("4.8"));
  if (wanted(o, "4.9")) draw(o, strain("4.9", fast, false, 0.0, end_time), name_of("4.9"));
  if (wanted(o, "4.10")) draw(o, strain("4.10", fast, true, 0.0, end_time), name_of("4.10"));
  if (wanted(o, "4.11")) draw(o, strain("4.11", slow, true, end_time, twice), name_of("4.11"));
  if (wanted(o, "4.12")) {
    Figure f = strain("4.12", slow, true, end_time, twice);
    f.title = "Figure 4.12: axial stress of a link, " + number(slow) + " rad/s" + filter;
    f.y_label = "axial stress [MPa]";
    for (Curve& c : f.curves)
      for (double& y : c.y) y *= 1e-11 * m113::youngs_modulus;
    draw(o, f, name_of("4.12"));
  }
  for (double const speed : {slow, fast})
    if (cache.has(speed)) print_strains(o, runs_at(speed).front().runs, speed);
}

// Cycles of the unfiltered axial stress by rainflow counting. The damage of a cycle is S³ for the range S (exponent 3
// of weld details). Cycles that all have the equivalent range cause the same damage.
void fatigue(Options const& o, StressRuns const& runs) {
  Figure f{.title = "Ranges of axial stress, " + number(o.speed) + " rad/s",
           .x_label = "range [MPa]",
           .y_label = "cycles in " + number(o.end_time) + " s",
           .log_y = true};
  std::vector<int> const colours = formulation_colours(runs.comparison);
  for (std::size_t k = 0; k < runs.comparison.runs.size(); ++k) {
    auto const cycles = cycles_of(runs.raw(k));
    if (cycles.empty()) continue;
    Ranges const r = ranges_of(cycles);
    std::printf("%-10s %.0f cycles, the largest range %.2f MPa, the equivalent range %.3f MPa\n", runs.name(k).c_str(),
                r.count, 1e-6 * r.largest, 1e-6 * r.equivalent);
    double const width = 0.25e6;
    std::vector<double> bins = binned(cycles, width);
    bins.push_back(bins.back());
    Curve c{.label = label_of(runs, k), .style = "steps", .colour = colours[k]};
    for (std::size_t i = 0; i < bins.size(); ++i) {
      c.x.push_back(1e-6 * width * double(i));
      c.y.push_back(bins[i]);
    }
    f.curves.push_back(c);
  }
  if (!f.curves.empty()) draw(o, f, "stress_ranges");
}

void compare_steps(Options const& o, StressRuns const& coarse, StressRuns const& fine) {
  double const from = std::min(1.0, 0.25 * o.end_time);
  std::printf("%s, steps of %g and %g ms: filtered strain %.2f %% apart (rms from %.2g s on); CPU %.1f and %.1f s\n",
              coarse.name(0).c_str(), 1e3 * o.step, 0.5e3 * o.step, 1e2 * off(o, fine, 0, coarse, 0, from), from,
              coarse.comparison.runs[0].cpu, fine.comparison.runs[0].cpu);
}

void show(Options const& o, StressRuns const& r) {
  report(o, r);
  if (o.fatigue) fatigue(o, r);
  draw(o, strain_figure(o, r, "Axial strain of a link", false, 0.0, o.end_time), "strain");
  draw(o, bending_figure(o, r), "bending");
  draw(o, strain_figure(o, r, "Axial strain of a link, " + number(o.cut_off) + " Hz low pass", true, 0.0, o.end_time),
       "strain_filtered");
}

void single(Options const& o) {
  std::vector<Combination> const chosen = selected(o, "ancf");
  if ((o.restart || o.halve) && chosen.size() > 1)
    throw InvalidInput{"--restart and --halve run one combination, but ", ErrorValue{chosen.size()}, " are selected."};
  if (o.restart) return restart(o, chosen.front());
  StressRuns const runs = run(o, chosen);
  if (!o.halve) return show(o, runs);
  Options half = o;
  half.step = 0.5 * o.step;
  compare_steps(o, runs, run(half, chosen));
}

// Links of --compare matrix.
std::vector<std::string> const matrix_links{"rigid", "ancf", "ffr", "fe", "lrvf", "se3", "beam", "continuum"};

// Results of the run of one combination; strain, force and constraint violation from the plateau on.
struct Cell {
  double forward = 0.0;  // position at the end [m]
  double strain = 0.0;   // mean filtered strain of the watched link [1]
  double force = 0.0;    // largest force in the front pin of this link [N]
  double gap = 0.0;      // largest constraint violation of all pins [m]
  double energy = 0.0;   // share of the energy that is not accounted for [1]
  double turning = 0.0;  // mean yaw rate [rad/s]
};

Cell cell_of(Options const& o, Combination const& c) {
  StressRuns const r = run(o, {c});
  auto const& one = r.comparison.runs[0];
  double const from = plateau(r.times(0));
  std::vector<double> const strain = r.filtered(0, o.cut_off);
  Cell const cell{.forward = r.history(0, "forward position [m]").back(),
                  .strain = span_of(r.times(0), strain, from).mean,
                  .force = span_of(r.times(0), r.history(0, "joint force [N]"), from).most,
                  .gap = span_of(r.times(0), r.history(0, "largest joint gap [m]"), from).most,
                  .energy = r.outcomes[0].relative,
                  .turning = yaw_rate(r, 0, from)};
  std::printf("%-10s %-17s %6td %5td %8.1f %6.2f %6.3f %11.4f %9.3f %9.2f %9.2e %9.3f", c.links.body.name.c_str(),
              c.links.policy.c_str(), one.problem_size.velocities, one.problem_size.rows, one.cpu,
              double(one.run.iterations) / double(one.run.steps),
              double(one.run.factorisations) / double(one.run.steps), cell.forward, 1e5 * cell.strain,
              1e-3 * cell.force, cell.gap, 1e2 * cell.energy);
  if (!o.turn.empty()) std::printf(" %13.5f", cell.turning);
  std::printf("\n");
  if (!r.outcomes[0].trouble.empty()) std::printf("           %s\n", r.outcomes[0].trouble.c_str());
  std::fflush(stdout);
  return cell;
}

// Largest difference between the cells.
double spread(std::vector<Cell> const& cells, double Cell::* of) {
  auto const [least, most] =
      std::minmax_element(cells.begin(), cells.end(), [&](Cell const& a, Cell const& b) { return a.*of < b.*of; });
  return (*most).*of - (*least).*of;
}

void show_spreads(Options const& o, std::vector<Cell> const& cells) {
  double mean = 0.0, energy = 0.0;
  for (Cell const& c : cells) {
    mean += c.strain / double(cells.size());
    energy = std::max(energy, c.energy);
  }
  std::printf(
      " Forward positions within %.2f mm, strains within %.2f %% of one another; at most %.3f %% of the energy is not "
      "accounted for.\n",
      1e3 * spread(cells, &Cell::forward), 1e2 * spread(cells, &Cell::strain) / mean, 1e2 * energy);
  if (!o.turn.empty())
    std::printf("Yaw rates within %.2f %% of that of %s links.\n",
                1e2 * spread(cells, &Cell::turning) / std::abs(cells.front().turning), matrix_links.front().c_str());
}

// Runs every combination of the links above and of pins.
void matrix(Options o) {
  o.audit = true;
  std::printf(
      "%g rad/s, %g s, steps of %g ms, rho %g; pins of %g N/m where they yield; from half of the run on, or the "
      "plateau: strain of left link %d (low pass %g Hz), largest force in its front pin, largest gap of a pin\n",
      o.speed, o.end_time, 1e3 * o.step, o.rho, m113::pin_stiffness, watched_link, o.cut_off);
  std::printf("%-10s %-17s %6s %5s %8s %6s %6s %11s %9s %9s %9s %9s%s\n", "links", "pins", "speeds", "rows", "CPU [s]",
              "iter.", "fact.", "forward [m]", "strain e-5", "force [kN]", "gap [m]", "energy [%]",
              o.turn.empty() ? "" : "    yaw [rad/s]");
  std::vector<Cell> cells;
  int refused = 0;
  std::size_t const integrator = combination(o, "rigid").integrator;
  for (LinksOnPins const& links : all_links()) {
    if (std::find(matrix_links.begin(), matrix_links.end(), links.body.name) == matrix_links.end()) continue;
    std::string const why = o.turn.empty() || links.turns || !links.refusals[integrator].empty()
                                ? links.refusals[integrator]
                                : "The slope vector that neighbouring links share at a pin is constant in world axes.";
    if (why.empty()) {
      cells.push_back(cell_of(o, {links, integrator}));
      continue;
    }
    ++refused;
    std::printf("%-10s %-17s cannot be: %s\n", links.body.name.c_str(), links.policy.c_str(), why.c_str());
  }
  std::printf("%zu run, %d cannot be.", cells.size(), refused);
  show_spreads(o, cells);
}

// Effect of each simplification of the floating frame on the watched link, compared with the full equations.
void compare_terms(Options o) {
  o.audit = true;
  std::vector<std::pair<char const*, FfrTerms>> const variants{
      {"all terms", {}},
      {"no m_rf", {.coupling = false}},
      {"no m_rf in the rows of the frame", {.onto_frame = false}},
      {"J and c of the link without deformation", {.deformed_inertia = false}},
      {"no velocity forces of the deformation on the frame", {.frame_velocities = false}},
      {"no Coriolis forces, 2 S1 q'", {.coriolis = false}},
      {"no centrifugal forces by the deformation, S2 q", {.centrifugal = false}},
      {"no centrifugal forces on the link as it is, I0 w", {.spin = false}},
      {"only m_fr q_r'' and I0 w, assumptions 1 to 4",
       {.onto_frame = false,
        .deformed_inertia = false,
        .frame_velocities = false,
        .coriolis = false,
        .centrifugal = false}},
      {"none of these",
       {.coupling = false,
        .onto_frame = false,
        .deformed_inertia = false,
        .frame_velocities = false,
        .coriolis = false,
        .centrifugal = false,
        .spin = false}}};
  std::printf("%g rad/s, %g s, steps of %g ms, rho %g; left link %d, from half of the run on, or the plateau\n",
              o.speed, o.end_time, 1e3 * o.step, o.rho, watched_link);
  std::printf("%-52s %10s %9s %9s %9s %10s\n", "floating frames with", "strain e-5", "off [%]", "raw [%]", "bend. [%]",
              "energy [%]");
  Combination const c = combination(o, "ffr", o.policy());
  StressRuns whole;
  for (auto const& [name, terms] : variants) {
    o.terms = terms;
    StressRuns const r = run(o, {c});
    if (whole.links.empty()) whole = r;
    double const from = plateau(r.times(0));
    auto const unfiltered = [&](Told of) {
      RmsDifference d(from, o.end_time);
      d.add({r.times(0), (r.*of)(0)}, {whole.times(0), (whole.*of)(0)});
      return d.value();
    };
    std::printf("%-52s %10.4f %9.4f %9.4f %9.4f %10.4f\n", name,
                1e5 * span_of(r.times(0), r.filtered(0, o.cut_off), from).mean, 1e2 * off(o, r, 0, whole, 0, from),
                1e2 * unfiltered(&StressRuns::raw), 1e2 * unfiltered(&StressRuns::bending),
                1e2 * r.outcomes[0].relative);
    std::fflush(stdout);
  }
}

// Stress at named nodes of a finite element link: decoupled, after a run with rigid links, and coupled, in a run with
// finite element links.
void surface_stress(Options o) {
  o.surface = true;
  o.contacts = m113::ContactsAct::at_their_places;
  StressRuns const r = run(o, {combination(o, "rigid"), combination(o, "fe", o.policy())});
  report(o, r);
  double const from = plateau(r.times(0));
  std::printf(
      "von Mises stress [MPa] from %.1f s on, unfiltered: in the mean and at most, decoupled and coupled; their "
      "difference as the root mean square, from 1 s on and from then on, and of what passes %g Hz\n",
      from, o.cut_off);
  for (auto const& [name, decoupled] : r.links[0]->surface) {
    auto const& coupled = r.links[1]->surface.at(name);
    Span const a = span_of(r.times(0), decoupled, from), b = span_of(r.times(1), coupled, from);
    auto const apart = [&](double since) {
      RmsDifference d(since, o.end_time);
      d.add({r.times(0), decoupled}, {r.times(1), coupled});
      return 1e2 * d.value();
    };
    RmsDifference slow(from, o.end_time);
    slow.add({r.filtered_times(0), r.filtered(0, decoupled, o.cut_off)},
             {r.filtered_times(1), r.filtered(1, coupled, o.cut_off)});
    std::printf("%-28s %7.3f %7.3f %8.3f %8.3f %8.2f %% %8.2f %% %8.2f %%\n", name.c_str(), 1e-6 * a.mean,
                1e-6 * b.mean, 1e-6 * a.most, 1e-6 * b.most, apart(std::min(1.0, 0.25 * o.end_time)), apart(from),
                1e2 * slow.value());
    Figure f{.title = "Von Mises stress, " + name + ", " + number(o.speed) + " rad/s",
             .x_label = "t [s]",
             .y_label = "stress [MPa]",
             .x_range = {{0.95 * o.end_time, o.end_time}}};
    f.curves = {curve("rigid, decoupled", r.times(0), decoupled, 0, 1e-6, 1),
                curve("finite element link", r.times(1), coupled, 1, 1e-6, 1)};
    std::string file = "von_mises_" + name;
    for (char& letter : file)
      if (!std::isalnum(static_cast<unsigned char>(letter))) letter = '_';
    draw(o, f, file);
  }
}

std::vector<Combination> of_bodies(Options const& o, std::vector<std::string> const& bodies) {
  std::vector<Combination> all;
  for (std::string const& body : bodies) all.push_back(combination(o, body));
  return all;
}

void side_by_side(Options const& o, std::vector<Combination> const& combinations) {
  StressRuns const r = run(o, combinations);
  write_report(r.comparison, o.out / "comparison", !o.no_plot);
  report(o, r);
  if (o.fatigue) fatigue(o, r);
  draw(o, bending_figure(o, r), "bending");
  draw(o,
       strain_figure(o, r,
                     "Axial strain of a link, " + number(o.speed) + " rad/s, " + number(o.cut_off) + " Hz low pass",
                     true, 0.0, o.end_time),
       "strain_filtered");
}

// Throws InvalidInput for options that the selected runs do not have.
void check(Options const& o) {
  bool const own_pins = o.compare != "terms" && o.compare != "surface" && !o.compare.empty();
  if (is_of_combinations(o, o.compare)) return;
  if ((!o.selection.bodies.empty() && (!o.figure.empty() || !o.compare.empty())) ||
      (!o.selection.policies.empty() && (!o.figure.empty() || own_pins)))
    throw InvalidInput(
        "--figure and --compare have their own links and pins; only --compare terms and --compare surface accept "
        "--policy. Omit --body and --policy, or use single runs or --compare combinations.");
}

// A film shows one run, or rigid links beside cables.
void open_film(Options& o) {
  if (!o.viewer.empty() && o.film_file.empty()) o.film_file = o.out / "film.html";
  if (o.film_file.empty()) return;
  if (o.compare == "matrix" || o.compare == "terms" || o.compare == "surface" || o.compare == "stiffness" || o.halve ||
      o.restart)
    throw InvalidInput(
        "A film shows one run, or rigid links beside cables: --film and --viewer can be combined with --body, "
        "--figure, --compare links, --compare pair and --compare ensemble.");
  o.film = vehicle_film(o.viewer, "The tracked vehicle M113 of the thesis: stress of its links");
  if (!o.figure.empty()) o.film_until = std::min(o.end_time, 10.0);
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  double step = 0.0;
  std::string contacts = "middle";
  CommandLine line{
      "Stress of a track link after a run with rigid links (decoupled) and in runs with flexible links (Chapter 4)."};
  add_combination_options(
      line, o,
      {.body = "body formulation of the links, or a list such as rigid,ffr (default: ancf)",
       .policy = "policy of the pins, or a list (default: ancf-linear for ancf, ancf-engineering, beam and continuum, "
                 "else constraint)"});
  line.one_of("--compare", &o.compare,
              {"links", "pair", "matrix", "terms", "surface", "ensemble", "stiffness", "combinations", "steps"},
              "links: all links except fe, each on its usual pins; pair: rigid and ancf; matrix: every link on "
              "every pin; terms: ffr without "
              "parts of its equations; surface: stress at nodes of fe, decoupled and coupled; "
              "ensemble: rigid and ancf with other values of data that the thesis does not give; "
              "stiffness: rigid and ancf with links of other stiffnesses; combinations: the "
              "selected ones at equal error; steps: ten steps of every combination",
              "links");
  line.one_of("--contacts", &contacts, {"middle", "places"},
              "points of a link at which contact forces act: all at its middle, or each at its contact point");
  line.option("--link-files", &o.files, "folder of the finite element link's files");
  line.one_of("--turn", &o.turn, {"pivot", "curve"},
              "pivot: the right track runs backwards; curve: the right track runs at 0.8 of the speed");
  line.flag("--bumps", &o.bumps, "ground with three bumps");
  line.option("--figure", &o.figure, "figure 4.3 to 4.12 of the thesis, or all");
  line.option("--speed", &o.speed, "speed of the sprockets after 8 s [rad/s]");
  line.positive("--until", &o.end_time, "end of the run [s]");
  line.positive(
      "--step", &step,
      "step [s], for adams and dormand-prince the longest step; if omitted, 1 ms, or for runge-kutta a step at "
      "which the pins are stable");
  line.between("--rho", &o.rho, 0.0, 1.0, "spectral radius at infinity of the integrator");
  line.positive("--cut-off", &o.cut_off, "cut-off frequency of the low pass [Hz]");
  line.one_of("--recovery", &o.recovery, {"static", "vibrating"},
              "computation of the stress after a run of rigid links");
  line.option("--preload", &o.preload, "preload of the tensioners [N]");
  line.positive("--section", &o.section,
                "height of a flexible link's section, divided by the height that gives the mass of a rigid link");
  line.flag(
      "--bands", &o.bands,
      "figures also show the range over other values of data that the thesis does not give: 12 runs instead of one");
  line.flag("--halve", &o.halve, "compares a run with a run with half the step");
  line.flag("--restart", &o.restart, "checks that a run resumed from a checkpoint ends in the same state, bitwise");
  line.flag("--fatigue", &o.fatigue, "counts cycles of stress by rainflow");
  line.flag("--audit", &o.audit, "prints the energy balance");
  line.flag("!--unwatched", &o.watched, "a track that leaves its sprocket does not end the run");
  line.option("--viewer", &o.viewer, "viewer of films: polybody_viewer.html, which the CMake target 'viewer' builds");
  line.option(
      "--film", &o.film_file,
      "file for a film of the run, or of decoupled rigid links and cables of the first comparison; default with "
      "--viewer: film.html in the folder --out");
  line.option("--out", &o.out, "folder of the results");
  line.flag("--no-plot", &o.no_plot, "write data and scripts, but draw nothing");
  if (auto const code = line.parse(argc, argv)) return *code;
  if (contacts == "places") o.contacts = m113::ContactsAct::at_their_places;
  if (o.turn == "pivot") o.right = -1.0;
  if (o.turn == "curve") o.right = 0.8;
  try {
    complete(o, step);
    check(o);
    if (is_of_combinations(o, o.compare)) return run_combinations(o, o.compare) ? 0 : 1;
    open_film(o);
    fs::create_directories(o.out);
    if (!o.compare.empty() && o.compare != "ensemble") o.start = std::make_shared<m113::TrackStart const>(settled(o));
    if (!o.figure.empty())
      figures(o);
    else if (o.compare == "matrix")
      matrix(o);
    else if (o.compare == "terms")
      compare_terms(o);
    else if (o.compare == "surface")
      surface_stress(o);
    else if (o.compare == "ensemble")
      ensemble(o);
    else if (o.compare == "stiffness")
      compare_stiffnesses(o);
    else if (o.compare == "pair")
      side_by_side(o, of_bodies(o, {"rigid", "ancf"}));
    else if (o.compare == "links")
      side_by_side(o, of_bodies(o, {"rigid", "ancf", "ffr", "lrvf", "beam", "continuum"}));
    else
      single(o);
    if (o.film && o.film->scenes() > 0)
      std::printf("  %s, %.1f MB\n", o.film_file.c_str(), 1e-6 * double(o.film->write(o.film_file)));
  } catch (Error const& e) {
    std::cerr << e.what() << '\n';
    return 1;
  }
}
