#pragma once
/// \file
/// Ready parts of mechanisms: springs on joints, limits and impacts at limits.

#include <polybody/forces/limits.hpp>
#include <polybody/forces/scalar_force.hpp>
#include <polybody/forces/spring_laws.hpp>
#include <polybody/run/impact_at_limit.hpp>
