#pragma once
/// \file
/// How far a point is from a path in a plane, such as a link from the way of another. Not in polybody.hpp: of use to
/// vehicles only.

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <polybody/math/errors.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// Distance of p to the nearest point of the straight lines from each corner to the next [m]. Corners may coincide. A
/// closed path has its first corner once more at its end.
/// \throws InvalidInput for a path without corners
template <class = void>  // compiled where it is used
double distance_to_path(Vec2 const& p, std::span<Vec2 const> corners) {
  if (corners.empty()) throw InvalidInput("A path without corners is near to nothing. Give it one corner or more.");
  double nearest = (p - corners.front()).squaredNorm();
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    Vec2 const along = corners[i + 1] - corners[i], to = p - corners[i];
    double const share =
        std::clamp(to.dot(along) / std::max(along.squaredNorm(), std::numeric_limits<double>::min()), 0.0, 1.0);
    nearest = std::min(nearest, (to - share * along).squaredNorm());
  }
  return std::sqrt(nearest);
}

}  // namespace polybody
