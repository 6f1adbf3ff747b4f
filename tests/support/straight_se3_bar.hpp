#pragma once
/// \file Straight bar and states of constant strain for tests of Se3Beam.

#include <polybody/math/se3.hpp>

#include "support/spatial_lrvf.hpp"

namespace polybody {

/// Bar of the tests of Lrvf along the x axis.
inline Bar straight_bar() {
  Bar bar = spatial_lrvf_bar();
  bar.placement = {};
  return bar;
}
/// Section at the arc length s of a rod with the constant strains (Γ, K), and its first section at the origin.
inline Placement helix(Vec6 const& strains, double s) {
  Vec3 const pull = (Vec3::UnitX() + strains.head<3>()) * s, turn = strains.tail<3>() * s;
  auto const h = exp_se3<double>({pull, turn});
  return {.origin = h.r, .axes = h.A};
}
inline Vec6 six(double a, double b, double c, double d, double e, double f) {
  return (Vec6() << a, b, c, d, e, f).finished();
}

}  // namespace polybody
