#pragma once
/// \file
/// Differential: distributes the torque of a carrier to two shafts on the same axis.
/// Theory: Eq. 3.28.

#include <numbers>

#include <polybody/forces/force_element.hpp>
#include <polybody/joints/angle.hpp>

namespace polybody {

/// Open differential between a carrier c and two shafts l and r on the third axis a of the carrier's marker. With the
/// angles θ of the shafts relative to the carrier, the twist φ = (θ_l + θ_r)/2 vanishes in an ideal differential:
/// ω_l + ω_r = 2 ω_c. The gears have a stiffness and a damping. The torque M = −(k φ + c φ˙) acts as M/2 on each shaft
/// and as −M on the carrier, so both shafts always receive equal torques. Joints connect two bodies, so this is a force
/// element; a differential without compliance consists of a planet gear for each shaft and three `Gear` joints. The
/// state z = 2 ∫φ˙ dt selects the number of full turns in θ_l + θ_r, so the twist itself does not drift.
struct Differential {
  static constexpr int markers = 3, states = 1;  ///< carrier, first shaft, second shaft; the angle z [rad]
  static constexpr bool is_load = false;
  static constexpr MarkerKind needs = MarkerKind::frame;

  Required<double> stiffness;  ///< k [N m/rad]: torque of the carrier per twist, both shafts held
  Required<double> damping;    ///< c [N m s/rad]

  void check(std::string const& name) const {
    require_positive(stiffness, name, ": the stiffness", "N m/rad");
    require_not_negative(damping, name, ": the damping", "N m s/rad");
  }

  template <StateScalar T>
  std::array<Wrench<T>, 3> wrenches(std::array<Frame<T>, 3> const& f, std::array<T, 1> const& z, double) const {
    T const half = (twist(f, z) * stiffness.value + rate(f) * damping.value) * -0.5;
    std::array<Wrench<T>, 3> w;
    for (int i = 0; i < 3; ++i) {
      w[1].m[i] = w[2].m[i] = f[0].A(i, 2) * half;
      w[0].m[i] = f[0].A(i, 2) * half * -2.0;
    }
    return w;
  }
  /// Rate of the state [rad/s]; `f` are the frames of carrier and shafts.
  template <StateScalar T>
  std::array<T, 1> rates(std::array<Frame<T>, 3> const& f, std::array<T, 1> const&, double) const {
    return {rate(f) * 2.0};
  }
  /// Energy of the gears, ½ k φ² [J]; `f` are the frames of carrier and shafts, z is the state.
  double potential(std::array<Frame<double>, 3> const& f, std::array<double, 1> const& z, double) const {
    double const x = twist(f, z);
    return 0.5 * stiffness * x * x;
  }
  /// Power lost by the change of the state: zero, because the state selects the number of turns only.
  double dissipation(std::array<Frame<double>, 3> const&, std::array<double, 1> const&, double) const { return 0.0; }

  /// Twist φ of the gears [rad]; `f` are the frames of carrier and shafts, `z` is the state.
  template <StateScalar T>
  T twist(std::array<Frame<T>, 3> const& f, std::array<T, 1> const& z) const {
    using constraint_functions::angle, constraint_functions::turned;
    T const both = angle(turned(f[0], f[1])).g[0] + angle(turned(f[0], f[2])).g[0];
    double const turn = 2.0 * std::numbers::pi;
    return (both + turn * std::nearbyint((value_of(z[0]) - value_of(both)) / turn)) * 0.5;
  }

 private:
  /// φ˙ = a·((ω_l + ω_r)/2 − ω_c) [rad/s].
  template <StateScalar T>
  static T rate(std::array<Frame<T>, 3> const& f) {
    T sum(0.0);
    for (int i = 0; i < 3; ++i) sum += f[0].A(i, 2) * ((f[1].w[i] + f[2].w[i]) * 0.5 - f[0].w[i]);
    return sum;
  }
};

}  // namespace polybody
