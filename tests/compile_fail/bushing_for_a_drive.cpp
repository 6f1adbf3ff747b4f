// refused: Bushing does not support this geometry
// A driving constraint prescribes a motion; it has no free or constrained coordinates.
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/policies/bushing.hpp>

constexpr int rows = polybody::Joint<polybody::PrescribedAngle<polybody::Ramp>, polybody::Bushing>::rows;
