#pragma once
#include <polybody/math/types.hpp>

namespace polybody {

/// Uniform gravity, a property of the model: every body turns it into its own force.
struct Gravity {
  Vec3 g = Vec3::Zero();  ///< (3) world axes [m/s²]

  Gravity() = default;
  /// From components along world axes [m/s²]: x, y, z. \throws InvalidInput when a component is not finite.
  Gravity(double x, double y, double z) : Gravity(Vec3(x, y, z)) {}
  explicit Gravity(Vec3 const& field) : g(field) { require_finite(g, "Gravity"); }  ///< `field` (3), world axes [m/s²]
};

}  // namespace polybody
