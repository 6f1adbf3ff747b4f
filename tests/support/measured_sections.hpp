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
/// Box of six plies at 15° in all walls, 0.953 in × 0.530 in outside, t = 0.03 in, in pounds and inches [Yu, Hodges &
/// Ho 2012]. The mass follows from the density 1.353e-4 lb s²/in⁴ of the thin walls.
inline Section6 box_beam() {
  Section6 section;
  auto& c = section.stiffness;
  c.diagonal() << 1.437e6, 9.027e4, 3.943e4, 1.679e4, 6.621e4, 1.725e5;
  c(0, 3) = c(3, 0) = 1.074e5;
  c(1, 4) = c(4, 1) = -5.201e4;
  c(2, 5) = c(5, 2) = -5.635e4;
  section.mass.diagonal() << 1.156e-5, 1.156e-5, 1.156e-5, 1.87e-6, 0.53e-6, 1.34e-6;
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
