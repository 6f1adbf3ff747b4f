#pragma once
/// \file Tyres of the tests of tyres and wheels.

#include <polybody/forces/tyre.hpp>

namespace polybody {

inline LinearTyre const linear_tyre{.longitudinal_stiffness = 6e4,
                                    .cornering_stiffness = 4e4,
                                    .longitudinal_friction = 1.1,
                                    .lateral_friction = 0.9,
                                    .camber_stiffness = 2e3,
                                    .trail = 0.03};
inline MagicFormula const magic_tyre{.longitudinal = MagicCurve{10.0, 1.9, 1.0, 0.97},
                                     .lateral = MagicCurve{12.3, 1.3, 0.92, -0.7},
                                     .aligning = {11.9, 2.4, -0.013, -2.6},
                                     .camber_factor = 0.05};

}  // namespace polybody
