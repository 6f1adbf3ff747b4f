#pragma once
#include <polybody/math/types.hpp>

namespace polybody {

/// What a step of the family computes with, of whatever model.
struct AlphaVectors {
  VecX v0, a0;  ///< speeds and algorithmic acceleration from which the step sets out
  VecX q, v, vd, a, lambda, dq, r, phi, rhs, y, jerk, ahead;
  VecX back, rate;       ///< of a stabilised step: what μ moves, and a vector by rows
  VecX kept, kept_back;  ///< corrections while others are looked at
  Index states;          ///< first-order ones, the last of the speeds

  AlphaVectors(Index coordinates, Index speeds, Index rows, Index first_order)
      : v0(VecX::Zero(speeds)),
        a0(v0),
        q(VecX::Zero(coordinates)),
        v(v0),
        vd(v0),
        a(v0),
        lambda(VecX::Zero(rows)),
        dq(v0),
        r(v0),
        phi(lambda),
        rhs(VecX::Zero(speeds + rows)),
        y(rhs),
        jerk(v0),
        ahead(v0),
        back(v0),
        rate(lambda),
        kept(rhs),
        kept_back(v0),
        states(first_order) {}

  /// f(first, end) holds of the speeds of bodies and of the first-order states.
  template <class F>
  bool of_each_part(F&& f) const {
    Index const bodies = v.size() - states;
    return f(0, bodies) && (states == 0 || f(bodies, v.size()));
  }
};

}  // namespace polybody
