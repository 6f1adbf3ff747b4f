#pragma once
/// \file
/// Geometrically exact beams with one interpolation of position and rotation: `Se3Beam` and `planar::Se3Beam`.

#include <polybody/bodies/se3/planar_se3_beam.hpp>
#include <polybody/bodies/se3/se3_beam.hpp>
