#include "vehicle_film.hpp"

#include <map>
#include <string_view>

namespace chapter3 {

namespace {
constexpr double frames_per_second = 30.0;  // of simulated time
constexpr double same_time = 1e-9;          // [s]

// Adds a point to the history `output`, which is given as "label [unit]".
void add_point(FilmScene& scene, std::string const& output, double t, double number) {
  std::size_t const unit = output.find(" [");
  scene.plot(output.substr(0, unit), output.substr(unit + 2, output.size() - unit - 3), t, number);
}

// Adds an arrow for each link and partner: the sum of the forces at their contact points, at the mean of these points
// weighted by force. One contact point of a cable represents two of a rigid link, so only these sums can be compared.
void add_sums_of_contacts(FilmScene& scene, FilmArrows arrows, m113::Track const& track, System const& system) {
  struct Sum {
    Vec3 force = Vec3::Zero(), place = Vec3::Zero();
    double weight = 0.0;
  };
  std::map<std::pair<Index, std::string_view>, Sum> sums;
  track.contacts(system, [&](TouchingPoint const& p) {
    Sum& sum = sums[{p.body, *p.against}];
    sum.force += p.force;
    sum.place += p.force.norm() * p.place;
    sum.weight += p.force.norm();
  });
  for (auto const& [pair, sum] : sums)
    if (sum.weight > 0.0) scene.arrow(arrows, sum.place / sum.weight, sum.force / 1e3);
}

}  // namespace

std::string title_of(std::string const& run) {
  for (std::string_view const policy : {"constraint", "penalty", "bushing", "joint-coordinates"})
    if (run.starts_with(policy)) return "rigid links, pins by " + run;
  return run == "ancf" ? "flexible links: ANCF cables" : run;
}

std::string_view formulation_of(std::string const& run) {
  static std::map<std::string, std::string_view> const known{{"constraint", "Constraint"},
                                                             {"penalty", "Penalty"},
                                                             {"bushing", "Bushing"},
                                                             {"joint-coordinates", "JointCoordinates"},
                                                             {"ancf", families::cable_green},
                                                             {"beam", families::beam_elastic_line},
                                                             {"continuum", families::beam_continuum},
                                                             {"lrvf", families::lrvf_in_space},
                                                             {"se3", families::se3_beam_in_space},
                                                             {"ffr", families::ffr_modal},
                                                             {"fe", families::ffr_nodal}};
  auto const found = known.find(run.substr(0, run.find_first_of(", ")));
  return found != known.end() ? found->second : std::string_view();
}

std::shared_ptr<Film> vehicle_film(fs::path const& viewer, std::string const& title) {
  return std::make_shared<Film>(FilmOptions{.viewer = viewer,
                                            .title = title,
                                            .frames_per_second = frames_per_second,
                                            .look_from = Vec3(1.0, -2.2, 0.75),
                                            .up = Vec3::UnitZ(),
                                            .follow = "hull"});
}

VehicleScene::VehicleScene(Film& film, std::string const& name, std::string_view formulation, AnyVehicle const& vehicle,
                           double end_time, bool joints)
    : visual_(vehicle.visual()), tracks_(vehicle.tracks), scene_(film.scene(name, formulation)), until_(end_time) {
  scene_.colour(axial_stress_colours());
  contacts_ = scene_.arrows("contact forces on links, sums for each partner", "kN");
  if (joints) joints_ = scene_.arrows("forces of joints", "kN", false);
}

void VehicleScene::plot(double t, std::vector<std::pair<char const*, double>> const& numbers) {
  if (!plotted(t, next_)) return;
  for (auto const& [output, number] : numbers) add_point(scene_, output, t, number);
}

void VehicleScene::plot(std::string const& output, std::vector<double> const& times,
                        std::vector<double> const& values) {
  double next = 0.0;
  for (std::size_t i = 0; i < std::min(times.size(), values.size()); ++i)
    if (plotted(times[i], next)) add_point(scene_, output, times[i], values[i]);
}

bool VehicleScene::plotted(double t, double& next) const {
  if (t < next - same_time || t > until_ + same_time) return false;
  next = std::max(next + 0.005, t);
  return true;
}

void VehicleScene::see(ObservedState const& now) {
  if (now.t > until_ + same_time) return;
  if (!also_) {
    if (scene_.due(now.t)) frame(now, visual_.at(now));
  } else if (now.t >= next_kept_ - same_time) {
    double const interval = 1.0 / frames_per_second;
    next_kept_ = next_kept_ + interval > now.t ? next_kept_ + interval : now.t + interval;
    kept_.push_back(now);
    also_(now);
  }
}

void VehicleScene::show_kept(Probe& probe, std::function<void(std::size_t k, std::vector<VisualPart>&)> const& dress) {
  for (std::size_t k = 0; k < kept_.size(); ++k) {
    std::vector<VisualPart> parts = visual_.at(kept_[k]);
    dress(k, parts);
    frame(probe.at(kept_[k]), parts);
  }
}

void VehicleScene::frame(ObservedState const& now, std::vector<VisualPart> const& parts) {
  scene_.record(now.t, parts);
  for (m113::Side const side : {m113::Side::left, m113::Side::right})
    add_sums_of_contacts(scene_, contacts_, tracks_->track(side), now.evaluated());
  if (joints_) add_reactions(scene_, *joints_, now, 1e3);
}

}  // namespace chapter3
