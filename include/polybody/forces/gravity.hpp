#pragma once
/// \file
/// Uniform gravitational field of a model.

#include <polybody/math/types.hpp>

namespace polybody {

/// Uniform gravitational field of a model. Every body computes its weight from this field.
/// Theory: Eq. 3.4.
struct Gravity {
  Vec3 g = Vec3::Zero();  ///< (3) acceleration of gravity, world axes [m/s²]

  Gravity() = default;
  /// Field with components x, y, z along world axes [m/s²]. \throws InvalidInput if a component is not finite.
  Gravity(double x, double y, double z) : Gravity(Vec3(x, y, z)) {}
  explicit Gravity(Vec3 const& field) : g(field) { require_finite(g, "Gravity"); }  ///< `field` (3), world axes [m/s²]
};

}  // namespace polybody
