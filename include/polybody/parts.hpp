#pragma once
/// \file
/// Ready parts of mechanisms: tyre laws and wheels.

#include <polybody/forces/tyre.hpp>
#include <polybody/vehicle/wheel.hpp>
