#include "stress_film.hpp"

#include "../support/vehicle_film.hpp"
#include "decoupled_link.hpp"

namespace chapter4 {

namespace {

// Bars that show rigid links with their decoupled stress in a film.
class DecoupledLinks {
 public:
  explicit DecoupledLinks(Options const& o) : bar_(m113::link_bar({}, section_height(o))), ring_(outline(bar_)) {
    surface_ = swept(pieces + 1, int(ring_.size()));
    std::size_t i = 0;
    for (int k = 0; k <= pieces; ++k)
      for (Vec2 const& p : ring_) surface_.points[i++] = Vec3(place(k) - 0.5 * bar_.length, p[0], p[1]);
  }

  void add(std::string const& name, DecoupledStress const& stress) {
    std::vector<std::vector<double>>& frames = stresses_[name];
    frames.assign(stress.times().size(), {});
    for (int k = 0; k <= pieces; ++k) {
      std::vector<Vec6> const forces = stress.section_forces(place(k));
      for (std::size_t frame = 0; frame < frames.size(); ++frame)
        for (Vec2 const& p : ring_) frames[frame].push_back(fibre_stress(bar_, forces[frame], p[0], p[1]));
    }
  }

  // Replaces the shape of each link with recorded stresses by its bar with axial stress, and removes its guide horn.
  void dress(std::size_t frame, std::vector<VisualPart>& parts) const {
    std::erase_if(parts, [&](VisualPart const& part) { return is_horn(part.name); });
    for (VisualPart& part : parts) {
      auto const found = stresses_.find(part.name);
      if (found == stresses_.end()) continue;
      part.surface = surface_;
      part.carried = surface_.points;
      for (Vec3& p : part.surface.points) p = part.place + part.axes * p;
      part.velocities.clear();
      part.axial_stress = found->second.at(frame);
    }
  }

 private:
  static constexpr int pieces = 4;  // equal to the number of pieces of flexible links
  double place(int k) const { return bar_.length * double(k) / double(pieces); }
  bool is_horn(std::string const& name) const {
    std::size_t const end = name.rfind(" horn");
    return end != name.npos && stresses_.contains(name.substr(0, end));
  }

  Bar bar_;
  std::vector<Vec2> ring_;
  Surface surface_;                                                   // surface in axes of the link's middle
  std::map<std::string, std::vector<std::vector<double>>> stresses_;  // stress for each link, frame and point [Pa]
};

}  // namespace

StressScene::StressScene(Options const& o, std::string const& name, AnyVehicle const& vehicle, WatchedLink const& link)
    : model_(vehicle.model), links_(link.rigid_links) {
  if (!o.film) return;
  bool const decoupled = !links_.empty();
  scene_ = std::make_shared<VehicleScene>(
      *o.film, decoupled ? "decoupled: FFR links after a run of rigid ones" : "coupled: " + links_in_words(name),
      decoupled ? families::ffr_modal : formulation_of(name), vehicle, o.film_until, false);
  if (!decoupled) return;
  loads_ = std::make_shared<LoadRecorder>(model_.system());
  for (RigidLink const& one : links_) one.add(*loads_);
  scene_->keep([loads = loads_](State const& x) { loads->record(x); });
}

void StressScene::finish(Options const& o, std::vector<double> const& times, LinkHistory const& watched) {
  if (!scene_) return;
  if (loads_) show_decoupled(o);
  std::vector<double> stress = watched.strain;
  for (double& s : stress) s *= 1e-6 * m113::youngs_modulus;
  scene_->plot("axial stress of left link " + std::to_string(watched_link) + " [MPa]", times, stress);
}

void StressScene::show_decoupled(Options const& o) {
  DecoupledLinks shown(o);
  for (RigidLink const& link : links_) shown.add(link.name, quasi_static(o, link.record(*loads_)));
  Probe probe(model_);
  scene_->show_kept(probe, [&](std::size_t k, std::vector<VisualPart>& parts) { shown.dress(k, parts); });
}

std::string links_in_words(std::string const& links) {
  static std::map<std::string, std::string> const words{
      {"ancf", "ANCF cables"}, {"ffr", "FFR, modes"},  {"fe", "finite elements"},      {"lrvf", "LRVF"},
      {"se3", "SE(3) beams"},  {"beam", "ANCF beams"}, {"continuum", "ANCF continuum"}};
  auto const found = words.find(links);
  return found != words.end() ? found->second : links;
}

}  // namespace chapter4
