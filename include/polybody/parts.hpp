#pragma once
/// \file
/// Ready parts of mechanisms: springs on joints, limits and impacts at limits, friction of contacts and joints.

#include <polybody/forces/bristle_friction.hpp>
#include <polybody/forces/friction_laws.hpp>
#include <polybody/forces/limits.hpp>
#include <polybody/forces/reaction_friction.hpp>
#include <polybody/forces/scalar_force.hpp>
#include <polybody/forces/spherical_friction.hpp>
#include <polybody/forces/spring_laws.hpp>
#include <polybody/run/impact_at_limit.hpp>
