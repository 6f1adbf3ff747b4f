#pragma once
/// \file
/// Choice of the redundant constraint equations that a run drops. The choice follows from the null space of Gᵀ: an
/// equation may be dropped if its coefficient in a null vector is at least a tenth of the largest coefficient. If the
/// coefficients of all other equations are at most f times as large, the smallest singular value of the remaining
/// equations is within a factor of about f of its largest possible value [Gu & Eisenstat 1996, SIAM J. Sci. Comput.
/// 17(4), 848–869]. A factorisation that drops rows in a fixed order has no such bound. The factorisation divides by
/// the coefficient of the last row, which may pass through zero during a motion.
/// Theory: Eq. 7.11.

#include <algorithm>
#include <limits>

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
    double const largest = largest_size(c[k]);
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
      for (auto const& entry : c[k])
        if (!c[j].find(entry.index)) enter(entry.index, j);
      c[j].add(-*part, c[k]);
    }
  }
  sort_once(chosen);
  return chosen;
}

/// Entries of the constraint Jacobian G, and scales of velocities and equations. Velocities are scaled first, then
/// equations, so that every row of G has the norm 1 in any units.
template <class = void>  // compiled only if used
struct ScaledRows {
  VecX of_velocity, of_row;  ///< (nv), (rows); 1 for a velocity or an equation without entries
  /// Typical magnitudes of all equations for `BlockFactor::null_vectors`: the square roots of the diagonals of M and of
  /// G D⁻¹ Gᵀ, where D is the diagonal of M.
  VecX of_equation;

  explicit ScaledRows(System& system)
      : of_velocity(VecX::Zero(system.velocities())),
        of_row(VecX::Zero(system.rows())),
        of_equation(VecX::Zero(system.size())) {
    Index const velocities = system.velocities();
    Sink sink{velocities, *this};
    system.masses(sink);
    for (Entry const& e : emitted_) of_velocity[e.velocity] += e.value * e.value;
    take_roots(of_velocity);
    for (Entry const& e : emitted_) {
      double const by = of_velocity[e.velocity];
      of_row[e.row] += e.value * e.value / (by * by);
      of_equation[velocities + e.row] += e.value * e.value / of_equation[e.velocity];
    }
    take_roots(of_row);
    for (Index i = 0; i < velocities; ++i)
      if (!(of_equation[i] > 0.0)) of_equation[i] = std::numeric_limits<double>::infinity();
    for (Index i = 0; i < of_equation.size(); ++i) of_equation[i] = std::sqrt(of_equation[i]);
    sort_by_row();
  }

  /// Gᵀc for coefficients c of scaled rows, by velocity; the entries have the units of scaled velocities.
  IndexMap<double> transposed_times(IndexMap<double> const& c) {
    Sequence<Index> touched;
    for (auto const& [row, value] : c) {
      double const of = value / of_row[row];
      for (std::size_t k = first_[std::size_t(row)]; k < first_[std::size_t(row) + 1]; ++k) {
        sum_[by_row_[k].velocity] += by_row_[k].value * of;
        touched.push_back(by_row_[k].velocity);
      }
    }
    sort_once(touched);
    IndexMap<double> out;
    for (Index const i : touched) {
      out[i] = sum_[i] / of_velocity[i];
      sum_[i] = 0.0;
    }
    return out;
  }

 private:
  struct Entry {
    Index row, velocity;
    double value;
  };
  struct Sink {
    Index velocities;
    ScaledRows& rows;
    void add(Index row, Index col, BlockView const& b) {
      if (row >= velocities) return;
      for (Index j = 0; j < b.cols; ++j)
        for (Index i = 0; i < b.rows; ++i) {
          if (col < velocities && row + i == col + j) rows.of_equation[row + i] += b(i, j);
          if (col >= velocities && b(i, j) != 0.0) rows.emitted_.push_back({col - velocities + j, row + i, b(i, j)});
        }
    }
  };
  static void take_roots(VecX& sizes) {
    for (Index i = 0; i < sizes.size(); ++i) sizes[i] = sizes[i] > 0.0 ? std::sqrt(sizes[i]) : 1.0;
  }
  void sort_by_row() {
    first_.assign(std::size_t(of_row.size()) + 1, 0);
    for (Entry const& e : emitted_) ++first_[std::size_t(e.row) + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    by_row_ = emitted_;
    Sequence<std::size_t> next = first_;
    for (Entry const& e : emitted_) by_row_[next[std::size_t(e.row)]++] = e;
    emitted_.clear();
    sum_ = VecX::Zero(of_velocity.size());
  }

  Sequence<Entry> emitted_, by_row_;  // in the order of the blocks, and by rows
  Sequence<std::size_t> first_;       // first entry of each row in by_row_, and the number of all entries
  VecX sum_;                          // zero between two products
};

/// Null vectors of Gᵀ at a state, from a factorisation that drops the redundant equations.
template <class Solver>
class NullVectors {
 public:
  NullVectors(System& system, ForwardDynamics<Solver>& forward, State const& x)
      : system_(system), forward_(forward), x_(x), rows_(held()) {}

