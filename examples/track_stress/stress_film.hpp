#pragma once
// The film of Chapter 4: links coloured by their axial stress, decoupled beside coupled.
#include "stress_runs.hpp"

namespace chapter4 {

// A run as a scene of the film of the options, or without a film. Flexible links provide their stress in each frame.
// For rigid links the loads are recorded at each frame; their stress is computed after the run, with a floating
// frame, and then the frames are made.
class StressScene {
 public:
  StressScene(Options const& o, std::string const& name, AnyVehicle const& vehicle, WatchedLink const& link);

  // Scene that records the run; null without a film.
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
