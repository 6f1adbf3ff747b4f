#pragma once
#include <polybody/joints/prescribed_angle.hpp>

namespace polybody {

/// One row: a₃·(ω_b − ω_a) = ω(t), a law of the relative angular velocity [rad/s], such as a sprocket's run-up
/// [thesis §4.5]. It is held as the angle ∫ω dt from t = 0, so the angle does not drift; use it beside a Revolute.
///     PrescribedRate<SmoothRamp>{.law = {{.target = 25.0, .duration = 7.0, .start = 1.0}}, .axis = …}
template <HasIntegral Law>
using PrescribedRate = PrescribedAngle<IntegralOf<Law>>;

}  // namespace polybody
