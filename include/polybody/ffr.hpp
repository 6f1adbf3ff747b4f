#pragma once
/// \file
/// Bodies in the floating frame of reference formulation: `Ffr` and `planar::Ffr`, their modes, and structures from
/// beams or from the matrices of a finite element program. The headers include Eigen's sparse factorisations.

#include <polybody/bodies/ffr/attachment_modes.hpp>
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/ffr/matrix_structure.hpp>
#include <polybody/bodies/ffr/planar_ffr.hpp>
