#pragma once
/// \file
/// Check of an inertia tensor.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <polybody/math/errors.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

namespace detail {

/// Returns true if the symmetric matrix a + shift·1 is positive definite, that is, if all its pivots are positive.
template <class = void>  // compiled only if used
bool is_definite(Mat3 const& a, double shift) {
  double const d0 = a(0, 0) + shift, l10 = a(1, 0) / d0, l20 = a(2, 0) / d0;
  double const d1 = a(1, 1) + shift - l10 * a(1, 0), c21 = a(2, 1) - l20 * a(1, 0);
  double const d2 = a(2, 2) + shift - l20 * a(2, 0) - c21 * c21 / d1;
  return d0 > 0.0 && d1 > 0.0 && d2 > 0.0;
}

/// Eigenvalues of a symmetric matrix, descending, accurate to 1e-8 of the largest, for messages [Smith 1961].
template <class = void>  // compiled only if used
std::array<double, 3> principal_values(Mat3 const& a) {
  double const mean = (a(0, 0) + a(1, 1) + a(2, 2)) / 3.0;
  double const x = a(0, 0) - mean, y = a(1, 1) - mean, z = a(2, 2) - mean;
  double const u = a(1, 0), v = a(2, 0), w = a(2, 1);
  double const p = std::sqrt((x * x + y * y + z * z + 2.0 * (u * u + v * v + w * w)) / 6.0);
  double const det = x * (y * z - w * w) - u * (u * z - v * w) + v * (u * w - v * y);
  double const angle = p > 0.0 ? std::acos(std::clamp(0.5 * det / (p * p * p), -1.0, 1.0)) / 3.0 : 0.0;
  double const largest = mean + 2.0 * p * std::cos(angle);
  double const least = mean + 2.0 * p * std::cos(angle + 2.0 * std::numbers::pi / 3.0);
  return {largest, 3.0 * mean - largest - least, least};
}

}  // namespace detail

/// Requires an inertia tensor that a distribution of mass can have.
/// \throws InvalidInput, with a message that begins with `what`, unless `inertia` J is symmetric with entries up to
/// `largest_number`, no principal moment is negative, and none exceeds the sum of the other two (½ tr(J) 1 − J ⪰ 0).
/// The tolerance is 1e-9 of the largest entry.
template <class = void>  // compiled only if used
[[gnu::cold]] void require_inertia(Mat3 const& inertia, std::string const& what) {
  require_finite(inertia, what, ": the inertia");
  double const size = std::max({std::abs(inertia(0, 0)), std::abs(inertia(1, 1)), std::abs(inertia(2, 2)),
                                std::abs(inertia(1, 0)), std::abs(inertia(2, 0)), std::abs(inertia(2, 1)),
                                std::abs(inertia(0, 1)), std::abs(inertia(0, 2)), std::abs(inertia(1, 2))});
  if (size == 0.0) return;
  if (size > largest_number)
    throw InvalidInput("value.magnitude",
                       {ErrorObject{what}, ": the inertia tensor has an entry of ", ErrorValue{size}, " kg m², beyond ",
                        largest_number, " kg m², the largest allowed magnitude."});
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < i; ++j)
      if (std::abs(inertia(i, j) - inertia(j, i)) > 1e-9 * size)
        throw InvalidInput("rigid.inertia", {ErrorObject{what}, ": the inertia tensor must be symmetric, but entries (",
                                             j, ", ", i, ") and (", i, ", ", j, "), counted from 0, differ by ",
                                             ErrorValue{std::abs(inertia(i, j) - inertia(j, i))}, " kg m²."});
  if (!detail::is_definite(inertia, 1e-9 * size))
    throw InvalidInput("rigid.inertia", {ErrorObject{what}, ": a principal moment of inertia is negative (",
                                         ErrorValue{detail::principal_values(inertia)[2]}, " kg m²)."});
  Mat3 second;
  double const half_trace = 0.5 * (inertia(0, 0) + inertia(1, 1) + inertia(2, 2));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) second(i, j) = i == j ? half_trace - inertia(i, j) : -inertia(i, j);
  if (!detail::is_definite(second, 1e-9 * size)) {
    std::array<double, 3> const i = detail::principal_values(inertia);
    throw InvalidInput("rigid.inertia",
                       {ErrorObject{what}, ": the principal moments of inertia ", i[0], ", ", i[1], ", ", i[2],
                        " kg m² violate the triangle inequality: the largest exceeds the sum of the others."});
  }
}

}  // namespace polybody
