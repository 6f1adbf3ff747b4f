#pragma once
/// \file
/// Further formulations: interpolations of rotations for LRVF, Cholesky coordinates for ANCF, bodies of variable mass,
/// and systems with user-defined equations of motion.

#include <polybody/bodies/ancf/cholesky_coordinates.hpp>
#include <polybody/bodies/lrvf/director_interpolation.hpp>
#include <polybody/bodies/lrvf/incremental_interpolation.hpp>
#include <polybody/bodies/lrvf/polar_interpolation.hpp>
#include <polybody/bodies/rigid/variable_mass.hpp>
#include <polybody/system/user_system.hpp>
