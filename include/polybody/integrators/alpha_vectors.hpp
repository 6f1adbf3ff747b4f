#pragma once
#include <polybody/solvers/anderson.hpp>
#include <polybody/system/state.hpp>

namespace polybody {

/// What a step of the family computes with, of whatever model.
struct AlphaVectors {
  VecX v0, a0;                                ///< speeds and algorithmic acceleration from which the step sets out
  VecX q, v, vd, a, dq, r, phi, jerk, ahead;  ///< in order: q, v, v̇, a, Δq, r, Φ, q⃛, a Δq elsewhere
  VecX lambda, rhs, y;                        ///< of all multipliers that the step keeps; `phi` is of its rows
  VecX back, rate, open;  ///< of a stabilised step: what μ moves, a vector by rows, and rows before μ answers them
  VecX kept, kept_back;   ///< corrections while others are looked at
  AndersonAcceleration acceleration;  ///< of y, by the accelerations of bodies
  Index states;                       ///< first-order ones, the last of the speeds

  /// Zeros, as many as a system has coordinates, velocities, rows, multipliers that a step keeps, and `first_order`
  /// states.
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

  /// ‖a‖ of the entries [i, end).
  static double norm(VecX const& a, Index i, Index end) { return std::sqrt(squares(a.data() + i, end - i)); }
  /// Δq and v after e seconds [s] from x with `jerk`.
  void follow(State const& x, double e) {
    for (Index i = 0; i < v.size(); ++i) {
      dq[i] = e * x.v[i] + 0.5 * e * e * x.a[i] + e * e * e / 6.0 * jerk[i];
      v[i] = x.v[i] + e * x.a[i] + 0.5 * e * e * jerk[i];
    }
  }
  /// `jerk` by one-sided differences of accelerations `now`, a `quarter` and a `half` of h [s] later and a `full` h
  /// later. Whether both distances agree.
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

  /// f(first, end) holds of the speeds of bodies and of the first-order states.
  template <class F>
  bool of_each_part(F&& f) const {
    Index const bodies = v.size() - states;
    return f(0, bodies) && (states == 0 || f(bodies, v.size()));
  }
};

}  // namespace polybody
