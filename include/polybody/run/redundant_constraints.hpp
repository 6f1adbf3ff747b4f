#pragma once
/// \file
/// Redundant constraint equations that a factorisation of [M, Gᵀ; G, 0] drops: their null vectors, and checks for
/// contradictions. This file uses the factorisation of a run; run/redundancy.hpp computes a separate one.

#include <polybody/integrators/forward_dynamics.hpp>

namespace polybody {
namespace detail {

/// Limits of |c·b|/max |c|, where Gᵀc = 0 and b is Φ, Φ̇ or γ of a state. Below these limits, redundant equations agree
/// within round-off.
struct ContradictionLimits {
  double position = 1e-8;  ///< for Φ [m], [rad]
  double relative = 1e-6;  ///< for Φ̇ relative to 1 + max |v|, for γ relative to 1 + max |γ|
};

/// Names of the joints whose equations have nonzero coefficients in c (rows): joint "a", joint "b". Coefficients up to
/// 1e-6 max |c| count as zero.
template <class = void>
std::string names_in(System const& system, VecX const& c) {
  std::string names, last;
  double const enough = 1e-6 * largest_size(c);
  for (Index i = 0; i < c.size(); ++i) {
    if (std::abs(c[i]) <= enough) continue;
    std::string const name = system.name_of(system.velocities() + i);
    if (name == last) continue;
    names += (names.empty() ? "" : ", ") + name;
    last = name;
  }
  return names;
}

/// Null vector c of a dropped row: Gᵀc = 0. Let e be the unit vector of this row. M a + Gᵀμ = Gᵀe and G a = 0 then have
/// the solution a = 0, hence c = e − μ.
template <class = void>  // compiled only if used
struct ConstraintDependence {
  VecX c;  ///< (rows), 1 at the row itself and 0 at all other dropped rows

  explicit ConstraintDependence(System const& s)
      : c(VecX::Zero(s.rows())), mu_(c), w_(VecX::Zero(s.velocities())), a_(w_) {}

  /// Computes c for the dropped unknown i of `forward.redundant_rows()`, with the last factorisation of `forward`.
  /// Returns false if i is a velocity, or if its row is only nearly redundant.
  template <class Solver>
  [[gnu::cold]] bool find(System& system, ForwardDynamics<Solver>& forward, Index i) {
    if (i < system.velocities()) return false;
    c.setZero();
    c[i - system.velocities()] = 1.0;
    system.rows_transposed_times(c, w_);
    double const size = largest_size(w_);
    forward.response(system, w_, a_, mu_);
    c -= mu_;
    system.rows_transposed_times(c, w_);
    return size == 0.0 || largest_size(w_) <= 1e-6 * size;
  }

 private:
  VecX mu_, w_, a_;
};

/// Residual b + G a (rows) of the smallest motion a that satisfies G a = −b in all rows that were not dropped. In a
/// dropped row with the null vector c, the residual is c·b. The magnitude |c·b| is an upper bound of |c·b|/max |c|,
/// since max |c| ≥ 1. One solution thus compares all rows with a limit; only rows beyond the limit require their null
/// vectors. The last factorisation of `forward` must be at the coordinates of `system`.
template <class Solver>
[[gnu::cold]] VecX left_of(System& system, ForwardDynamics<Solver>& forward, VecX const& b) {
  VecX a = VecX::Zero(system.velocities()), left = VecX::Zero(system.rows());
  forward.least_change(system, b, a);  // G a = −b
  system.rows_times(a, left);
  left += b;
  return left;
}

/// Curvature of rows that are redundant at (q, t), with the null vector c: c·γ(v) − c·γ(0), a quadratic form of v. If
/// it vanishes for all v with G v = 0, the rows are redundant everywhere. Otherwise they are redundant only at this
/// configuration, which is singular. Motions branch at a singular configuration, and only velocities with c·γ(v) =
/// c·γ(0) belong to a branch.
template <class = void>
struct ConstraintCurvature {
  VecX w;  ///< (nv) pseudo-random velocities with G w = 0

