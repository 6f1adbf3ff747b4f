#pragma once
/// \file
/// Bodies of a vehicle that carry one of its tracks. For vehicles; not included by polybody.hpp.

#include <vector>

#include <polybody/run/marker_frames.hpp>
#include <polybody/vehicle/hull.hpp>
#include <polybody/vehicle/tracked_vehicle.hpp>

namespace polybody::m113 {

/// Bodies that carry one track.
template <class Base>
struct Carriers {
  /// Five road wheels and five arms, from the front; one sprocket, one idler and one tensioner.
  std::vector<BodyHandle<Base>> wheels = {}, arms = {}, sprocket = {}, idler = {}, tensioner = {};

  /// Stores the bodies of one side, and their frames in `track`. \param bodies the chassis and the bodies of `hull`
  void set(HullSide const& hull, std::vector<BodyHandle<Base>> const& bodies, Track& track) {
    sprocket = {bodies[hull.sprocket]};
    tensioner = {bodies[hull.tensioner]};
    idler = {bodies[hull.idler]};
    for (int i = 0; i < m113::wheels; ++i) {
      wheels.push_back(bodies[hull.wheel(i)]);
      arms.push_back(bodies[hull.arm(i)]);
    }
    track.sprocket = frame_in(sprocket[0], sprocket[0].at(Vec3(0, 0, 0)));
    track.tensioner = frame_in(tensioner[0], tensioner[0].at(Vec3(0, 0, 0)));
  }
};

}  // namespace polybody::m113
