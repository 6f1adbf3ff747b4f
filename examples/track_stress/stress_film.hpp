#pragma once
// Film of Chapter 4: links coloured by their axial stress, decoupled next to coupled.
#include "stress_runs.hpp"

namespace chapter4 {

// Scene of a run in the film of the options. Without a film, the object does nothing. Flexible links provide their
// stress in each frame. For rigid links the loads are recorded at each frame. After the run the stress of these links
// is computed with a floating frame, and the frames are recorded.
class StressScene {
 public:
  StressScene(Options const& o, std::string const& name, AnyVehicle const& vehicle, WatchedLink const& link);

  // Scene that records the run; null without a film.
  std::shared_ptr<VehicleScene> const& scene() const { return scene_; }
  // Adds the frames with decoupled stress and the stress history of the watched link after the run.
  void finish(Options const& o, std::vector<double> const& times, LinkHistory const& watched);

 private:
  void show_decoupled(Options const& o);

  std::shared_ptr<VehicleScene> scene_;
  AnyModel model_;
  std::vector<RigidLink> links_;         // rigid links
  std::shared_ptr<LoadRecorder> loads_;  // loads on the rigid links
};

}  // namespace chapter4
