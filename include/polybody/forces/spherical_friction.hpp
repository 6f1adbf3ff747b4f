#pragma once
/// \file
/// Dry friction in a spherical joint: a moment along the relative angular velocity of two markers.
/// Theory: Eqs. 9.31, 9.40.

#include <polybody/forces/bristle.hpp>
#include <polybody/forces/friction_laws.hpp>

namespace polybody {

/// Friction moment −(g(ω)/√(ω² + ω_0²) + c) ω on b, with the angular velocity ω of b relative to a.
struct SphericalFriction {
  static constexpr int markers = 2;
  static constexpr bool is_load = false;
  static constexpr MarkerKind needs = MarkerKind::frame;

  FrictionCurve curve;          ///< friction in steady rotation
  Required<double> slip_speed;  ///< ω_0 [rad/s]

  void check(std::string const& name) const { DryFriction{curve, slip_speed}.check(name, detail::AngleBetween::units); }
  template <StateScalar T>
  std::array<Wrench<T>, 2> wrenches(std::array<Frame<T>, 2> const& f, double) const {
    using std::sqrt;
    Vec<T, 3> const w = f[1].w - f[0].w;
    T const speed2 = w.dot(w);
    T const ratio = curve.limit<T>(speed2) / sqrt(T(speed2 + slip_speed * slip_speed)) + curve.viscous;
    std::array<Wrench<T>, 2> out;
    for (int i = 0; i < 3; ++i) {
      out[0].m[i] = w[i] * ratio;
      out[1].m[i] = -out[0].m[i];
    }
    return out;
  }
  /// Zero: friction stores no energy [J].
  template <StateScalar T>
  T potential(std::array<Frame<T>, 2> const&, double) const {
    return T(0.0);
  }
};

/// Friction moment −R on b of a spherical joint that sticks without creep. R is σ₀ z + σ₁ ω, shortened to the length of
/// the sliding friction, and ż = (R − σ₀ z)/σ₁ with the deflection z of a bristle in the axes of a [rad]. Compare
/// `BristleFriction`.
struct SphericalBristleFriction {
  static constexpr int markers = 2, states = 3;  ///< two markers; the deflection of the bristle
  static constexpr bool is_load = false;
  static constexpr MarkerKind needs = MarkerKind::frame;

  Required<double> sliding;    ///< sliding friction [N m]
  Required<double> stiffness;  ///< σ₀ [N m/rad]
  Required<double> damping;    ///< σ₁ [N m s/rad]

  void check(std::string const& name) const {
    ScalarUnits const& units = detail::AngleBetween::units;
    ScalarUnits::require_not_negative(sliding, units.force, name, ": the sliding friction");
    ScalarUnits::require_positive(stiffness, units.stiffness, name, ": the bristle stiffness of the friction");
    ScalarUnits::require_positive(damping, units.damping, name, ": the bristle damping of the friction");
  }
  template <StateScalar T>
  std::array<Wrench<T>, 2> wrenches(std::array<Frame<T>, 2> const& f, std::array<T, 3> const& z, double) const {
    std::array<Wrench<T>, 2> out;
    Vec<T, 3> const r = resistance<T>(f, z);
    for (int i = 0; i < 3; ++i) {
      out[0].m[i] = f[0].A(i, 0) * r[0] + f[0].A(i, 1) * r[1] + f[0].A(i, 2) * r[2];
      out[1].m[i] = -out[0].m[i];
    }
    return out;
  }
  template <StateScalar T>
  std::array<T, 3> rates(std::array<Frame<T>, 2> const& f, std::array<T, 3> const& z, double) const {
    Vec<T, 3> const r = resistance<T>(f, z);
    std::array<T, 3> rate;
    for (int i = 0; i < 3; ++i) rate[std::size_t(i)] = (r[i] - z[std::size_t(i)] * stiffness.value) * (1.0 / damping);
    return rate;
  }
  /// Energy of the bristle, ½ σ₀ z² [J].
  double potential(std::array<Frame<double>, 2> const&, std::array<double, 3> const& z, double) const {
    return 0.5 * stiffness * (z[0] * z[0] + z[1] * z[1] + z[2] * z[2]);
  }
  /// Power R₀·ω − σ₀ z·ż that slip dissipates, with R₀ = R at the velocity zero [W].
  double dissipation(std::array<Frame<double>, 2> const& f, std::array<double, 3> const& z, double t) const {
    auto at_rest = f;
    for (Frame<double>& x : at_rest) x.w = Vec3::Zero();
    Vec3 const held = resistance<double>(at_rest, z), w = f[0].A.transpose() * (f[1].w - f[0].w);
    auto const rate = rates<double>(f, z, t);
    double sum = held.dot(w);
    for (std::size_t i = 0; i < 3; ++i) sum -= stiffness * z[i] * rate[i];
    return sum;
  }

 private:
  /// R (3) in the axes of a [N m].
  template <StateScalar T>
  Vec<T, 3> resistance(std::array<Frame<T>, 2> const& f, std::array<T, 3> const& z) const {
    Vec<T, 3> r;
    for (int i = 0; i < 3; ++i) {
      T w(0.0);
      for (int k = 0; k < 3; ++k) w += f[0].A(k, i) * (f[1].w[k] - f[0].w[k]);
      r[i] = z[std::size_t(i)] * stiffness.value + w * damping.value;
    }
    T const share = detail::held_share<T>(T(r.dot(r)), T(sliding.value));
    for (int i = 0; i < 3; ++i) r[i] = r[i] * share;
    return r;
  }
};

}  // namespace polybody
