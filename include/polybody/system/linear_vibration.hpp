#pragma once
/// \file
/// Linear vibration problem M q̈ + D(t) q̇ + K(t) q = f(t) as a system for every integrator of the library.

#include <polybody/system/user_system.hpp>

namespace polybody {

/// Load history: `load(t, f)` writes f(t) to `f` (n).
template <class L>
concept LoadHistory = requires(L const load, double t, VecX f) { load(t, f); };
/// Load with time-varying damping and stiffness (n×n): `add_matrices` adds their changes at time t to d and k.
template <class L>
concept TimeVaryingMatrices = requires(L const load, double t, MatX d, MatX k) { load.add_matrices(t, d, k); };

/// M q̈ + D q̇ + K q = f(t) as equations of `UserMechanics`.
template <LoadHistory Load>
struct LinearVibration {
  MatX mass_matrix, damping, stiffness;  ///< (n×n) M, constant parts of D and K
  Load load;                             ///< f(t)
  mutable MatX d = {}, k = {};           ///< workspace: D(t) and K(t) of the last evaluation

  /// Number n of coordinates.
  Index velocities() const { return mass_matrix.rows(); }
  /// Writes M (n×n) to m.
  void mass(VecX const&, MatX& m) const { m = mass_matrix; }
  /// Writes f(t) − D q̇ − K q at t [s] to `f` (n).
  void force(VecX const& q, VecX const& v, double t, VecX& f) const {
    load(t, f);
    update(t);
    f.noalias() -= d * v;
    f.noalias() -= k * q;
  }
  /// Writes ck K + cd D at t [s] to `out` (n×n).
  void tangent(VecX const&, VecX const&, double t, double ck, double cd, MatX& out) const {
    update(t);
    out = ck * k + cd * d;
  }

 private:
  void update(double t) const {
    d = damping;
    k = stiffness;
    if constexpr (TimeVaryingMatrices<Load>) load.add_matrices(t, d, k);
  }
};

}  // namespace polybody
