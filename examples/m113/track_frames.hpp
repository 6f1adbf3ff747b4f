#pragma once
/// \file
/// Frames and contacts of a vehicle's tracks in a state, for any formulation of links and pins.

#include <array>
#include <functional>
#include <vector>

#include <polybody/run/applied_wrenches.hpp>
#include <polybody/run/marker_frames.hpp>

#include "data.hpp"

namespace polybody::m113 {

/// Frames and contacts of one track.
struct Track {
  FrameIn sprocket, tensioner;                              ///< frames of the centres
  std::vector<FrameIn> front = {}, middle = {}, rear = {};  ///< frames of each link: front pin, middle, rear pin
  /// Calls a visitor for each contact of the links (`for_each_contact`).
  std::function<void(System const&, TouchingPointVisit const&)> contacts = {};
};

/// Frames and contacts of both tracks. The functions share ownership of the bodies that they evaluate, so they are also
/// valid for a copy of the vehicle.
struct TrackedVehicle {
  FrameIn hull;                 ///< frame of the chassis at its centre of mass
  std::array<Track, 2> tracks;  ///< left, right

  Track const& track(Side s) const { return tracks[s == Side::left ? 0 : 1]; }  ///< track of the side s
};

}  // namespace polybody::m113
