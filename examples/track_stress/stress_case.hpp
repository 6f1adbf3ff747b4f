#pragma once
// The case of Chapter 4 for `compare`: the tracked vehicle with the strain of the watched link as output.
#include "stress_film.hpp"

namespace chapter4 {

// Data for the computation of the strain of a rigid link after the run.
struct Recording {
  std::shared_ptr<LoadRecorder> recorder = {};
  std::optional<BodyHandle<Rigid<>>> link = {};
};
// Adds an observer of each state, which appends the outputs of a flexible link to `history` or records the loads of a
// rigid link.
Recording watch(Scenario<AnyModel>& scenario, WatchedLink const& link, std::shared_ptr<LinkHistory> const& history);
void recover(Options const& o, Recording const& recording, LinkHistory& history);

// Case for `compare`: a vehicle with an integrator and the options of the program.
template <class I>
struct StressCase {
  Options const& options;
  WatchedLink const& link;
  std::vector<Outcome>* outcomes;
  std::shared_ptr<LinkHistory> history;
  Recording* recording;
  std::shared_ptr<VehicleScene> scene;

  Scenario<AnyModel> operator()(Driven<I> const& driven) const {
    auto scenario = TrackCase{options, outcomes, scene}.scenario(driven.name, driven.built);
    *recording = watch(scenario, link, history);
    return scenario;
  }
};

template <class I, class Make>
StressRuns run_by(Options const& o, std::string const& name, Make const& make, I const& integrator) {
  WatchedLink link;
  Built const built = build(o, [&](VehicleParts const& parts) {
    StressVehicle made = make(o, parts);
    link = made.link;
    return made.vehicle;
  });
  StressRuns runs;
  auto const history = runs.links.emplace_back(std::make_shared<LinkHistory>());
  Recording recording;
  StressScene film(o, name, built.vehicle, link);
  runs.comparison = require_complete(compare(StressCase<I>{o, link, &runs.outcomes, history, &recording, film.scene()},
                                             Driven<I>{name, built, integrator}));
  if (recording.recorder) recover(o, recording, *history);
  film.finish(o, runs.times(0), *history);
  return runs;
}

}  // namespace chapter4
