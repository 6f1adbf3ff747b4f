#pragma once
/// \file Common parts of the tests of the spatial Lrvf: a bar with different values of all constants, and states
/// given section by section.

#include <gtest/gtest.h>

#include <polybody/bodies/lrvf/lrvf.hpp>

namespace polybody {

inline Bar spatial_lrvf_bar() {
  return {.length = 1.3,
          .constants = BarConstants{.EA = 900,
                                    .EI = 40,
                                    .mass_per_length = 2.0,
                                    .GA = 300,
                                    .GJ = 25,
                                    .rotary_inertia = 0.05,
                                    .EI_y = 60,
                                    .GA_z = 350,
                                    .rotary_inertia_y = 0.03},
          .placement = Placement::at({0.4, -0.3, 0.8}, {0.5, -1.0, 0.7}),
          .damping = {.axial = 0.01, .shear = 0.02, .bending = 0.03}};
}

/// FlexibleBodyLaws test elastic and damping forces; without rotary inertia there are no gyroscopic forces.
inline Bar without_rotary_inertia(Bar bar) {
  bar.constants->rotary_inertia = 0.0;
  bar.constants->rotary_inertia_y = 0.0;
  return bar;
}

inline std::span<double const> numbers(VecX const& x) { return {x.data(), std::size_t(x.size())}; }

/// q of the sections given node by node as `section(i)`, with the node number i.
template <class F>
VecX nodes_of(Index elements, F&& section) {
  VecX q(7 * (elements + 1));
  for (Index i = 0; i <= elements; ++i) {
    Placement const at = section(double(i));
    q.segment<3>(7 * i) = at.origin;
    q.segment<4>(7 * i + 3) = quaternion_of(at.axes);
  }
  return q;
}

/// All nodes, moved by the rigid motion x → origin + axes x.
inline VecX carried(Placement const& motion, VecX const& q) {
  return nodes_of(q.size() / 7 - 1, [&](double i) {
    Index const first = 7 * Index(i);
    return Placement{motion.origin + motion.axes * q.segment<3>(first),
                     motion.axes * rotation_matrix<double>(q.segment<4>(first + 3))};
  });
}

template <class B>
double strain_energy_of(B const& beam, VecX const& q) {
  double sum = 0.0;
  for (Index e = 0; e < beam.elements(); ++e) sum += beam.strain_energy(e, numbers(q));
  return sum;
}

}  // namespace polybody
