#pragma once
#include <polybody/joints/prescribed_angle.hpp>

namespace polybody {

/// Driving constraint a₃·(ω_b − ω_a) = ω(t) for the relative angular velocity [rad/s], such as the run-up of a sprocket
/// [thesis §4.5]. The constraint equation prescribes the angle ∫ω dt from t = 0, so that the angle does not drift. Use
/// it together with a Revolute.
///     PrescribedRate<SmoothRamp>{.law = {{.target = 25.0, .duration = 7.0, .start = 1.0}}, .axis = …}
template <HasIntegral Law>
using PrescribedRate = PrescribedAngle<IntegralOf<Law>>;

}  // namespace polybody
