#pragma once
/// \file
/// Ready parts of mechanisms: springs on joints, limits and impacts at limits, tyre laws and wheels.

#include <polybody/forces/limits.hpp>
#include <polybody/forces/scalar_force.hpp>
#include <polybody/forces/spring_laws.hpp>
#include <polybody/forces/tyre.hpp>
#include <polybody/run/impact_at_limit.hpp>
#include <polybody/vehicle/wheel.hpp>
