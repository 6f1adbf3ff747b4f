#pragma once
/// \file
/// Von Mises stress of a three-dimensional stress state.
///
/// Not included in polybody.hpp: few programs need it.

#include <cmath>

#include <polybody/math/types.hpp>

namespace polybody {

/// Von Mises stress √(½ ((σ_xx − σ_yy)² + (σ_yy − σ_zz)² + (σ_zz − σ_xx)²) + 3 (τ_xy² + τ_yz² + τ_zx²)) [Pa] of a
/// stress s with the components xx, yy, zz, xy, yz, zx [von Mises 1913].
inline double von_mises(Vec6 const& s) {
  Vec3 const difference(s[0] - s[1], s[1] - s[2], s[2] - s[0]);
  return std::sqrt(0.5 * difference.squaredNorm() + 3.0 * s.tail<3>().squaredNorm());
}

}  // namespace polybody
