#pragma once
// The tracked vehicle as a film: shapes, axial stress of flexible links, forces of contacts and pins, and histories.
#include <polybody/io/film.hpp>
#include <polybody/io/film_forces.hpp>

#include "../tracked_vehicle.hpp"

namespace chapter3 {

// Creates a film whose camera follows the hull.
std::shared_ptr<Film> vehicle_film(fs::path const& viewer, std::string const& title);

// Title of the scene of a run of the comparison of pins; other names are unchanged.
std::string title_of(std::string const& run);
// Family of the links of a run, or policy of the pins of rigid links, which determines the colour of the scene; empty
// for other names.
std::string_view formulation_of(std::string const& run);

// Scene of one run.
class VehicleScene {
 public:
  // \param formulation see formulation_of
  // \param end_time last time of the film [s]
  // \param joints true: includes the forces of joints, which are a sixth of the file
  VehicleScene(Film& film, std::string const& name, std::string_view formulation, AnyVehicle const& vehicle,
               double end_time, bool joints = true);

  // Adds a point to each history unless the last point is less than 5 ms earlier. `numbers` are pairs of "label [unit]"
  // and a value.
  void plot(double t, std::vector<std::pair<char const*, double>> const& numbers);
  // Adds a complete history with the label "label [unit]".
  void plot(std::string const& output, std::vector<double> const& times, std::vector<double> const& values);
  // Records a frame if one is due.
  void see(ObservedState const& now);

  // Postpones the frames until `show_kept` is called after the run. States at which a frame is due are stored and
  // passed to `also`.
  void keep(std::function<void(State const&)> also) { also_ = std::move(also); }
  // Records a frame for each stored state k. Before, `dress(k, parts)` changes the parts of the frame.
  void show_kept(Probe& probe, std::function<void(std::size_t k, std::vector<VisualPart>&)> const& dress);

 private:
  void frame(ObservedState const& now, std::vector<VisualPart> const& parts);
  // True if a history with its next point at `next` has a point at t; advances `next` in this case.
  bool plotted(double t, double& next) const;

  Visual visual_;
  std::shared_ptr<m113::TrackedVehicle const> tracks_;
  FilmScene& scene_;
  FilmArrows contacts_{};
  std::optional<FilmArrows> joints_;
  double next_ = 0.0, next_kept_ = 0.0, until_;
  std::function<void(State const&)> also_;
  std::vector<State> kept_;
};

}  // namespace chapter3
