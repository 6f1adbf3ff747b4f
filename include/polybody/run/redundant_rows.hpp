#pragma once
/// \file
/// Choice of the redundant constraint equations that a run drops. The choice follows from the null space of Gᵀ: an
/// equation may be dropped if its coefficient in a null vector is large enough relative to the other coefficients. If
/// the coefficients of all other equations are at most f times as large, the smallest singular value of the remaining
/// equations is within a factor of about f of its largest possible value [Gu & Eisenstat 1996, SIAM J. Sci. Comput.
/// 17(4), 848–869]. A factorisation that drops rows in a fixed order has no such bound: it divides by the coefficient
/// of its last row, which may pass through zero during a motion.

#include <polybody/math/index_map.hpp>
#include <polybody/run/redundant_constraints.hpp>

namespace polybody {
namespace detail {

/// Limits for the coefficient of a dropped equation in its null vector, relative to the vector's largest coefficient.
struct RedundantLimits {
  double chosen = 0.1;       ///< least relative coefficient in a new choice
  double kept = 1.0 / 30.0;  ///< least relative coefficient in an existing choice
  double dependent = 1e-6;  ///< |Gᵀc| below which c is a null vector, for equations and velocities scaled to the size 1
};

/// Chooses for each null vector the last equation whose coefficient exceeds the limit `chosen`, so that joints
/// connected later are named. \param c null vectors with scaled coefficients; afterwards each is 0 at the equations
/// chosen for the other vectors
/// \param preferred for each equation, true if it is chosen before others when its coefficient exceeds the limit
/// `kept`; may be empty
template <class = void>
[[gnu::cold]] Sequence<Index> choose_redundant(Sequence<IndexMap<double>>& c, Sequence<char> const& preferred) {
  RedundantLimits const limits;
  Sequence<Sequence<Index>> with_entry;  // vectors with a coefficient of each equation, some repeated
  auto const enter = [&](Index i, std::size_t k) {
    while (with_entry.size() <= std::size_t(i)) with_entry.emplace_back();
    with_entry[std::size_t(i)].push_back(Index(k));
  };
  for (std::size_t k = 0; k < c.size(); ++k)
    for (auto const& [i, value] : c[k]) enter(i, k);
  Sequence<Index> chosen;
  for (std::size_t k = 0; k < c.size(); ++k) {
    double largest = 0.0;
    for (auto const& [i, value] : c[k]) largest = std::max(largest, std::abs(value));
    Index last = -1, last_preferred = -1;
    for (auto const& [i, value] : c[k]) {
      if (std::abs(value) >= limits.chosen * largest) last = i;
      if (!preferred.empty() && preferred[std::size_t(i)] && std::abs(value) >= limits.kept * largest)
        last_preferred = i;
    }
    Index const best = last_preferred >= 0 ? last_preferred : last;
    chosen.push_back(best);
    IndexMap<double> divided;
    double const by = *c[k].find(best);
    for (auto const& [i, value] : c[k]) divided[i] = value / by;
    c[k] = std::move(divided);
    for (Index const other : Sequence<Index>(with_entry[std::size_t(best)])) {
      std::size_t const j = std::size_t(other);
      double const* const part = c[j].find(best);
      if (j == k || !part || *part == 0.0) continue;
      double const of = *part;
      for (auto const& [i, value] : c[k]) {
        if (!c[j].find(i)) enter(i, j);
        c[j][i] -= of * value;
      }
    }
  }
  sort_once(chosen);
  return chosen;
}

/// Scales of velocities and constraint equations. Velocities are scaled first, then equations, so that every row of G
/// has the norm 1 in any units.
template <class = void>  // compiled only if used
struct RowSizes {
  VecX of_velocity, of_row;  ///< (nv), (rows); 1 for a velocity or an equation without entries

  explicit RowSizes(System& system) : of_velocity(VecX::Zero(system.velocities())), of_row(VecX::Zero(system.rows())) {
    for (int pass = 0; pass < 2; ++pass) {
      Sink sink{system.velocities(), pass == 1, *this};
      system.masses(sink);
      VecX& sizes = pass == 0 ? of_velocity : of_row;
      for (Index i = 0; i < sizes.size(); ++i) sizes[i] = sizes[i] > 0.0 ? std::sqrt(sizes[i]) : 1.0;
    }
  }

