#pragma once
/// \file
/// Derivatives of whole runs with respect to parameters: `sensitivities` (forward) and `gradient` (adjoint), for all
/// families of integrators that support them.

#include <polybody/gradients/gradient.hpp>
#include <polybody/gradients/sensitivities.hpp>
