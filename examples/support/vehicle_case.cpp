// Runs of the tracked vehicle: outputs of each state, and the case of a run.
#include "../tracked_vehicle.hpp"

#include <polybody/io/vtk.hpp>

#include "m113/settled_track.hpp"
#include "m113/track_checks.hpp"
#include "vehicle_film.hpp"

namespace chapter3 {

namespace {

// Results of one state, computed once for all outputs.
class Numbers {
 public:
  explicit Numbers(Built const& built)
      : vehicle_(built.vehicle.tracks), start_(built.start), probe_(built.vehicle.model) {
    pin_ = joint_named(built.vehicle.pin);
    drive_ = joint_named(built.vehicle.drive);
  }

  double operator()(State const& x, double Numbers::* number) {
    if (x.t != t_) look(x);
    return this->*number;
  }

  double forward = 0, sideways = 0, height = 0, pitch = 0, yaw = 0, speed = 0, sprocket = 0, idler = 0;
  double link_x = 0, link_z = 0, force_x = 0, force_z = 0, force = 0, gap = 0, largest_gap = 0, depth = 0, off_path = 0,
         off_plane = 0;

  // State x with the evaluation of its outputs.
  ObservedState at(State const& x) {
    if (x.t != t_) look(x);
    return probe_.at(x);
  }

  std::string deepest;  // link and contact partner of the deepest contact of the run
  double deepest_depth = 0.0, deepest_time = 0.0, torque = 0;

