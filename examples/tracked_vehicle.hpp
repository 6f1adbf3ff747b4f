#pragma once
// The vehicle of Chapters 3 and 4 as a case for `compare`: one template, whatever the formulation of its tracks.
#include <polybody/io/vtk.hpp>
#include <polybody/polybody.hpp>
#include <polybody/signals/filter.hpp>
#include <polybody/signals/rms_difference.hpp>
#include <polybody/vehicle/settled_track.hpp>
#include <polybody/vehicle/track_watch.hpp>
#include <polybody/vehicle/vehicle_visual.hpp>

#include <filesystem>
#include <iostream>
#include <memory>

namespace chapter3 {

using namespace polybody;
namespace fs = std::filesystem;

inline constexpr int watched_pin = 20;  // of the left track, on the ground at the start

struct Settings {
  m113::Solids masses = m113::thesis;
  double until = 10.0;
  double step = 5e-4;
  double first_step = 0.0;  // of an integrator that controls its step, whose longest is `step`; 0: `step`
  double sampling = 0.0;    // of the histories [s]; 0: every step
  double speed = m113::chapter_3_speed;
  double left = 1.0, right = 1.0;  // of the speed: unequal ones turn
  double ramp = 7.0;               // duration of the drives' ramp [s]
  bool suspension = true;
  double preload = m113::preload;
  double rho = 0.8;
  bool bumps = false;
  int cut = 0;
  int elements = 0;  // of a flexible link; 0: as few as its formulation does with
  m113::ContactsAct contacts = m113::ContactsAct::in_the_middle;
  std::shared_ptr<m113::TrackStart const> start = {};  // of the links; without it each run settles its own tracks
  double animate = 0.0;                                // seconds between states, 0 for none
  bool audit = false;
  bool watched = true;  // a track that leaves its sprocket ends the run
  fs::path out = "out/tracked_vehicle";
  bool no_plot = false;  // data and scripts only
};

// Obstacles for the bump course: 10 and 15 cm high, across both tracks and under one of them.
inline BumpCourse course(bool bumps) {
  if (!bumps) return BumpCourse({});
  return BumpCourse({Bump{.x = 6.0, .length = 1.2, .height = 0.10},
                     {.x = 10.0, .length = 1.2, .height = 0.15, .y = 1.0, .width = 2.0},
                     {.x = 14.0, .length = 2.0, .height = 0.15}});
}

inline GeneralizedAlpha integrator(Settings const& o) { return {.rho_inf = o.rho, .tolerance = 1e-5}; }

inline void warn_of_drive(Settings const& o) {
  double const fastest = o.speed * std::max(std::abs(o.left), std::abs(o.right));
  if (std::string const warning = m113::drive_warning(fastest, o.step); !warning.empty())
    std::cerr << "Warning: " << warning << '\n';
}

template <class F>
using VehicleOf = m113::Vehicle<typename F::BodyType, typename F::PolicyType, BumpCourse>;

inline m113::VehicleOptions vehicle_options(Settings const& s) {
  return {.masses = s.masses,
          .suspension = s.suspension,
          .preload = s.preload,
          .cut = s.cut,
          .link_elements = s.elements,
          .contacts = s.contacts};
}

// A formulation that says how its links are made, where that is not told by their type.
template <class Body, class Policy>
struct LinkFormulation : Formulation<Body, Policy, GeneralizedAlpha> {
  m113::LinkOf<Body> links = {};
};
template <class F>
m113::LinkOf<typename F::BodyType> links_made(F const& f) {
  if constexpr (requires { f.links; })
    return f.links;
  else
    return {};
}

// Where links lie whose tracks have come to rest; the same for all formulations.
template <class = void>  // compiled where it is used
m113::TrackStart settled(Settings const& s) {
  return m113::settled_track(vehicle_options(s), course(s.bumps));
}

// What is built and set going: the vehicle, and where its links lay at the start.
template <class F>
struct Built {
  m113::TrackStart start;
  std::shared_ptr<VehicleOf<F> const> vehicle;
};

// Numbers of one state, worked out once for all outputs that ask.
class Probe {
 public:
  template <class V>
  Probe(std::shared_ptr<V const> const& vehicle, m113::TrackStart start)
      : vehicle_(vehicle), start_(std::move(start)), system_(vehicle->model, with<Entries::motion>) {
    auto const& side = vehicle->side(m113::Side::left);
    pin_ = index_of_joint(system_.layout(), side.pins[watched_pin]);
    drive_ = index_of_joint(system_.layout(), side.drive[0]);
  }

