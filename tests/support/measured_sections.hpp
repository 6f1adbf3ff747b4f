#pragma once
/// \file Sections given by matrices, for tests of bodies that accept them.

#include <polybody/bodies/shared/section6.hpp>

namespace polybody {

/// Composite section of Wang et al. 2017, in pounds, inches and seconds.
inline Section6 composite() {
  Section6 section;
  auto& c = section.stiffness;
  c.diagonal() << 1368.17e3, 88.56e3, 38.78e3, 16.96e3, 59.12e3, 141.47e3;
  c(3, 4) = c(4, 3) = 17.61e3;
  c(3, 5) = c(5, 3) = -0.351e3;
  c(4, 5) = c(5, 4) = -0.37e3;
  section.mass.diagonal() << 8.538e-2, 8.538e-2, 8.538e-2, 1.4433e-2, 0.40972e-2, 1.0336e-2;
  return section;
}
/// Section with the stiffness and mass of a rectangle of steel, without couplings.
inline Section6 uncoupled() {
  Vec6 c, m;
  c << 2e7, 6e6, 5e6, 900.0, 1500.0, 4000.0;
  m << 3.0, 3.0, 3.0, 5e-3, 2e-3, 3e-3;
  return {.stiffness = c.asDiagonal(), .mass = m.asDiagonal()};
}

}  // namespace polybody
