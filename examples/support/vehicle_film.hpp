#pragma once
// The tracked vehicle as a film: shapes, axial stress where links know it, forces of contacts and pins, and histories.
#include <polybody/io/film.hpp>
#include <polybody/io/film_forces.hpp>

#include "../tracked_vehicle.hpp"

namespace chapter3 {

// The camera goes with the hull.
std::shared_ptr<Film> vehicle_film(fs::path const& viewer, std::string const& title);

// One run.
class VehicleScene {
 public:
  VehicleScene(Film& film, std::string const& name, AnyVehicle const& vehicle);

  // A point of a history, unless there was one within 5 ms.
  void plot(double t, std::vector<std::pair<char const*, double>> const& numbers);
  // A frame, where one is due. `system` must have been evaluated at x.
  void see(State const& x, System const& system);

 private:
  Visual visual_;
  std::shared_ptr<m113::TrackedVehicle const> tracks_;
  FilmScene& scene_;
  FilmArrows contacts_{}, pins_{};
  double next_ = 0.0;
};

}  // namespace chapter3
