#pragma once
/// \file
/// Test suites of the properties that bodies, joints, policies, forces, contacts, integrators and solvers must have.
/// Requires GoogleTest.

#include <polybody/testing/body_laws.hpp>
#include <polybody/testing/contact_laws.hpp>
#include <polybody/testing/contact_shape_laws.hpp>
#include <polybody/testing/flexible_body_laws.hpp>
#include <polybody/testing/force_laws.hpp>
#include <polybody/testing/integrator_laws.hpp>
#include <polybody/testing/joint_laws.hpp>
#include <polybody/testing/linear_solver_laws.hpp>
#include <polybody/testing/policy_laws.hpp>
#include <polybody/testing/user_system_laws.hpp>
