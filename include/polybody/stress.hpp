#pragma once
/// \file
/// Stresses of flexible bodies, stresses of recorded rigid bodies after a run, and their evaluation: filters, rainflow
/// counts and damage.

#include <polybody/run/body_record.hpp>
#include <polybody/run/marker_frames.hpp>
#include <polybody/signals/filter.hpp>
#include <polybody/signals/rainflow.hpp>
#include <polybody/signals/samples.hpp>
#include <polybody/stress/decoupled_stress.hpp>
#include <polybody/stress/nodal_stress.hpp>
