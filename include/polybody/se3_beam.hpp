#pragma once
/// \file
/// Geometrically exact beam with helicoidal interpolation on SE(3): `Se3Beam`, and the operators of SE(3).

#include <polybody/bodies/se3/se3_beam.hpp>