  /// Computes the null vectors from the last factorisation of `forward`: each has scaled coefficients, 1 at its dropped
  /// equation and 0 at the other dropped equations. Returns false for solvers that compute no null vectors.
  bool find() {
    Index const velocities = system_.velocities();
    auto const dropped = forward_.redundant_rows();
    Sequence<IndexMap<double>> const all = forward_.null_vectors(rows_.of_equation);
    if (all.size() != dropped.size()) return false;
    Sequence<IndexMap<double>> found;
    for (std::size_t k = 0; k < all.size(); ++k) {
      Index const own = dropped[k] - velocities;
      if (own < 0) return false;
      found.emplace_back();
      for (auto const& [i, value] : all[k])
        if (i >= velocities) found.back()[i - velocities] = value * (rows_.of_row[i - velocities] / rows_.of_row[own]);
    }
    vectors = std::move(found);
    return true;
  }
  /// Replaces the vectors by those of their linear combinations that satisfy Gᵀc = 0.
  void keep_dependent() {
    Sequence<IndexMap<double>> left;
    for (IndexMap<double> const& c : vectors) left.push_back(rows_.transposed_times(c));
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
      Sequence<IndexMap<double>> left;
      for (IndexMap<double> const& c : vectors) {
        double bent = 0.0;
        for (auto const& [k, value] : c) bent += value * (gamma[k] - rest[k]) / scale;
        left.emplace_back();
        left.back()[0] = bent;
      }
      std::size_t const before = vectors.size();
      keep_null(left);
      if (vectors.size() == before) return;
    }
  }

  Sequence<IndexMap<double>> vectors;  ///< null vectors c of the scaled equations

 private:
  ScaledRows<> held() {
    forward_.hold(system_, x_.q, x_.v, x_.t);
    return ScaledRows<>(system_);
  }
  void bias(VecX const& v, VecX& gamma) {
    system_.evaluate(x_.q, v, x_.t);
    system_.acceleration_bias(gamma);
    for (Index k = 0; k < gamma.size(); ++k) gamma[k] /= rows_.of_row[k];
  }
  /// Replaces the vectors by linear combinations of them: those for which the combination of `left` with the same
  /// coefficients is zero. Uses Gram–Schmidt orthogonalisation with pivoting.
  void keep_null(Sequence<IndexMap<double>>& left) {
    Sequence<double> sizes(vectors.size(), 0.0);
    auto const scale = [&](std::size_t k) {
      double const by = 1.0 / largest_size(vectors[k]);
      vectors[k].multiply(by);
      left[k].multiply(by);
      sizes[k] = largest_size(left[k]);
    };
    for (std::size_t k = 0; k < vectors.size(); ++k) scale(k);
    while (!vectors.empty()) {
      std::size_t const worst = std::size_t(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
      if (!(sizes[worst] > RedundantLimits{}.dependent)) return;
      IndexMap<double> const by = take_out(vectors, worst), of = take_out(left, worst);
      take_out(sizes, worst);
      double squared = 0.0;
      for (auto const& [i, value] : of) squared += value * value;
      for (std::size_t k = 0; k < vectors.size(); ++k) {
        double part = 0.0;
        for (auto const& [i, value] : of)
          if (double const* const other = left[k].find(i)) part += *other * value;
        if (part == 0.0) continue;
        vectors[k].add(-part / squared, by);
        left[k].add(-part / squared, of);
        scale(k);
      }
    }
  }
  /// Removes and returns value k. The last value takes its index.
  template <class T>
  static T take_out(Sequence<T>& values, std::size_t k) {
    std::swap(values[k], values.back());
    T taken = std::move(values.back());
    values.pop_back();
    return taken;
  }

  System& system_;
  ForwardDynamics<Solver>& forward_;
  State const& x_;
  ScaledRows<> rows_;
};

/// True if the present choice of `forward` remains valid: the choice contains all dropped equations, and no coefficient
/// of their null vectors exceeds 30.
template <class Solver>
bool choice_serves(ForwardDynamics<Solver> const& forward, Sequence<IndexMap<double>> const& null_vectors) {
  if (forward.redundant_rows().size() != forward.left_out().size()) return false;
  for (IndexMap<double> const& c : null_vectors)
    if (largest_size(c) * RedundantLimits{}.kept > 1.0) return false;
  return true;
}

}  // namespace detail

/// Chooses the redundant constraint equations at x for `ForwardDynamics::mark_redundant`, or keeps a previous choice
/// that remains valid. Equations that are redundant only at x, a singular configuration, are not chosen. Returns true
/// if the choice has changed. Nothing is chosen if the unknowns of the linear equations differ from those of a step, as
/// with joint coordinates. \param lambda multipliers of an earlier state, or null: equations whose multiplier is zero
/// were chosen in that state and are preferred
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
    Sequence<IndexMap<double>> vectors = space.vectors;
    Sequence<Index> rows = detail::choose_redundant(vectors, preferred);
    for (Index& i : rows) i += system.velocities();
    forward.mark_redundant(rows);
    forward.hold(system, x.q, x.v, x.t);
  };
  space.keep_dependent();
  choose();  // the new factorisation has the correct rank; the old one may have dropped too many rows for small pivots
  if (!space.find()) return true;
  space.keep_dependent();
  space.keep_permanent();
  choose();
  Sequence<Index> dropped(forward.redundant_rows().begin(), forward.redundant_rows().end());
  sort_once(dropped);
  auto const left_out = forward.left_out();
  // The solver keeps a chosen equation that shares a node of its factorisation with a singular body. The choice is then
  // void.
  if (!std::includes(dropped.begin(), dropped.end(), left_out.begin(), left_out.end())) forward.mark_redundant({});
  return !std::equal(before.begin(), before.end(), forward.left_out().begin(), forward.left_out().end());
}

}  // namespace polybody
