#pragma once
/// \file
/// Headers for parts of mechanisms: drives (servos, motors, belts, differentials).

#include <polybody/forces/belt.hpp>
#include <polybody/forces/differential.hpp>
#include <polybody/forces/motors.hpp>
#include <polybody/forces/servo.hpp>
