#pragma once
/// \file
/// Distance of a point from a path in a plane, such as the distance of a link from the path of another link. For
/// vehicles; not included by polybody.hpp.

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <polybody/math/errors.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// Distance from p to the nearest point of the straight lines between consecutive corners [m]. Corners may coincide.
/// The first corner of a closed path is repeated at its end.
/// \throws InvalidInput for a path without corners
template <class = void>  // compiled only if it is used
double distance_to_path(Vec2 const& p, std::span<Vec2 const> corners) {
  if (corners.empty()) throw InvalidInput("path.empty", {"The path has no point. Give at least one point."});
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
