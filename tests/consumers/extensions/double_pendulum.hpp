#pragma once
// User-defined equations as a `System`: the requirements of the concept `polybody::UserMechanics`.
#include <polybody/polybody.hpp>
#include <polybody/system/user_system.hpp>

namespace own {

using namespace polybody;

/// Two uniform rods in a chain, with their angles from the vertical, φ = θ₁ − θ₂, k = ½ m₂ l₁ l₂:
///   M = [m₁ l₁²/3 + m₂ l₁², k cos φ; k cos φ, m₂ l₂²/3],
///   f = [−k sin φ θ̇₂² − (½ m₁ + m₂) g l₁ sin θ₁;  k sin φ θ̇₁² − ½ m₂ g l₂ sin θ₂].
struct DoublePendulum {
  double mass_1, mass_2;      ///< [kg]
  double length_1, length_2;  ///< [m]
  double g;                   ///< [m/s²]

  Index velocities() const { return 2; }
  void mass(VecX const& q, MatX& m) const {
    m(0, 0) = (mass_1 / 3.0 + mass_2) * length_1 * length_1;
    m(1, 1) = mass_2 / 3.0 * length_2 * length_2;
    m(0, 1) = m(1, 0) = coupling() * std::cos(q[0] - q[1]);
  }
  void force(VecX const& q, VecX const& v, double, VecX& f) const {
    double const s = coupling() * std::sin(q[0] - q[1]);
    f[0] = -s * v[1] * v[1] - weight_1() * std::sin(q[0]);
    f[1] = s * v[0] * v[0] - weight_2() * std::sin(q[1]);
  }
  /// −(ck ∂f/∂q + cd ∂f/∂v). Optional: without it, implicit steps use finite differences.
  void tangent(VecX const& q, VecX const& v, double, double ck, double cd, MatX& k) const {
    double const s = coupling() * std::sin(q[0] - q[1]), c = coupling() * std::cos(q[0] - q[1]);
    k(0, 0) = ck * (c * v[1] * v[1] + weight_1() * std::cos(q[0]));
    k(0, 1) = -ck * c * v[1] * v[1] + cd * 2.0 * s * v[1];
    k(1, 0) = -ck * c * v[0] * v[0] - cd * 2.0 * s * v[0];
    k(1, 1) = ck * (c * v[0] * v[0] + weight_2() * std::cos(q[1]));
  }
  double energy(VecX const& q, VecX const& v) const {
    MatX m(2, 2);
    mass(q, m);
    return 0.5 * v.dot(m * v) - weight_1() * std::cos(q[0]) - weight_2() * std::cos(q[1]);
  }

 private:
  double coupling() const { return 0.5 * mass_2 * length_1 * length_2; }
  double weight_1() const { return (0.5 * mass_1 + mass_2) * g * length_1; }
  double weight_2() const { return 0.5 * mass_2 * g * length_2; }
};

static_assert(UserMechanics<DoublePendulum> && HasForceTangent<DoublePendulum>);

}  // namespace own
