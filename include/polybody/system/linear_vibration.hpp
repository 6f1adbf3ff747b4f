#pragma once
/// \file
/// M q̈ + D(t) q̇ + K(t) q = f(t) as a system, so that every integrator of the library solves a linear problem.
///
/// Not in polybody.hpp: few programs need it.

#include <polybody/system/user_system.hpp>

namespace polybody {

/// f(t) into `f` (n).
template <class L>
concept LoadHistory = requires(L const load, double t, VecX f) { load(t, f); };
/// A load that changes damping and stiffness (n×n) in time, too: it adds to them.
template <class L>
concept TimeVaryingMatrices = requires(L const load, double t, MatX d, MatX k) { load.add_matrices(t, d, k); };

/// M q̈ + D q̇ + K q = f(t) as equations of `UserMechanics`.
template <LoadHistory Load>
struct LinearVibration {
  MatX mass_matrix, damping, stiffness;  ///< (n×n)
  Load load;                             ///< f(t)
  mutable MatX d = {}, k = {};           ///< scratch: both at one time

  /// How many coordinates the problem has: n.
  Index velocities() const { return mass_matrix.rows(); }
  /// M (n×n), to m.
  void mass(VecX const&, MatX& m) const { m = mass_matrix; }
  /// f(t) − D q̇ − K q at t [s], into `f` (n).
  void force(VecX const& q, VecX const& v, double t, VecX& f) const {
    load(t, f);
    update(t);
    f.noalias() -= d * v;
    f.noalias() -= k * q;
  }
  /// ck K + cd D at t [s], into `out` (n×n).
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
