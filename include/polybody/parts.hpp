#pragma once
/// \file
/// Ready parts of mechanisms: springs on joints, limits, impacts at limits, and drives (servos, motors, belts,
/// differentials).

#include <polybody/forces/belt.hpp>
#include <polybody/forces/differential.hpp>
#include <polybody/forces/limits.hpp>
#include <polybody/forces/motors.hpp>
#include <polybody/forces/scalar_force.hpp>
#include <polybody/forces/servo.hpp>
#include <polybody/forces/spring_laws.hpp>
#include <polybody/run/belt_spans.hpp>
#include <polybody/run/impact_at_limit.hpp>
