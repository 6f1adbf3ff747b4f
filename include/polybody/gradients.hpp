#pragma once
/// \file
/// Derivatives of whole runs with respect to parameters: `sensitivities` (forward) and `gradient` (adjoint), for all
/// families of integrators that support them.

#include <polybody/gradients/gradient.hpp>
#include <polybody/gradients/radau_linearised_step.hpp>
#include <polybody/gradients/radau_step_adjoint.hpp>
#include <polybody/gradients/runge_kutta_linearised_step.hpp>
#include <polybody/gradients/runge_kutta_step_adjoint.hpp>
#include <polybody/gradients/sensitivities.hpp>