  /// Uses the last factorisation of `forward`. Evaluates `system` at (q, 0, t).
  template <class Solver>
  ConstraintCurvature(System& system, ForwardDynamics<Solver>& forward, State const& x)
      : w(VecX::Zero(system.velocities())),
        x_(x),
        rest_(VecX::Zero(system.rows())),
        gamma_(rest_),
        other_(rest_),
        zero_(w),
        moved_(w) {
    for (Index i = 0; i < w.size(); ++i) moved_[i] = scattered_sign(i) * (1.0 + 1.0 / double(i + 2));
    bias(system, moved_, gamma_);
    rounding_ = 1e-6 * largest_size(gamma_);
    system.evaluate(x.q, x.v, x.t);
    system.rows_times(moved_, gamma_);
    forward.least_change(system, gamma_, w);
    for (Index i = 0; i < w.size(); ++i) w[i] += moved_[i];
    bias(system, zero_, rest_);
  }
  /// c·γ(w) − c·γ(0) for the dropped rows, relative to the larger of max |γ(w)| and max |γ(0)|. Values up to `limit`
  /// count as zero.
  template <class Solver>
  VecX bent(System& system, ForwardDynamics<Solver>& forward) {
    bias(system, w, gamma_);
    double const scale = std::max({largest_size(gamma_), largest_size(rest_), rounding_});
    VecX left = left_of(system, forward, gamma_ - rest_);
    if (scale > 0.0) left /= scale;
    return left;
  }
  static constexpr double limit = 1e-6;  ///< limit of differences of c·γ, relative to max |c| max |γ|
  /// True if the dropped row with the null vector c is redundant only in this configuration.
  bool is_singular(System& system, VecX const& c) {
    bias(system, w, gamma_);
    return differ(c, gamma_, rest_);
  }
  /// True if the velocities v of the state do not determine a branch: v is zero, or the quadratic form is equal at v +
  /// s w and v − s w, where s scales w to the size of v.
  bool leaves_open(System& system, VecX const& c) {
    double const size = largest_size(x_.v);
    if (!(size > 0.0)) return true;
    double const share = size / std::max(largest_size(w), 1e-300);
    for (Index i = 0; i < w.size(); ++i) moved_[i] = x_.v[i] + share * w[i];
    bias(system, moved_, gamma_);
    for (Index i = 0; i < w.size(); ++i) moved_[i] = x_.v[i] - share * w[i];
    bias(system, moved_, other_);
    return !differ(c, gamma_, other_);
  }

 private:
  void bias(System& system, VecX const& v, VecX& gamma) {
    system.evaluate(x_.q, v, x_.t);
    system.acceleration_bias(gamma);
  }
  bool differ(VecX const& c, VecX const& a, VecX const& b) const {
    double sum = 0.0;
    for (Index i = 0; i < c.size(); ++i) sum += c[i] * (a[i] - b[i]);
    double const scale = largest_size(c) * std::max({largest_size(a), largest_size(b), rounding_});
    return std::abs(sum) > limit * scale;
  }

