#pragma once
/// \file
/// Vectors of a step of the generalised-α family, independent of the type of the model.

#include <polybody/math/sequence.hpp>
#include <polybody/solvers/anderson.hpp>
#include <polybody/system/state.hpp>

namespace polybody {

/// Vectors of a step of the generalised-α family, independent of the type of the model.
struct AlphaVectors {
  VecX v0, a0;  ///< generalised velocities and algorithmic accelerations at the start of the step
  VecX q, v, vd, a, dq, r, phi, jerk, ahead;  ///< in order: q, v, v̇, a, Δq, r, Φ, q⃛, a second Δq
  VecX lambda, rhs, y;                ///< in order: λ, right-hand side, correction; λ may have more entries than Φ
  VecX back, rate, open;              ///< in a stabilised step: change of Δq by μ, Φ̇, Φ before the correction by μ
  VecX kept, kept_back;               ///< copies of y and `back` during the test for round-off
  AndersonAcceleration acceleration;  ///< Anderson acceleration of y, in the norm of the accelerations of bodies
  Index states;                       ///< number of first-order states, the last entries of v

  /// Zero vectors for the given numbers of coordinates, velocities, rows (constraint equations), multipliers of a step
  /// and `first_order` states.
  AlphaVectors(Index coordinates, Index velocities, Index rows, Index multipliers, Index first_order)
      : v0(VecX::Zero(velocities)),
        a0(v0),
        q(VecX::Zero(coordinates)),
        v(v0),
        vd(v0),
        a(v0),
        dq(v0),
        r(v0),
        phi(VecX::Zero(rows)),
        jerk(v0),
        ahead(v0),
        lambda(VecX::Zero(multipliers)),
        rhs(VecX::Zero(velocities + multipliers)),
        y(rhs),
        back(v0),
        rate(phi),
        open(phi),
        kept(rhs),
        kept_back(v0),
        acceleration(rhs.size(), velocities - first_order),
        states(first_order) {}

  /// Right-hand side of a correction: −r, and `phi` or `rate` with opposite sign, divided by `of_dq` or `of_v`.
  /// \param both_multiplier_sets true if the step has μ besides λ \param nonholonomic_equations their indices
  void make_right_hand_side(double of_dq, double of_v, bool both_multiplier_sets,
                            Sequence<Index> const& nonholonomic_equations) {
    double const *const given = r.data(), *const violated = (both_multiplier_sets ? rate : phi).data();
    double *const to = rhs.data(), *const of_rows = to + v.size();
    for_each_simd_block(v.size(), [=](auto at) { at.set(to, -at(given)); });
    double const scale = -1.0 / (both_multiplier_sets ? of_v : of_dq);
    for_each_simd_block(phi.size(), [=](auto at) { at.set(of_rows, scale * at(violated)); });
    if (!both_multiplier_sets)
      for (Index const i : nonholonomic_equations) of_rows[i] = rate[i] / -of_v;
  }
  /// Euclidean norm of the entries [i, end) of a.
  static double norm(VecX const& a, Index i, Index end) { return std::sqrt(squares(a.data() + i, end - i)); }
  /// Computes Δq and v at the time e [s] after x with constant `jerk`.
  void follow(State const& x, double e) {
    for (Index i = 0; i < v.size(); ++i) {
      dq[i] = e * x.v[i] + 0.5 * e * e * x.a[i] + e * e * e / 6.0 * jerk[i];
      v[i] = x.v[i] + e * x.a[i] + 0.5 * e * e * jerk[i];
    }
  }
  /// Computes `jerk` by one-sided differences of the accelerations `now`, and of those after h/4, h/2 and h [s]
  /// (`quarter`, `half`, `full`). Returns true if the results over h/2 and over h differ by at most half the norm of
  /// `jerk`.
  bool find_jerk(VecX const& now, VecX const& quarter, VecX const& half, VecX const& full, double h) {
    VecX mismatch(now.size());
    for (Index i = 0; i < now.size(); ++i) {
      jerk[i] = (4.0 * quarter[i] - half[i] - 3.0 * now[i]) / (0.5 * h);
      mismatch[i] = jerk[i] - (4.0 * half[i] - full[i] - 3.0 * now[i]) / h;
    }
    return all_finite(jerk) && of_each_part([&](Index first, Index end) {
             return norm(mismatch, first, end) <= 0.5 * norm(jerk, first, end);
           });
  }

  /// True if f(first, end) is true for the velocities of bodies and for the first-order states.
  template <class F>
  bool of_each_part(F&& f) const {
    Index const bodies = v.size() - states;
    return f(0, bodies) && (states == 0 || f(bodies, v.size()));
  }
};

}  // namespace polybody