  double operator()(State const& x, double Probe::* number) {
    if (x.t != t_) look(x);
    return this->*number;
  }

  double forward = 0, sideways = 0, height = 0, pitch = 0, yaw = 0, speed = 0, sprocket = 0, idler = 0;
  double link_x = 0, link_z = 0, force_x = 0, force_z = 0, force = 0, gap = 0, largest_gap = 0, depth = 0, off_path = 0,
         off_plane = 0;

  std::string deepest;  // where the deepest contact of the run was
  double deepest_depth = 0.0, deepest_time = 0.0, torque = 0;

 private:
  void look(State const& x) {
    t_ = x.t;
    system_.evaluate(x.q, x.v, x.t);
    Frame<double> const hull = vehicle_->hull(x);
    m113::Track const& track = vehicle_->track(m113::Side::left);
    forward = hull.r.x() - m113::chassis.x;
    sideways = hull.r.y();
    height = hull.r.z() - m113::chassis.z;
    pitch = std::asin(-hull.A(2, 0));
    yaw = std::atan2(hull.A(1, 0), hull.A(0, 0));
    speed = hull.v.dot(hull.A.col(0));
    sprocket = hull.A.col(1).dot(track.sprocket(x).w - hull.w);
    Vec3 const slider = hull.A.transpose() * (track.tensioner(x).r - hull.r);
    idler = slider.x() - (m113::idler_reference_x - m113::chassis.x);
    Vec3 const link = hull.A.transpose() * (track.middle[watched_pin](x).r - hull.r);
    link_x = link.x();
    link_z = link.z();
    Wrench<double> const r = reaction_of(system_, x, pin_);
    force_x = r.f.x();
    force_z = r.f.z();
    force = r.f.norm();
    torque = reaction_of(system_, x, drive_).m.dot(hull.A.col(1));
    largest_gap = 0.0;
    for (int i = 0; i < m113::links; ++i) {
      double const open =
          (track.front[std::size_t(i)](x).r - track.rear[std::size_t((i + m113::links - 1) % m113::links)](x).r).norm();
      if (i == watched_pin) gap = open;
      largest_gap = std::max(largest_gap, open);
    }
    depth = off_path = off_plane = 0.0;
    for (m113::Side const s : {m113::Side::left, m113::Side::right}) {
      m113::TrackFault const fault = m113::track_fault(*vehicle_, system_, x, s, start_);
      if (fault.depth > deepest_depth) {
        deepest_depth = fault.depth;
        deepest_time = x.t;
        deepest = (s == m113::Side::left ? "left link " : "right link ") + std::to_string(fault.link) + " in " +
                  fault.against;
      }
      depth = std::max(depth, fault.depth);
      off_path = std::max(off_path, fault.off_path);
      off_plane = std::max(off_plane, fault.sideways);
    }
  }

  std::shared_ptr<m113::TrackedVehicle const> vehicle_;
  m113::TrackStart start_;
  System system_;
  Index pin_ = 0, drive_ = 0;  // places of the joints in the layout
  double t_ = -1.0;
};

// What became of a run, beside its histories.
struct Outcome {
  std::string name, trouble = {}, deepest = {};
  double depth = 0.0, deepest_time = 0.0;
  double drives = 0.0, gravity = 0.0, kinetic = 0.0, stored = 0.0, dissipated = 0.0, unaccounted = 0.0,
         relative = -1.0;  // [J]
};

// The outputs of every run.
inline constexpr std::pair<char const*, double Probe::*> asked[] = {
    {"forward position [m]", &Probe::forward},
    {"sideways position [m]", &Probe::sideways},
    {"vertical displacement [m]", &Probe::height},
    {"pitch [rad]", &Probe::pitch},
    {"yaw [rad]", &Probe::yaw},
    {"forward velocity [m/s]", &Probe::speed},
    {"sprocket speed [rad/s]", &Probe::sprocket},
    {"sprocket torque [N m]", &Probe::torque},
    {"idler travel [m]", &Probe::idler},
    {"link x in chassis [m]", &Probe::link_x},
    {"link z in chassis [m]", &Probe::link_z},
    {"joint force x [N]", &Probe::force_x},
    {"joint force z [N]", &Probe::force_z},
    {"joint force [N]", &Probe::force},
    {"joint gap [m]", &Probe::gap},
    {"largest joint gap [m]", &Probe::largest_gap},
    {"deepest contact [m]", &Probe::depth},
    {"off the path [m]", &Probe::off_path},
    {"off the middle plane [m]", &Probe::off_plane},
};

// What is done at every state of a run beside its outputs.
class Watch {
 public:
  Watch(Settings const& s, std::string const& name, std::shared_ptr<m113::TrackedVehicle const> vehicle,
        std::shared_ptr<Probe> probe)
      : vehicle_(std::move(vehicle)),
        probe_(std::move(probe)),
        progress_(0.0, s.until, name),
        until_(s.until),
        every_(s.animate) {}

