#pragma once
/// \file
/// Catenary: curve of an inextensible cable without bending stiffness under its own weight.

#include <cmath>

#include <polybody/bodies/shared/bar.hpp>

namespace polybody {

/// Catenary of a cable between the origin and `end`, as a function of its arc length s, for `from(bar, n, catenary(…))`
/// or as an undeformed shape [Irvine 1981, ch. 1]. With sinh u = sinh u₀ + s/a,
///   x = a (u − u₀) along the horizontal,  z = a (cosh u − cosh u₀) upwards,
///   2a sinh(d/2a) = √(L² − h²),  u₀ = artanh(h/L) − d/2a,
/// with the ratio a of the horizontal force to the weight per length [m], the span d [m] and the rise h [m] of `end`.
/// The y axis of the section lies in the plane of the curve.
/// \param end (3) position of the second end, in the axes of the bar [m] \param length L [m], greater than |end|
/// \param down (3) direction of the weight, in the axes of the bar; any length
/// \throws InvalidInput for L ≤ (1 + 1e-9) |end|, for d ≤ 1e-6 L (ends on one vertical line), for `down` = 0, and for
/// numbers that are not finite.
template <class = void>  // compiled only if used
ReferenceCurve catenary(Vec3 const& end, double length, Vec3 const& down) {
  require_finite(end, "catenary: the end");
  require_finite(down, "catenary: the direction of the weight");
  require_positive(length, "catenary: the length");
  double const size = down.norm();
  if (!(size > 0.0))
    throw InvalidInput("catenary.weight",
                       {ErrorObject{"catenary"}, ": the direction of the weight is zero. Give a nonzero vector."});
  Vec3 const up = -down / size;
  double const h = up.dot(end);
  Vec3 along = end - h * up;
  double const d = along.norm();
  if (!(length > (1.0 + 1e-9) * end.norm()))
    throw InvalidInput("catenary.length", {ErrorObject{"catenary"}, ": the length of ", ErrorValue{length},
                                           " m must exceed the distance of the ends, ", end.norm(),
                                           " m. Use a straight line for a taut cable."});
  if (!(d > 1e-6 * length))
    throw InvalidInput("catenary.vertical",
                       {ErrorObject{"catenary"}, ": the horizontal distance of the ends is ", ErrorValue{d},
                        " m, but must be at least ", 1e-6 * length, " m, 1e-06 of the length. Move one end sideways."});
  along /= d;
  // Newton's method for sinh x = r x. It starts above the root, where sinh x − r x is convex. Upper bounds of the root
  // follow from x² < 6 (r − 1) and x = ln 2r + ln x + …
  double const r = std::sqrt((length - h) * (length + h)) / d;
  double x = std::min(std::sqrt(6.0 * (r - 1.0)), std::log(2.0 * r) + std::log1p(std::log(2.0 * r)) + 1.0);
  for (int k = 0; k < 100; ++k) {
    double const step = (std::sinh(x) - r * x) / (std::cosh(x) - r);
    x -= step;
    if (std::abs(step) <= 1e-15 * x) break;
  }
  double const a = 0.5 * d / x, u0 = std::atanh(h / length) - x;
  return [=](double s) {
    double const u = std::asinh(std::sinh(u0) + s / a);
    Placement section;
    section.origin = a * (u - u0) * along + a * (std::cosh(u) - std::cosh(u0)) * up;
    Vec3 const tangent = (along + std::sinh(u) * up) / std::cosh(u),
               normal = (up - std::sinh(u) * along) / std::cosh(u);
    section.axes << tangent, normal, tangent.cross(normal);
    return section;
  };
}

}  // namespace polybody