 private:
  struct Sink {
    Index velocities;
    bool rows;
    RowSizes& sizes;
    void add(Index row, Index col, BlockView const& b) {
      if (row >= velocities || col < velocities) return;
      for (Index j = 0; j < b.cols; ++j)
        for (Index i = 0; i < b.rows; ++i) {
          double const by = sizes.of_velocity[row + i], g = b(i, j);
          if (rows)
            sizes.of_row[col - velocities + j] += g * g / (by * by);
          else
            sizes.of_velocity[row + i] += g * g;
        }
    }
  };
};

/// Null vectors of Gᵀ at a state, from a factorisation that drops the redundant equations.
template <class Solver>
class NullVectors {
 public:
  NullVectors(System& system, ForwardDynamics<Solver>& forward, State const& x)
      : system_(system), forward_(forward), x_(x), sizes_(held()) {}

  /// Computes the null vectors from the last factorisation of `forward`: each has scaled coefficients, 1 at its dropped
  /// equation and 0 at the other dropped equations. Returns false for solvers that compute no null vectors.
  bool find() {
    Sequence<VecX> found;
    VecX n = VecX::Zero(system_.size());
    for (Index const i : forward_.redundant_rows()) {
      if (i < system_.velocities() || !forward_.null_vector(i, n)) return false;
      VecX c = n.tail(system_.rows());
      for (Index k = 0; k < c.size(); ++k) c[k] *= sizes_.of_row[k] / sizes_.of_row[i - system_.velocities()];
      found.push_back(std::move(c));
    }
    vectors = std::move(found);
    return true;
  }
  /// Replaces the vectors by those of their linear combinations that satisfy Gᵀc = 0.
  void keep_dependent() {
    Sequence<VecX> left;
    for (VecX const& c : vectors) {
      VecX w = VecX::Zero(system_.velocities());
      system_.rows_transposed_times(unscaled(c), w);
      for (Index i = 0; i < w.size(); ++i) w[i] /= sizes_.of_velocity[i];
      left.push_back(std::move(w));
    }
    keep_null(left);
  }
  /// Replaces the vectors by those of their linear combinations that remain null vectors near this state: c·γ(v) is the
  /// same for all velocities v that satisfy the constraint equations (`ConstraintCurvature`). The other combinations
  /// reduce the rank of G only at this singular configuration.
  void keep_permanent() {
    VecX const rest_v = VecX::Zero(system_.velocities());
    VecX rest = VecX::Zero(system_.rows()), gamma = rest, w = rest_v, moved = rest_v;
    for (Index round = 0, tests = Index(vectors.size()); round <= tests && !vectors.empty(); ++round) {
      for (Index i = 0; i < w.size(); ++i)
        moved[i] = scattered_sign(i + round * w.size()) * (1.0 + 1.0 / double(i + round + 2));
      bias(moved, gamma);
      double const rounding = 1e-6 * largest_size(gamma);  // for constraints without free velocities
      forward_.hold(system_, x_.q, x_.v, x_.t);
      system_.rows_times(moved, gamma);
      forward_.least_change(system_, gamma, w);
      for (Index i = 0; i < w.size(); ++i) w[i] += moved[i];
      bias(rest_v, rest);
      bias(w, gamma);
      double const scale = std::max({largest_size(gamma), largest_size(rest), rounding, 1e-300});
      Sequence<VecX> left;
      for (VecX const& c : vectors) {
        VecX bent = VecX::Zero(1);
        for (Index k = 0; k < c.size(); ++k) bent[0] += c[k] * (gamma[k] - rest[k]) / scale;
        left.push_back(std::move(bent));
      }
      std::size_t const before = vectors.size();
      keep_null(left);
      if (vectors.size() == before) return;
    }
  }

  Sequence<VecX> vectors;  ///< null vectors c, each coefficient times the size of its equation

