#pragma once
/// \file Tracks of ANCF cables in ordinary and in Cholesky coordinates, with dependent coordinates eliminated by
/// linear joints [Wallin 2016, §4.4].

#include <gtest/gtest.h>

#include <ctime>

#include <polybody/bodies/ancf/cholesky_coordinates.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/run/simulate.hpp>

#include "m113/vehicle.hpp"

namespace polybody::cholesky_tracks {

using Cholesky = CholeskyCoordinates<AncfCable<>>;

template <class Link>
using Tracks = m113::Vehicle<Link, AncfLinear>;

/// Tracks that reach their speed within this time [s].
template <class Link>
Tracks<Link> vehicle(double end_time) {
  Ramp const drive{.target = 2.0, .duration = end_time};
  return Tracks<Link>(AncfLinear{}, {drive, drive}, {.masses = m113::with_steel_links()});
}

template <class V>
std::vector<Vec3> middles(V const& vehicle, State const& x) {
  std::vector<Vec3> places;
  for (m113::Track const& track : vehicle.tracks)
    for (FrameIn const& middle : track.middle) places.push_back(middle(x).r);
  return places;
}

/// Positions of the middles of all links after `end_time` [s], with explicit steps of 1 µs, and the CPU time of the
/// steps [s].
struct Driven {
  std::vector<Vec3> middles;
  double cpu = 0.0;
};
template <class Link>
Driven driven(double end_time) {
  auto const tracks = vehicle<Link>(end_time);
  State x = tracks.model.reference_state();
  auto run = simulate(tracks.model, x, RungeKutta4<Projection>{}, {.end_time = end_time, .step = 1e-6});
  std::clock_t const begin = std::clock();
  run.run();
  double const cpu = double(std::clock() - begin) / CLOCKS_PER_SEC;
  System system(tracks.model);
  system.evaluate(x.q, x.v, x.t);
  double pressed = 0.0;
  for (m113::Track const& track : tracks.tracks)
    track.contacts(system, [&](TouchingPoint const& p) { pressed += p.force.norm(); });
  EXPECT_GT(pressed, 1e4);  // wheels and ground are in contact with them
  return {middles(tracks, x), cpu};
}

/// Both versions have the same motion, within `tolerance` [m].
inline void expect_the_same_motion(double end_time, double tolerance) {
  auto const at_start = vehicle<AncfCable<>>(end_time);
  std::vector<Vec3> const start = middles(at_start, at_start.model.reference_state());
  auto const [own, own_cpu] = driven<AncfCable<>>(end_time);
  auto const [cholesky, cholesky_cpu] = driven<Cholesky>(end_time);
  double apart = 0.0, moved = 0.0;
  for (std::size_t i = 0; i < own.size(); ++i) {
    apart = std::max(apart, (own[i] - cholesky[i]).norm());
    moved = std::max(moved, (own[i] - start[i]).norm());
  }
  EXPECT_GT(moved, 1e-4);
  EXPECT_LT(apart, tolerance);
  std::printf("%g s: links have moved by up to %.2e m and are within %.1e m; CPU times %.1f s and %.1f s, ratio %.1f\n",
              end_time, moved, apart, own_cpu, cholesky_cpu, cholesky_cpu / own_cpu);
}

}  // namespace polybody::cholesky_tracks
