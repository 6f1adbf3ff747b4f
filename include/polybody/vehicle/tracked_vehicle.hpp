#pragma once
/// \file
/// What is asked about a vehicle's tracks in a state, whatever the formulation of their links and pins.
/// Not in polybody.hpp: of use to vehicles only.

#include <array>
#include <functional>
#include <vector>

#include <polybody/run/contacts.hpp>
#include <polybody/run/points.hpp>
#include <polybody/vehicle/m113.hpp>

namespace polybody::m113 {

/// One side.
struct Track {
  FrameIn sprocket, tensioner;                              ///< of their centres
  std::vector<FrameIn> front = {}, middle = {}, rear = {};  ///< of each link: front pin, middle, rear pin
  /// `for_each_contact` of what the links touch.
  std::function<void(System const&, TouchingPointVisit const&)> contacts = {};
};

/// The questions keep the bodies that they ask: they serve a copy of the vehicle, too.
struct TrackedVehicle {
  FrameIn hull;                 ///< of the chassis, at its centre of mass
  std::array<Track, 2> tracks;  ///< left, right

  Track const& track(Side s) const { return tracks[s == Side::left ? 0 : 1]; }  ///< the track of a side
};

}  // namespace polybody::m113
