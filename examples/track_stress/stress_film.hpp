#pragma once
// The film of Chapter 4: links coloured by their axial stress, decoupled beside coupled.
#include "stress_runs.hpp"

namespace chapter4 {

// A run as a scene of the film that the options name, or of none. Flexible links know their stress in each frame. Of
// rigid ones what acts on them is recorded where a frame is due; their stress is worked out after the run, as that of
// floating frames, and the frames are made then.
class StressScene {
 public:
  StressScene(Options const& o, std::string const& name, AnyVehicle const& vehicle, WatchedLink const& link);

  // What the run shows itself to, none without a film.
  std::shared_ptr<VehicleScene> const& scene() const { return scene_; }
  // Adds what is known after the run.
  void finish(Options const& o, std::vector<double> const& times, LinkHistory const& watched);

 private:
  void show_decoupled(Options const& o);

  std::shared_ptr<VehicleScene> scene_;
  AnyModel model_;
  std::vector<BodyHandle<Rigid<>>> links_;  // that are rigid
  std::shared_ptr<LoadRecorder> loads_;     // on them
};

}  // namespace chapter4