  State const& x_;
  VecX rest_, gamma_, other_, zero_, moved_;
  double rounding_ = 0.0;  // lower limit of the scale: without free velocities, w is round-off
};

}  // namespace detail

/// Names of joints whose constraint equations are redundant at x but not nearby, if x is a singular configuration at
/// which the motion can branch and whose velocities do not determine the branch. Such velocities are zero, or belong to
/// several branches. Empty otherwise. Factorises `forward` at x.
template <class Solver>
[[gnu::cold]] std::string joints_of_branch_point(System& system, ForwardDynamics<Solver>& forward, State const& x) {
  if (system.rows() == 0) return "";
  forward.hold(system, x.q, x.v, x.t);
  if (forward.redundant_rows().empty()) return "";
  detail::ConstraintDependence<> relation(system);
  detail::ConstraintCurvature<> bending(system, forward, x);
  VecX const bent = bending.bent(system, forward);
  for (Index const i : forward.redundant_rows()) {
    if (i < system.velocities() || std::abs(bent[i - system.velocities()]) <= bending.limit) continue;
    if (relation.find(system, forward, i) && bending.is_singular(system, relation.c) &&
        bending.leaves_open(system, relation.c))
      return detail::names_in(system, relation.c);
  }
  return "";
}

/// Warning text of a run that starts at x, for the joints of `joints_of_branch_point`. Empty without such joints.
template <class Solver>
[[gnu::cold]] std::string warn_of_ambiguous_branch(System& system, ForwardDynamics<Solver>& forward, State const& x) {
  std::string const joints = joints_of_branch_point(system, forward, x);
  if (joints.empty()) return "";
  return sentence_of({"The run starts in a singular configuration at t = ", x.t, " s: the constraint equations of ",
                      joints,
                      " are redundant there, but not nearby. The motion can continue on several branches, and the "
                      "initial velocities do not select one. The step and the integrator then select the branch. "
                      "Start near this configuration, or with velocities of one branch."});
}

/// Checks that redundant constraint equations agree: c·b = 0 for every c with Gᵀc = 0. b is Φ, Φ̇ or γ of the evaluated
/// `system`, and `forward` must be factorised. \param what name of b and its unit, for the message \param limit largest
/// permitted |c·b|/max |c|, in the unit of b
/// \throws InconsistentInitialConditions naming the joints whose equations contradict each other.
template <class Solver>
[[gnu::cold]] void require_consistent_constraints(System& system, ForwardDynamics<Solver>& forward, VecX const& b,
                                                  double limit, std::string const& what) {
  if (forward.redundant_rows().empty()) return;
  detail::ConstraintDependence<> relation(system);
  VecX const at_most = first_not_finite(b) < 0 ? detail::left_of(system, forward, b) : b;
  for (Index const i : forward.redundant_rows()) {
    if (i < system.velocities() || std::abs(at_most[i - system.velocities()]) <= limit) continue;
    if (!relation.find(system, forward, i)) continue;
    double sum = 0.0;
    for (Index k = 0; k < b.size(); ++k) sum += relation.c[k] * b[k];
    double const left = sum / largest_size(relation.c);
    if (std::abs(left) <= limit) continue;
    throw InconsistentInitialConditions(
        "constraints.contradiction",
        {"The constraint equations of ", ErrorObject{detail::names_in(system, relation.c)},
         " are redundant but contradict each other by ", ErrorValue{std::abs(left)}, " in their ", what,
         " at t = ", ErrorTime{system.at().t},
         " s. Remove one of these joints, make their dimensions and time functions agree, give one a compliant policy "
         "such as Penalty, or, in a singular configuration, start with the velocities of one branch."});
  }
}

/// Checks that projected velocities satisfy |Φ̇| ≤ `limit` also in the dropped rows, which the projection omits. Rows
/// that are only nearly redundant can fail this check. \param rate Φ̇ at the projected velocities [m/s], [rad/s]
/// \throws InconsistentInitialConditions naming the violated joint.
template <class Solver>
[[gnu::cold]] void require_dropped_constraints_closed(System const& system, ForwardDynamics<Solver> const& forward,
                                                      VecX const& rate, double limit) {
  for (Index const i : forward.redundant_rows())
    if (i >= system.velocities() && std::abs(rate[i - system.velocities()]) > limit)
      throw InconsistentInitialConditions(
          "constraints.nearly_redundant",
          {"The constraint equations of ", ErrorObject{system.name_of(i)},
           " are nearly redundant and were omitted, but the velocities violate them by ",
           ErrorValue{std::abs(rate[i - system.velocities()])}, " (m/s or rad/s) at t = ", ErrorTime{system.at().t},
           " s. Start in another configuration, give the bodies of the joint more similar masses, or give the joint a "
           "compliant policy such as Penalty."});
}

/// Checks the initial state of a run with projected velocities: redundant equations must agree in velocities and
/// accelerations, and no dropped equation may be violated. \throws InconsistentInitialConditions.
template <class Solver>
[[gnu::cold]] void require_consistent_redundancy(System& system, ForwardDynamics<Solver>& forward, State const& x) {
  if (system.rows() == 0) return;
  forward.hold(system, x.q, x.v, x.t);
  if (forward.redundant_rows().empty()) return;
  detail::ContradictionLimits const limits;
  VecX b = VecX::Zero(system.rows());
  system.violation_rate(b);
  double const limit = limits.relative * (1.0 + largest_size(x.v));
  require_consistent_constraints(system, forward, b, limit, "velocities (m/s or rad/s)");
  require_dropped_constraints_closed(system, forward, b, limit);
  system.acceleration_bias(b);
  require_consistent_constraints(system, forward, b, limits.relative * (1.0 + largest_size(b)),
                                 "accelerations (m/s² or rad/s²)");
}

}  // namespace polybody
