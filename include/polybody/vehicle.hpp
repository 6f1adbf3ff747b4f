#pragma once
/// \file
/// Headers for tracked vehicles: path of a track, contacts of its links, terrains, and checks of a track during a run.

#include <polybody/vehicle/link_ground_contact.hpp>
#include <polybody/vehicle/link_roller_contact.hpp>
#include <polybody/vehicle/pin_sprocket_contact.hpp>
#include <polybody/vehicle/terrain.hpp>
#include <polybody/vehicle/track_checks.hpp>
#include <polybody/vehicle/track_path.hpp>