  void audit(EnergyAudit audit) { audit_ = std::make_unique<EnergyAudit>(std::move(audit)); }
  void animate(Visual visual, fs::path const& file) {
    visual_ = std::make_unique<Visual>(std::move(visual));
    writer_ = std::make_unique<VtkWriter>(file, *visual_);
  }

  void see(State const& x, Outcome& o) {
    o.deepest = probe_->deepest;
    o.depth = probe_->deepest_depth;
    o.deepest_time = probe_->deepest_time;
    if (o.trouble.empty()) o.trouble = m113::track_trouble(*vehicle_, x);
    if (audit_) {
      audit_->record(x);
      o.drives = audit_->work_of_drives();
      o.gravity = audit_->work_of_gravity();
      o.kinetic = audit_->kinetic();
      o.stored = audit_->stored();
      o.dissipated = audit_->dissipated();
      o.unaccounted = audit_->unaccounted();
      o.relative = audit_->relative();
    }
    if (writer_ && x.t >= next_picture_ - 1e-9) {
      writer_->write(x);
      next_picture_ += every_;
    }
    progress_.update(x.t);
    if (x.t >= until_) progress_.finish();
  }

 private:
  std::shared_ptr<m113::TrackedVehicle const> vehicle_;
  std::shared_ptr<Probe> probe_;
  Progress progress_;
  double until_, every_, next_picture_ = 0.0;
  std::unique_ptr<EnergyAudit> audit_;
  std::unique_ptr<Visual> visual_;
  std::unique_ptr<VtkWriter> writer_;
};

// What `compare` takes of a case; the model is the vehicle's own, not a copy.
template <class V, class M = typename V::ModelType>
struct TrackScenario {
  std::shared_ptr<V const> vehicle;
  M const& model;
  State start;
  RunOptions options;
  std::vector<Output<M>> outputs;
  std::function<void(M const&, State const&)> observer;
  double sampling;
};

// The case that `compare` runs: F says what links are and how they hang together.
struct TrackCase {
  Settings const& settings;
  std::vector<Outcome>* outcomes;

  template <class F>
  auto operator()(F const& f) const {
    return scenario(f, build(f));
  }

  template <class F>
  Built<F> build(F const& f) const {
    Settings const& s = settings;
    m113::VehicleOptions options = vehicle_options(s);
    options.start = s.start ? *s.start : settled(s);
    std::array<Ramp, 2> drives{m113::drive(s.left * s.speed, 0.1), m113::drive(s.right * s.speed, 0.1)};
    for (Ramp& drive : drives) drive.duration = s.ramp;
    return {options.start,
            std::make_shared<VehicleOf<F> const>(f.policy, drives, options, course(s.bumps), links_made(f))};
  }

  template <class F>
  auto scenario(F const& f, Built<F> const& built) const {
    using M = typename VehicleOf<F>::ModelType;
    Settings const& s = settings;
    auto const vehicle = built.vehicle;
    auto const probe = std::make_shared<Probe>(vehicle, built.start);
    std::vector<Output<M>> outputs;
    for (auto const& [name, number] : asked)
      outputs.push_back({name, [probe, number = number](M const&, State const& x) { return (*probe)(x, number); }});

    outcomes->push_back({.name = f.name});
    auto const watch = std::make_shared<Watch>(s, f.name, vehicle, probe);
    if (s.audit) watch->audit(EnergyAudit(vehicle->model));
    if (s.animate > 0.0) watch->animate(m113::vehicle_visual(*vehicle), s.out / (f.name + ".pvd"));
    auto observer = [watch, out = outcomes, mine = outcomes->size() - 1](M const&, State const& x) {
      watch->see(x, (*out)[mine]);
    };
    RunOptions run{.until = s.until, .step = s.first_step > 0.0 ? s.first_step : s.step, .halvings = 6};
    if (s.first_step > 0.0) run.largest_step = s.step;
    if (s.watched)
      for (m113::Side const side : {m113::Side::left, m113::Side::right})
        run.events.push_back(m113::track_lost(*vehicle, side));
    return TrackScenario<VehicleOf<F>>{
        vehicle, vehicle->model, vehicle->model.reference_state(), run, std::move(outputs), observer, s.sampling};
  }
};

// What runs gave: comparison and outcomes side by side.
struct Runs {
  Comparison comparison;
  std::vector<Outcome> outcomes;
  double sampling = 0.0;  // [s] of the histories; 0: every step

