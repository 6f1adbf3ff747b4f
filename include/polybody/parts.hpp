#pragma once
/// \file
/// Ready parts of mechanisms: springs, stops, ropes, winches, friction, servos and motors along the coordinate of a
/// joint, impacts at stops, belts, differentials, contact shapes, friction that sticks, tyres and wheels.

#include <polybody/forces/belt.hpp>
#include <polybody/forces/bristle_friction.hpp>
#include <polybody/forces/contact_set.hpp>
#include <polybody/forces/differential.hpp>
#include <polybody/forces/friction_laws.hpp>
#include <polybody/forces/limits.hpp>
#include <polybody/forces/motors.hpp>
#include <polybody/forces/reaction_friction.hpp>
#include <polybody/forces/scalar_force.hpp>
#include <polybody/forces/servo.hpp>
#include <polybody/forces/shapes/box_contact.hpp>
#include <polybody/forces/shapes/capsule_contact.hpp>
#include <polybody/forces/shapes/compound.hpp>
#include <polybody/forces/shapes/shapes_on_plane.hpp>
#include <polybody/forces/spherical_friction.hpp>
#include <polybody/forces/spring_laws.hpp>
#include <polybody/forces/tyre.hpp>
#include <polybody/run/belt_spans.hpp>
#include <polybody/run/impact_at_limit.hpp>
#include <polybody/vehicle/wheel.hpp>
