#pragma once
/// \file
/// The exact motion of a pendulum, by Jacobi's elliptic functions.

#include <array>
#include <cmath>
#include <numbers>

namespace polybody {

/// θ¨ = −n² sin θ from rest at θ₀ (θ from the downward vertical): with k = sin(θ₀/2), u = n t,
///   sin(θ/2) = k cd u,   θ˙ = −2 k k′ n sd u      [R1; Abramowitz & Stegun 1964, 16.3, 16.4].
class ExactPendulum {
 public:
  struct Motion {
    double angle;         ///< [rad]
    double rate;          ///< [rad/s]
    double acceleration;  ///< [rad/s²]
  };

  /// \param release θ₀ [rad]  \param n2 n² [1/s²], for a rigid body m g l/(J + m l²)
  ExactPendulum(double release, double n2) : n_(std::sqrt(n2)), k_(std::sin(0.5 * release)) {
    // The arithmetic-geometric mean.
    double a = 1.0, b = std::sqrt(1.0 - k_ * k_);
    for (double& ratio : ratio_) {
      double const c = 0.5 * (a - b), mean = 0.5 * (a + b);
      b = std::sqrt(a * b);
      a = mean;
      ratio = c / a;
    }
    mean_ = a;
  }

  /// 4 K(k)/n [s].
  double period() const { return 2.0 * std::numbers::pi / (n_ * mean_); }

  Motion operator()(double t) const {
    double phi = std::ldexp(mean_ * n_ * t, levels);
    for (int i = levels; i-- > 0;) phi = 0.5 * (phi + std::asin(ratio_[std::size_t(i)] * std::sin(phi)));
    double const sn = std::sin(phi), cn = std::cos(phi), dn = std::sqrt(1.0 - k_ * k_ * sn * sn);
    double const angle = 2.0 * std::asin(k_ * cn / dn);
    return {angle, -2.0 * k_ * std::sqrt(1.0 - k_ * k_) * n_ * sn / dn, -n_ * n_ * std::sin(angle)};
  }

 private:
  static constexpr int levels = 6;
  double n_, k_, mean_ = 1.0;
  std::array<double, levels> ratio_{};  ///< c_i/a_i of the mean, i from 1
};

}  // namespace polybody
