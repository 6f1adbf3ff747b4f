#pragma once
/// \file
/// Rows that repeat others and that a factorisation of [M, Gᵀ; G, 0] drops: their relations to other rows, and whether
/// they contradict. This uses the factorisation of a run; run/redundancy.hpp makes one of its own.

#include <polybody/integrators/forward_dynamics.hpp>

namespace polybody {
namespace detail {

/// The largest |c·b| over max |c| of rows with Gᵀc = 0 that counts as rounding, for b of a state's Φ, Φ̇ and γ.
struct ContradictionLimits {
  double position = 1e-8;
  double relative = 1e-6;  ///< for Φ̇ to 1 + max |v|, for γ to 1 + max |γ|
};

/// Names of the joints that take part in c (rows), each once: joint "a", joint "b".
template <class = void>
std::string names_in(System const& system, VecX const& c) {
  std::string names, last;
  double const enough = 1e-6 * largest_size(c);
  for (Index i = 0; i < c.size(); ++i) {
    if (std::abs(c[i]) <= enough) continue;
    std::string const name = system.name_of(system.speeds() + i);
    if (name == last) continue;
    names += (names.empty() ? "" : ", ") + name;
    last = name;
  }
  return names;
}

/// The relation Gᵀc = 0 in which a dropped row stands to the others: with w = Gᵀe of that row, M a + Gᵀμ = w and G a =
/// 0 have a = 0, and c = e − μ.
template <class = void>  // compiled where it is used
struct RowRelation {
  VecX c;  ///< (rows), 1 in the row itself and 0 in all others that were dropped

  explicit RowRelation(System const& s) : c(VecX::Zero(s.rows())), mu_(c), w_(VecX::Zero(s.speeds())), a_(w_) {}

  /// For unknown i of `redundant_rows()` where `forward` was factored last. False where that row repeats the others
  /// only nearly.
  template <class Solver>
  [[gnu::cold]] bool find(System& system, ForwardDynamics<Solver>& forward, Index i) {
    if (i < system.speeds()) return false;
    c.setZero();
    c[i - system.speeds()] = 1.0;
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

}  // namespace detail

/// Rows that repeat each other must ask for the same: c·b = 0 for every c with Gᵀc = 0, where b is Φ, Φ̇ or γ of
/// `system` as evaluated and `forward` as factored. \param what those are called  \param limit of |c·b|/max |c|
/// \throws InconsistentStart naming the joints that do not.
template <class Solver>
[[gnu::cold]] void require_no_contradiction(System& system, ForwardDynamics<Solver>& forward, VecX const& b,
                                            double limit, std::string const& what) {
  if (forward.redundant_rows().empty()) return;
  detail::RowRelation<> relation(system);
  for (Index const i : forward.redundant_rows()) {
    if (!relation.find(system, forward, i)) continue;
    double sum = 0.0;
    for (Index k = 0; k < b.size(); ++k) sum += relation.c[k] * b[k];
    double const left = sum / largest_size(relation.c);
    if (std::abs(left) <= limit) continue;
    throw InconsistentStart{
        "The rows of ",
        detail::names_in(system, relation.c),
        " repeat each other but contradict by ",
        std::abs(left),
        " in their ",
        what,
        " at t = ",
        system.at().t,
        " s. Remove one of these joints, make their dimensions and laws agree, or give one a compliant "
        "policy such as Penalty."};
  }
}

/// Rows that a factorisation drops are closed by the others, whose speeds are projected; but not where they repeat them
/// only nearly. \param rate Φ̇ at the projected speeds \throws InconsistentStart naming the joint that stays open.
template <class Solver>
[[gnu::cold]] void require_closed_when_dropped(System const& system, ForwardDynamics<Solver> const& forward,
                                               VecX const& rate, double limit) {
  for (Index const i : forward.redundant_rows())
    if (i >= system.speeds() && std::abs(rate[i - system.speeds()]) > limit)
      throw InconsistentStart{"The rows of ",
                              system.name_of(i),
                              " repeat those of other joints so nearly that they are left out, and they stay open by ",
                              std::abs(rate[i - system.speeds()]),
                              " in their speeds at t = ",
                              system.at().t,
                              " s. Move the joint away from this position, bring the masses of the bodies that it "
                              "joins closer together, or give it a compliant policy such as Penalty."};
}

/// The start of a run, its speeds projected: no contradiction in the speeds and accelerations that the rows ask for,
/// and no row left open. \throws InconsistentStart.
template <class Solver>
[[gnu::cold]] void require_consistent_rows(System& system, ForwardDynamics<Solver>& forward, State const& x) {
  if (system.rows() == 0) return;
  forward.hold(system, x.q, x.v, x.t);
  if (forward.redundant_rows().empty()) return;
  detail::ContradictionLimits const limits;
  VecX b = VecX::Zero(system.rows());
  system.violation_rate(b);
  double const limit = limits.relative * (1.0 + largest_size(x.v));
  require_no_contradiction(system, forward, b, limit, "speeds");
  require_closed_when_dropped(system, forward, b, limit);
  system.acceleration_bias(b);
  require_no_contradiction(system, forward, b, limits.relative * (1.0 + largest_size(b)), "accelerations");
}

}  // namespace polybody
