#pragma once
/// \file
/// Size of Newton corrections relative to their tolerance: tests for round-off, and first-order states with own units.

#include <algorithm>
#include <limits>

#include <polybody/math/vectors.hpp>
#include <polybody/solvers/newton.hpp>

namespace polybody::detail {

/// Mean round-off of the coordinates: ε times the root mean square of q, plus ε for directions and moment arms. The
/// size of a correction is also a root mean square. A single large coordinate, for example an angle after many
/// revolutions, therefore enters the round-off and the correction in the same way.
inline double rounding_of(VecX const& q) {
  return std::numeric_limits<double>::epsilon() * (1.0 + std::sqrt(squares(q) / double(std::max<Index>(q.size(), 1))));
}
/// Round-off of a correction y that changes q by s y.
inline double rounding_of(VecX const& q, double s) { return rounding_of(q) / s; }

/// Sets out to x, perturbed by a few units of the round-off of `q`. The signs are irregular, so that they match no
/// pattern of a model. x and out may be the same vector.
inline void perturb(VecX const& x, VecX const& q, VecX& out) {
  double const size = 4.0 * rounding_of(q);
  for (Index i = 0; i < x.size(); ++i) out[i] = x[i] + scattered_sign(i) * size;
}
/// True if a correction may be round-off. Near a singular configuration, the inverse of the constraint Jacobian
/// amplifies the round-off ε to √ε times some powers of ten. A diverged iterate has a large tolerance, but changes the
/// coordinates by metres, and is thus excluded. \param moved root mean square change of the coordinates
inline bool may_be_rounding(double moved, VecX const& q) { return moved <= 1e10 * rounding_of(q); }
/// Overload for a step from q: the violation phi of the position constraints must also be within round-off.
inline bool may_be_rounding(VecX const& phi, double moved, VecX const& q) {
  return largest_size(phi) <= 1e3 * rounding_of(q) && may_be_rounding(moved, q);
}

/// True if the correction y with the norm `norm` consists of round-off: it changes if coordinates and constraint
/// functions change by a few units of round-off. Near a singular configuration, the inverse of the constraint Jacobian
/// amplifies round-off many times. Light nodes amplify the round-off of strains in the same way. \param moved computes
/// the perturbed correction in y and returns true if this correction is finite \param measure returns the norm of y
/// \param kept workspace; y is unchanged afterwards
template <class Moved, class Measure>
bool is_round_off(VecX& y, double norm, VecX& kept, Moved&& moved, Measure&& measure) {
  kept = y;
  bool const finite = moved();
  y -= kept;
  bool const differs = finite && measure() >= 0.5 * norm;
  y.swap(kept);
  return differs;
}

/// First-order states: the last `count` of the velocities `v`, with their rates. Each state has its own unit.
struct StatesInStep {
  Index count;
  VecX const &v, &rate;
  double s;  ///< change of the states per correction of their rates [s]

  /// Combines corrections y of the rates with those of the accelerations. The tolerance of each state is `tolerance`
  /// times (1 + |z| + |ż|), plus the round-off of z over s.
  CorrectionSize join(CorrectionSize size, double tolerance, double const* y) const {
    double worst = 0.0;
    for (Index i = v.size() - count; i < v.size(); ++i) {
      double const z = std::abs(v[i]), rounding = 30.0 * std::numeric_limits<double>::epsilon() * z / s;
      worst = std::max(worst, std::abs(y[i]) / (tolerance * (1.0 + z + std::abs(rate[i])) + rounding));
    }
    if (count > 0) size.norm = std::hypot(size.norm, worst * size.tolerated);
    return size;
  }
};

}  // namespace polybody::detail
