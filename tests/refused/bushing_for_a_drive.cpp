// refused: A bushing stands in for a joint of bodies
// A drive prescribes a motion; it has no coordinates that are free or held.
#include <polybody/joints/joint.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/prescribed_angle.hpp>

constexpr int rows = polybody::Joint<polybody::PrescribedAngle<polybody::Ramp>, polybody::Bushing>::rows;
