#pragma once
// The beam of Kane, Ryan & Banerjee 1987, whose first section turns with a prescribed spin-up (case D2).
#include <polybody/bodies/shared/bar.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/math/time_functions.hpp>

namespace polybody::spin_up {

using Drive = Joint<PrescribedAngle<SpinUp>, Constraint>;
inline Drive drive() { return {{{.speed = 6.0, .duration = 15.0}, Vec3::UnitZ()}, {}}; }

/// Constants of D2. EI_y and GJ are arbitrary: the motion is planar.
inline Bar arm() {
  return {
      .length = 10.0,
      .constants = BarConstants{
          .EA = 2.8e7, .EI = 1.4e4, .mass_per_length = 1.2, .GA = 1e7, .GJ = 5e3, .rotary_inertia = 6e-4, .EI_y = 9e3}};
}

}  // namespace polybody::spin_up