  std::vector<double> const& history(std::size_t run, std::string const& name) const {
    auto const& r = comparison.runs[run];
    auto const at = std::find(r.output_names.begin(), r.output_names.end(), name);
    return r.outputs[std::size_t(at - r.output_names.begin())];
  }
  std::vector<double> const& times(std::size_t run) const { return comparison.runs[run].times; }
  // Without the last one where an event ended the run between two steps.
  std::span<double const> filtered_times(std::size_t run) const {
    return std::span(times(run)).first(times(run).size() - (comparison.runs[run].run.stopped ? 1 : 0));
  }
};

// A history of a run without frequencies above the cut-off [Hz].
struct Filtered {
  std::vector<double> times, values;
};
inline Filtered filtered(Runs const& runs, std::size_t run, std::string const& output, double cut_off) {
  auto const times = runs.filtered_times(run);
  auto const values = std::span(runs.history(run, output)).first(times.size());
  Filtered f{{times.begin(), times.end()}, {values.begin(), values.end()}};
  if (runs.sampling > 0.0) {  // states come up to a step after their sample
    f.values = resampled(f.times, f.values, runs.sampling, 2.5 * runs.sampling);
    double const start = f.times.front();
    f.times.clear();
    while (f.times.size() < f.values.size()) f.times.push_back(start + double(f.times.size()) * runs.sampling);
  }
  f.values = low_pass(f.times, f.values, {.cut_off = cut_off, .mirrored = true});
  return f;
}

// A curve of every `every`-th sample, so that files stay small.
inline Curve curve(std::string label, std::vector<double> const& x, std::vector<double> const& y, int color,
                   double scale = 1.0, std::size_t every = 4) {
  Curve c{.label = std::move(label), .color = color};
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); i += every) {
    c.x.push_back(x[i]);
    c.y.push_back(scale * y[i]);
  }
  return c;
}

inline void draw(Settings const& o, Figure const& f, std::string const& name) {
  write_figure(f, o.out / name, !o.no_plot);
  std::cout << "  " << (o.out / name).string() << (o.no_plot ? ".gp" : ".png") << '\n';
}

inline Figure history_figure(Runs const& runs, std::string const& output, std::string title, std::string label,
                             double cut_off = 0.0, double scale = 1.0) {
  Figure f{.title = std::move(title), .x_label = "t [s]", .y_label = std::move(label)};
  std::size_t const every = cut_off > 0.0 || output.find("force") == std::string::npos ? 4 : 1;
  for (std::size_t k = 0; k < runs.comparison.runs.size(); ++k) {
    Filtered const h =
        cut_off > 0.0 ? filtered(runs, k, output, cut_off) : Filtered{runs.times(k), runs.history(k, output)};
    f.curves.push_back(curve(runs.comparison.runs[k].name, h.times, h.values, int(k), scale, every));
  }
  return f;
}

inline void over_time(Settings const& o, Runs const& runs, std::string const& output, std::string title,
                      std::string label, std::string const& name, double cut_off = 0.0, double scale = 1.0) {
  draw(o, history_figure(runs, output, std::move(title), std::move(label), cut_off, scale), name);
}

// Over the time after `from` [s]; before 9 s there may still be the end of the ramp's surge.
inline double mean_speed(Runs const& runs, std::size_t run, double from = 9.0) {
  auto const &t = runs.times(run), &x = runs.history(run, "forward position [m]");
  std::size_t first = 0;
  while (first + 1 < t.size() && t[first] < from) ++first;
  return (x.back() - x[first]) / (t.back() - t[first]);
}

}  // namespace chapter3