 private:
  RowSizes<> held() {
    forward_.hold(system_, x_.q, x_.v, x_.t);
    return RowSizes<>(system_);
  }
  VecX unscaled(VecX c) const {
    for (Index k = 0; k < c.size(); ++k) c[k] /= sizes_.of_row[k];
    return c;
  }
  void bias(VecX const& v, VecX& gamma) {
    system_.evaluate(x_.q, v, x_.t);
    system_.acceleration_bias(gamma);
    for (Index k = 0; k < gamma.size(); ++k) gamma[k] /= sizes_.of_row[k];
  }
  /// Replaces the vectors by linear combinations of them: those for which the combination of `left` with the same
  /// coefficients is zero. Uses Gram–Schmidt orthogonalisation with pivoting.
  void keep_null(Sequence<VecX>& left) {
    while (!vectors.empty()) {
      std::size_t worst = 0;
      double most = -1.0;
      for (std::size_t k = 0; k < vectors.size(); ++k) {
        double const size = 1.0 / largest_size(vectors[k]);
        vectors[k] *= size;
        left[k] *= size;
        if (double const of = largest_size(left[k]); of > most) most = of, worst = k;
      }
      if (!(most > RedundantLimits{}.dependent)) return;
      std::swap(vectors[worst], vectors.back());
      std::swap(left[worst], left.back());
      VecX const by = vectors.back(), of = left.back();
      vectors.pop_back();
      left.pop_back();
      double const squared = squares(of);
      for (std::size_t k = 0; k < vectors.size(); ++k) {
        double const part = left[k].dot(of) / squared;
        vectors[k] -= part * by;
        left[k] -= part * of;
      }
    }
  }

  System& system_;
  ForwardDynamics<Solver>& forward_;
  State const& x_;
  RowSizes<> sizes_;
};

/// True if the present choice of `forward` remains valid: the choice contains all dropped equations, and all
/// coefficients of their null vectors are bounded.
template <class Solver>
bool choice_serves(ForwardDynamics<Solver> const& forward, Sequence<VecX> const& null_vectors) {
  if (forward.redundant_rows().size() != forward.left_out().size()) return false;
  for (VecX const& c : null_vectors)
    if (largest_size(c) * RedundantLimits{}.kept > 1.0) return false;
  return true;
}

}  // namespace detail

/// Chooses the redundant constraint equations at x for `ForwardDynamics::mark_redundant`, or keeps a previous choice
/// that remains valid. Equations that are redundant only at x, a singular configuration, are not chosen. Returns true
/// if the choice has changed. If policies of the model eliminate bodies, nothing is chosen. \param lambda multipliers
/// of an earlier state, or null: equations whose multiplier is zero were chosen in that state and are preferred
template <class Solver>
[[gnu::cold]] bool leave_out_redundant(System& system, ForwardDynamics<Solver>& forward, State const& x,
                                       VecX const* lambda = nullptr) {
  forward.clear_doubt();
  if (system.rows() == 0 || equations_of(system) != system.size()) return false;
  Sequence<Index> const before(forward.left_out().begin(), forward.left_out().end());
  detail::NullVectors<Solver> space(system, forward, x);
  if (forward.redundant_rows().empty() || !space.find()) return false;
  if (!before.empty() && detail::choice_serves(forward, space.vectors)) return false;
  Sequence<char> preferred;
  if (lambda && lambda->size() == system.rows())
    for (Index i = 0; i < lambda->size(); ++i) preferred.push_back((*lambda)[i] == 0.0);
  auto const choose = [&] {
    Sequence<IndexMap<double>> vectors;
    for (VecX const& c : space.vectors) {
      vectors.emplace_back();
      for (Index i = 0; i < c.size(); ++i)
        if (c[i] != 0.0) vectors.back()[i] = c[i];
    }
    Sequence<Index> rows = detail::choose_redundant(vectors, preferred);
    for (Index& i : rows) i += system.velocities();
    forward.mark_redundant(rows);
    forward.hold(system, x.q, x.v, x.t);
  };
  space.keep_dependent();
  choose();  // after a factorisation with too many dropped rows due to small pivots, this one has the correct rank
  if (!space.find()) return true;
  space.keep_dependent();
  space.keep_permanent();
  choose();
  auto const dropped = forward.redundant_rows();
  // An equation that shares a node with a singular body is not dropped. The choice is then void.
  for (Index const i : forward.left_out())
    if (std::find(dropped.begin(), dropped.end(), i) == dropped.end()) {
      forward.mark_redundant({});
      break;
    }
  return !std::equal(before.begin(), before.end(), forward.left_out().begin(), forward.left_out().end());
}

}  // namespace polybody
