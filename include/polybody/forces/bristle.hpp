#pragma once
/// \file
/// Elastic bristle in series with a Coulomb slider.
/// Theory: Eq. 9.38.

#include <polybody/forces/force_element.hpp>

namespace polybody::detail {

/// Factor s ≤ 1 of the trial force σ₀ z + σ₁ v of a bristle, so that its size does not exceed the `limit`. \param
/// square squared size of the trial force
template <StateScalar T>
T held_share(T const& square, T const& limit) {
  using std::sqrt;
  double const most = value_of(limit);
  if (!(value_of(square) > most * most)) return T(1.0);
  return limit / sqrt(square);
}

}  // namespace polybody::detail
