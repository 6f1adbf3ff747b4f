#include "vehicle_film.hpp"

namespace chapter3 {

namespace {
constexpr double frames_per_second = 30.0;  // of simulated time
constexpr double same_time = 1e-9;          // [s]

// Adds a point to the history `output`, which is given as "label [unit]".
void add_point(FilmScene& scene, std::string const& output, double t, double number) {
  std::size_t const unit = output.find(" [");
  scene.plot(output.substr(0, unit), output.substr(unit + 2, output.size() - unit - 3), t, number);
}
}  // namespace

std::shared_ptr<Film> vehicle_film(fs::path const& viewer, std::string const& title) {
  return std::make_shared<Film>(FilmOptions{.viewer = viewer,
                                            .title = title,
                                            .frames_per_second = frames_per_second,
                                            .look_from = Vec3(1.0, -2.2, 0.75),
                                            .up = Vec3::UnitZ(),
                                            .follow = "hull"});
}

VehicleScene::VehicleScene(Film& film, std::string const& name, AnyVehicle const& vehicle, double end_time, bool joints)
    : visual_(vehicle.visual()), tracks_(vehicle.tracks), scene_(film.scene(name)), until_(end_time) {
  scene_.colour(axial_stress_colours());
  contacts_ = scene_.arrows("contact forces on links", "kN");
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
    tracks_->track(side).contacts(now.evaluated(), add_contacts(scene_, contacts_, 1e3));
  if (joints_) add_reactions(scene_, *joints_, now, 1e3);
}

}  // namespace chapter3
