#pragma once
/// \file
/// Rate of change of the accelerations at the start of a run.

#include <polybody/system/system.hpp>

namespace polybody::detail {

/// Computes q⃛ at x in w.jerk by one-sided differences of the accelerations along the motion, at two distances. Returns
/// false if the two results disagree, or if the acceleration at x.t + h changes by more than ½ h ‖q⃛‖ when the motion is
/// extrapolated with this q⃛ instead of zero. In an oscillator the second case occurs for ωh above 1.7; after an
/// impulse, stiff components dominate q⃛. Steps of h then do not resolve the motion; a correction would add noise.
template <class Workspace>
bool jerk_at_start(System& system, State const& x, double h, Workspace& w) {
  w.jerk.setZero();
  auto const acceleration_after = [&](double e) {
    w.follow(x, e);
    system.plus(x.q, w.dq, w.q);
    VecX a = x.a;
    w.forward.accelerations(system, {w.q, w.v, x.t + e}, a, w.rate);
    return a;
  };
  VecX const quarter = acceleration_after(0.25 * h), half = acceleration_after(0.5 * h), full = acceleration_after(h);
  if (!w.find_jerk(x.a, quarter, half, full, h)) return false;
  VecX change = acceleration_after(h);
  for (Index i = 0; i < change.size(); ++i) change[i] -= full[i];
  return w.of_each_part(
      [&](Index first, Index end) { return w.norm(change, first, end) <= 0.5 * h * w.norm(w.jerk, first, end); });
}

}  // namespace polybody::detail
