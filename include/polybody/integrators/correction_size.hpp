#pragma once
/// \file
/// How large a correction of Newton's method is, beside what is tolerated, where parts of it have other units than the
/// accelerations.

#include <algorithm>
#include <limits>

#include <polybody/math/vectors.hpp>
#include <polybody/solvers/newton.hpp>

namespace polybody::detail {

/// By how much rounding moves the coordinates in the mean: coordinate i by ε |q_i|, what stands for a direction or an
/// arm by ε. A mean, as corrections are measured by theirs: one angle of many turns does not speak for all.
inline double rounding_of(VecX const& q) {
  return std::numeric_limits<double>::epsilon() * (1.0 + std::sqrt(squares(q) / double(std::max<Index>(q.size(), 1))));
}
/// What that leaves of a correction that moves q by s times as much.
inline double rounding_of(VecX const& q, double s) { return rounding_of(q) / s; }

/// out = x, moved by some last places of what it is made of, `q`. The signs follow no pattern that a model could share.
/// x and out may be the same.
inline void perturb(VecX const& x, VecX const& q, VecX& out) {
  double const size = 4.0 * rounding_of(q);
  for (Index i = 0; i < x.size(); ++i) out[i] = x[i] + scattered_sign(i) * size;
}
/// Whether a correction that moves the coordinates in the mean by `moved` may be rounding. Next to a singular position
/// rounding ε comes out of the rows' inverse as √ε and some powers of ten; an iterate that flew away is moved by
/// metres, and whatever it tolerates has grown with it.
inline bool may_be_rounding(double moved, VecX const& q) { return moved <= 1e10 * rounding_of(q); }
/// The same of a step from q whose rows of positions, phi, may be open by no more than rounding.
inline bool may_be_rounding(VecX const& phi, double moved, VecX const& q) {
  return largest_size(phi) <= 1e3 * rounding_of(q) && may_be_rounding(moved, q);
}

/// Whether rounding is what the correction y, of the size `norm`, consists of: it is another one as coordinates and
/// rows move by some last places. Next to a singular position the rows' rounding comes out of their inverse many times
/// larger, and so does that of stretches out of light nodes. \param moved solves for it there, into y, and says whether
/// it is finite  \param measure the norm of what is in y  \param kept holds y meanwhile, which is the same afterwards
template <class Moved, class Measure>
bool is_round_off(VecX& y, double norm, VecX& kept, Moved&& moved, Measure&& measure) {
  kept = y;
  bool const finite = moved();
  y -= kept;
  bool const differs = finite && measure() >= 0.5 * norm;
  y.swap(kept);
  return differs;
}

/// First-order states, the last `count` of the speeds `v` with their rates. Each has a unit of its own.
struct StatesInStep {
  Index count;
  VecX const &v, &rate;
  double s;  ///< a correction of the rates moves the states by s times as much

  /// Joins corrections y of the rates to those of the accelerations: each is measured beside tolerance (1 + |z| + |ż|)
  /// of its own state, and beside what rounding of z leaves.
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
