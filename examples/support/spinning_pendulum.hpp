#pragma once
// The very flexible pendulum of Gerstmayr and of Chrono's utest_FEA_ANCFCable (case D6a): hinged at the origin along
// +x, gravity along −y, spinning at 4 rad/s about +y.
#include <polybody/bodies/shared/bar.hpp>

namespace polybody::spinning_pendulum {

// GA, GJ and Iρ are those of the reference, which does not depend on them.
inline Bar bar() {
  return {.length = 1.0,
          .constants = BarConstants{.EA = 40.0,
                                    .EI = 7.957747154594767e-5,
                                    .mass_per_length = 8e-3,
                                    .GA = 15.0,
                                    .GJ = 6e-5,
                                    .rotary_inertia = 1.59e-8}};
}

}  // namespace polybody::spinning_pendulum
