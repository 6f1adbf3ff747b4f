#include "vehicle_film.hpp"

namespace chapter3 {

std::shared_ptr<Film> vehicle_film(fs::path const& viewer, std::string const& title) {
  return std::make_shared<Film>(FilmOptions{
      .viewer = viewer, .title = title, .look_from = Vec3(1.0, -2.2, 0.75), .up = Vec3::UnitZ(), .follow = "hull"});
}

VehicleScene::VehicleScene(Film& film, std::string const& name, AnyVehicle const& vehicle)
    : visual_(vehicle.visual()), tracks_(vehicle.tracks), scene_(film.scene(name)) {
  scene_.colour(axial_stress_colours());
  contacts_ = scene_.arrows("contact forces on links", "kN");
  pins_ = scene_.arrows("forces of joints", "kN", false);
}

void VehicleScene::plot(double t, std::vector<std::pair<char const*, double>> const& numbers) {
  if (t < next_ - 1e-9) return;
  next_ = std::max(next_ + 0.005, t);
  for (auto const& [output, number] : numbers) {  // "label [unit]"
    std::string const text = output;
    std::size_t const unit = text.find(" [");
    scene_.plot(text.substr(0, unit), text.substr(unit + 2, text.size() - unit - 3), t, number);
  }
}

void VehicleScene::see(State const& x, System const& system) {
  if (!scene_.due(x.t)) return;
  scene_.record(x.t, visual_.at(x));
  for (m113::Side const side : {m113::Side::left, m113::Side::right})
    tracks_->track(side).contacts(system, add_contacts(scene_, contacts_, 1e3));
  add_reactions(scene_, pins_, system, x, 1e3);
}

}  // namespace chapter3
