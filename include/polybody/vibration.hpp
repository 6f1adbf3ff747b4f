#pragma once
/// \file
/// Modes, damped modes, buckling loads, steady rotation, and `diagnose`, the report on a model and its state. The
/// headers include Eigen's eigenvalue solvers.

#include <polybody/run/advice.hpp>
#include <polybody/run/diagnose.hpp>
#include <polybody/vibration/buckling.hpp>
#include <polybody/vibration/modes.hpp>
#include <polybody/vibration/steady_rotation.hpp>
