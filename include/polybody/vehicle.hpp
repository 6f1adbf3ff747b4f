#pragma once
/// \file
/// Headers for tracked vehicles: path of a track, contacts of its links, terrains, and checks of a track during a run.
/// Not in polybody.hpp: few programs need them.

#include <polybody/vehicle/height_field.hpp>
#include <polybody/vehicle/link_ground_contact.hpp>
#include <polybody/vehicle/link_roller_contact.hpp>
#include <polybody/vehicle/pin_sprocket_contact.hpp>
#include <polybody/vehicle/terrain.hpp>
#include <polybody/vehicle/track_checks.hpp>
#include <polybody/vehicle/track_path.hpp>
