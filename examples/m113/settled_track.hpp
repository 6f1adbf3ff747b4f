#pragma once
/// \file
/// Computation of tracks at rest on a fixed vehicle that does not load them.

#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/run/energy.hpp>
#include <polybody/run/observe.hpp>
#include <polybody/run/simulate.hpp>

#include "vehicle.hpp"

namespace polybody::m113 {

/// Computes the position at rest of tracks of rigid links on a fixed vehicle whose wheels just touch the ground.
/// `wrap_track` computes straight runs and ignores the ground; a long run sags. The position at rest is found by
/// dynamic relaxation with kinetic damping, without friction [Day 1965; Barnes 1999]. The track is released, and its
/// velocities are set to zero at each maximum of the kinetic energy, until the track rests.
/// \param ground terrain under the vehicle. If the program also drives on this type of ground, only one vehicle type is
/// compiled.
/// \throws InvalidInput, NewtonConvergenceFailure; Error if the track does not come to rest.
template <Terrain Ground = FlatGround>
TrackStart settled_track(VehicleOptions options = {}, Ground const& ground = {}) {
  options.held = true;
  options.friction = false;
  options.closure = Closure::in_plane;
  options.start = {};
  Vehicle<Rigid<>, Constraint, Ground> const bench(Constraint{}, {drive(0.0), drive(0.0)}, options, ground);
  State x = bench.model.reference_state();
  auto const& side = bench.side(Side::left);
  double fastest = 0.0;  // greatest speed of all links since the last release [m/s]
  for (int again = 0; again < 300 && (again < 10 || fastest > 1e-3); ++again) {
    x.v.setZero();
    x.t = 0.0;
    auto run = simulate(bench.model, x, GeneralisedAlpha{.rho_inf = 0.0, .tolerance = 1e-6},
                        {.end_time = 1.0, .step = 2e-3, .max_step_halvings = 8});
    System asked(bench.model, with<Capabilities::motion>);
    double energy = 0.0, before = 0.0;
    fastest = 0.0;
    do {
      run.advance();
      before = energy;
      asked.evaluate(x.q, x.v, x.t);
      energy = polybody::energy(asked, x).kinetic;
      for (auto const& link : side.links)
        fastest = std::max(fastest, frame(bench.model, x, link.at(Vec3(0, 0, 0))).v.norm());
    } while (!run.done() && energy > before);
  }
  if (fastest > 1e-3)
    throw Error("m113.not_settled",
                {ErrorObject{"M113"}, ": the track does not come to rest; after its release it reaches ",
                 ErrorValue{fastest}, " m/s. Check its length and its tensioner."});

  TrackStart start{.idler_x = position(bench.model, x, side.idler[0].at(Vec3(0, 0, 0))).x(), .links = {}};
  TrackLayout const layout = track();
  for (TrackCircle const& c : layout.circles) {
    double const travel = (start.idler_x - c.centre[0]) * layout.tensioner.direction[0];
    if (c.name == layout.tensioner.circle && !(travel >= layout.tensioner.least && travel <= layout.tensioner.most))
      throw InvalidInput(
          "m113.preload",
          {ErrorObject{"M113"}, ": under a preload of ", ErrorValue{options.preload}, " N the idler comes to rest ",
           travel, " m from its position in the layout, beyond its travel of ", layout.tensioner.least, " to ",
           layout.tensioner.most, " m. Use a preload of 0 to 60 kN."});
  }
  std::vector<Vec2> pins;
  for (auto const& front : side.front) {
    Vec3 const pin = position(bench.model, x, front);
    pins.emplace_back(pin.x(), pin.z());
  }
  start.links = track_links(layout, pins);
  return start;
}

}  // namespace polybody::m113