 private:
  void look(State const& x) {
    t_ = x.t;
    auto const now = probe_.at(x);
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
    Wrench<double> const r = reaction_of(now.evaluated(), x, pin_);
    force_x = r.f.x();
    force_z = r.f.z();
    force = r.f.norm();
    torque = reaction_of(now.evaluated(), x, drive_).m.dot(hull.A.col(1));
    largest_gap = 0.0;
    for (int i = 0; i < m113::links; ++i) {
      double const open =
          (track.front[std::size_t(i)](x).r - track.rear[std::size_t((i + m113::links - 1) % m113::links)](x).r).norm();
      if (i == watched_pin) gap = open;
      largest_gap = std::max(largest_gap, open);
    }
    depth = off_path = off_plane = 0.0;
    for (m113::Side const s : {m113::Side::left, m113::Side::right}) {
      m113::TrackDerailment const fault = m113::track_derailment(*vehicle_, now.evaluated(), x, s, start_);
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

  Index joint_named(std::string const& name) {
    auto const& joints = probe_.system().layout().joints;
    return std::find_if(joints.begin(), joints.end(), [&](JointLayout const& j) { return j.name == name; }) -
           joints.begin();
  }

  std::shared_ptr<m113::TrackedVehicle const> vehicle_;
  m113::TrackStart start_;
  Probe probe_;
  Index pin_ = 0, drive_ = 0;  // indices of the joints in the layout
  double t_ = -1.0;
};

// The outputs of every run.
inline constexpr std::pair<char const*, double Numbers::*> asked[] = {
    {"forward position [m]", &Numbers::forward},
    {"sideways position [m]", &Numbers::sideways},
    {"vertical displacement [m]", &Numbers::height},
    {"pitch [rad]", &Numbers::pitch},
    {"yaw [rad]", &Numbers::yaw},
    {"forward velocity [m/s]", &Numbers::speed},
    {"sprocket speed [rad/s]", &Numbers::sprocket},
    {"sprocket torque [N m]", &Numbers::torque},
    {"idler travel [m]", &Numbers::idler},
    {"link x in chassis [m]", &Numbers::link_x},
    {"link z in chassis [m]", &Numbers::link_z},
    {"joint force x [N]", &Numbers::force_x},
    {"joint force z [N]", &Numbers::force_z},
    {"joint force [N]", &Numbers::force},
    {"joint gap [m]", &Numbers::gap},
    {"largest joint gap [m]", &Numbers::largest_gap},
    {"deepest contact [m]", &Numbers::depth},
    {"off the path [m]", &Numbers::off_path},
    {"off the middle plane [m]", &Numbers::off_plane},
};

// Observers of every state of a run, in addition to the outputs.
class Watch {
 public:
  Watch(Settings const& s, std::string const& name, std::shared_ptr<m113::TrackedVehicle const> vehicle,
        std::shared_ptr<Numbers> numbers)
      : vehicle_(std::move(vehicle)),
        numbers_(std::move(numbers)),
        progress_(0.0, s.end_time, name),
        until_(s.end_time),
        every_(s.animate) {}

  void audit(EnergyAudit audit) { audit_ = std::make_unique<EnergyAudit>(std::move(audit)); }
  void animate(Visual visual, fs::path const& file) {
    visual_ = std::make_unique<Visual>(std::move(visual));
    writer_ = std::make_unique<VtkWriter>(file, *visual_);
  }

  void film(std::shared_ptr<VehicleScene> scene) { scene_ = std::move(scene); }

  void see(State const& x, Outcome& o) {
    o.deepest = numbers_->deepest;
    o.depth = numbers_->deepest_depth;
    o.deepest_time = numbers_->deepest_time;
    if (o.trouble.empty()) o.trouble = m113::track_warning(*vehicle_, x);
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
    if (scene_) {
      scene_->see(numbers_->at(x));
      scene_->plot(x.t, {{"forward velocity [m/s]", numbers_->speed},
                         {"vertical displacement [m]", numbers_->height},
                         {"force of a pin [kN]", 1e-3 * numbers_->force}});
    }
    progress_.update(x.t);
    if (x.t >= until_) progress_.finish();
  }

 private:
  std::shared_ptr<m113::TrackedVehicle const> vehicle_;
  std::shared_ptr<Numbers> numbers_;
  Progress progress_;
  double until_, every_, next_picture_ = 0.0;
  std::unique_ptr<EnergyAudit> audit_;
  std::unique_ptr<Visual> visual_;
  std::unique_ptr<VtkWriter> writer_;
  std::shared_ptr<VehicleScene> scene_;
};

}  // namespace

BumpCourse course(bool bumps) {
  if (!bumps) return BumpCourse({});
  return BumpCourse({Bump{.x = 6.0, .length = 1.2, .height = 0.10},
                     {.x = 10.0, .length = 1.2, .height = 0.15, .y = 1.0, .width = 2.0},
                     {.x = 14.0, .length = 2.0, .height = 0.15}});
}

m113::VehicleOptions vehicle_options(Settings const& s) {
  return {.masses = s.masses,
          .suspension = s.suspension,
          .preload = s.preload,
          .cut = s.cut,
          .link_elements = s.elements,
          .contacts = s.contacts,
          .shared_contacts = s.shared_contacts};
}

GeneralisedAlpha integrator(Settings const& o) { return {.rho_inf = o.rho, .tolerance = 1e-5}; }

std::vector<std::string> output_names() {
  std::vector<std::string> names;
  for (auto const& [output, number] : asked)
    names.push_back(std::string(output).substr(0, std::string(output).find(" [")));
  return names;
}

void warn_of_drive(Settings const& o) {
  double const fastest = o.speed * std::max(std::abs(o.left), std::abs(o.right));
  if (std::string const warning = m113::drive_warning(fastest, o.step); !warning.empty())
    std::cerr << "Warning: " << warning << '\n';
}

m113::TrackStart settled(Settings const& s) { return m113::settled_track(vehicle_options(s), course(s.bumps)); }

Built build(Settings const& s, MakeVehicle const& make) {
  m113::VehicleOptions options = vehicle_options(s);
  options.start = s.start ? *s.start : settled(s);
  std::array<Ramp, 2> drives{m113::drive(s.left * s.speed, 0.1), m113::drive(s.right * s.speed, 0.1)};
  for (Ramp& drive : drives) drive.duration = s.ramp;
  return {options.start, make({course(s.bumps), drives, options})};
}

Scenario<AnyModel> TrackCase::scenario(std::string const& name, Built const& built) const {
  Settings const& s = settings;
  AnyVehicle const& vehicle = built.vehicle;
  auto const numbers = std::make_shared<Numbers>(built);
  std::vector<Output<AnyModel>> outputs;
  for (auto const& [output, number] : asked)
    outputs.push_back(
        {output, [numbers, number = number](AnyModel const&, State const& x) { return (*numbers)(x, number); }});

  outcomes->push_back({.name = name});
  auto const watch = std::make_shared<Watch>(s, name, vehicle.tracks, numbers);
  if (s.audit) watch->audit(EnergyAudit(vehicle.model.system()));
  if (s.animate > 0.0) watch->animate(vehicle.visual(), s.out / (name + ".pvd"));
  if (scene)
    watch->film(scene);
  else if (s.film)
    watch->film(std::make_shared<VehicleScene>(*s.film, title_of(name), formulation_of(name), vehicle, s.film_until));
  auto observer = [watch, out = outcomes, mine = outcomes->size() - 1](AnyModel const&, State const& x) {
    watch->see(x, (*out)[mine]);
  };
  RunOptions run{.end_time = s.end_time, .step = s.first_step > 0.0 ? s.first_step : s.step, .max_step_halvings = 6};
  if (s.first_step > 0.0) run.max_step = s.step;
  if (s.watched)
    for (m113::Side const side : {m113::Side::left, m113::Side::right})
      run.events.push_back(m113::derailed(*vehicle.tracks, side));
  return {vehicle.model, vehicle.model.reference_state(), run, std::move(outputs), observer, s.sampling};
}

}  // namespace chapter3
