#pragma once
#include <polybody/solvers/anderson.hpp>

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

  /// Zeros, as many as a system has coordinates, speeds, rows, multipliers that a step keeps, and `first_order` states.
  AlphaVectors(Index coordinates, Index speeds, Index rows, Index multipliers, Index first_order)
      : v0(VecX::Zero(speeds)),
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
        rhs(VecX::Zero(speeds + multipliers)),
        y(rhs),
        back(v0),
        rate(phi),
        open(phi),
        kept(rhs),
        kept_back(v0),
        acceleration(rhs.size(), speeds - first_order),
        states(first_order) {}

  /// f(first, end) holds of the speeds of bodies and of the first-order states.
  template <class F>
  bool of_each_part(F&& f) const {
    Index const bodies = v.size() - states;
    return f(0, bodies) && (states == 0 || f(bodies, v.size()));
  }
};

}  // namespace polybody
