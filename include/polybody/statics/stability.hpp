#pragma once
/// \file
/// Stability of an equilibrium: number of negative eigenvalues of its stiffness.
/// Theory: Eq. 7.19.

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <polybody/math/sequence.hpp>
#include <polybody/math/types.hpp>
#include <polybody/statics/static_tangent.hpp>
#include <polybody/system/state.hpp>

namespace polybody::detail {

// Numbers of negative and zero eigenvalues of a sparse symmetric matrix (inertia, by Sylvester's law).

/// Signs of the eigenvalues of a sparse symmetric matrix R: the pivots D of P R Pᵀ = L D Lᵀ have these signs
/// (Sylvester's law of inertia). P is the permutation to an approximate minimum degree order. L is computed row by row
/// along the elimination tree [Davis 2006, §4.7]. A pivot below 1e-13 of the sum of its terms' magnitudes counts as
/// zero and is replaced by this sum. Both triangles of R must be stored.
class SymmetricPivots {
 public:
  static constexpr double rounding = 1e-13;        ///< largest pivot that counts as zero, relative to its terms
  static constexpr Index most_entries = 40000000;  ///< largest number of entries of L

  using Matrix = Eigen::SparseMatrix<double>;

  /// Computes the factors. Returns false if L would have more than `most_entries` entries.
  template <class = void>  // compiled where it is used
  bool factor(Matrix const& r) {
    size_ = r.cols();
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
    Eigen::AMDOrdering<int>()(r, order);  // unknown order[k] of R becomes number k
    place_.assign(std::size_t(size_), 0);
    order_.assign(std::size_t(size_), 0);
    for (Index k = 0; k < size_; ++k) {
      order_[std::size_t(k)] = order.indices()[k];
      place_[std::size_t(order.indices()[k])] = int(k);
    }
    if (!analyse(r)) return false;
    eliminate(r);
    return true;
  }
  /// Positions of the pivots that are negative beyond round-off.
  Sequence<Index> const& negative() const { return negative_; }
  Index zero() const { return zero_; }  ///< number of pivots that are zero up to round-off
  /// Vector x with xᵀR x = pivot at position k: Lᵀ P x = e_k.
  template <class = void>
  VecX direction(Index k) const {
    VecX y = VecX::Zero(size_), x(size_);
    y[k] = 1.0;
    for (Index j = k; j >= 0; --j)
      for (Index p = first_[std::size_t(j)]; p < first_[std::size_t(j)] + filled_[std::size_t(j)]; ++p)
        y[j] -= value_[std::size_t(p)] * y[row_[std::size_t(p)]];
    for (Index i = 0; i < size_; ++i) x[order_[std::size_t(i)]] = y[i];
    return x;
  }

 private:
  /// Calls `visit(i, value)` for the entries i < k of column k of P R Pᵀ. From these, the entries of row k of L are
  /// found along the elimination tree.
  template <class Visit>
  void reach(Matrix const& r, int k, Visit&& visit) {
    mark_[std::size_t(k)] = k;
    for (Matrix::InnerIterator entry(r, order_[std::size_t(k)]); entry; ++entry) {
      int i = place_[std::size_t(entry.index())];
      if (i < k) visit(i, entry.value());
    }
  }

  template <class = void>
  bool analyse(Matrix const& r) {
    std::size_t const n = std::size_t(size_);
    parent_.assign(n, -1);
    mark_.assign(n, -1);
    filled_.assign(n, 0);
    first_.assign(n + 1, 0);
    for (int k = 0; k < int(size_); ++k)
      reach(r, k, [&](int i, double) {
        for (; mark_[std::size_t(i)] != k; i = parent_[std::size_t(i)]) {
          if (parent_[std::size_t(i)] < 0) parent_[std::size_t(i)] = k;
          ++filled_[std::size_t(i)];
          mark_[std::size_t(i)] = k;
        }
      });
    for (std::size_t k = 0; k < n; ++k) first_[k + 1] = first_[k] + filled_[k];
    if (first_[n] > most_entries) return false;
    row_.assign(std::size_t(first_[n]), 0);
    value_.assign(std::size_t(first_[n]), 0.0);
    return true;
  }

  template <class = void>
  void eliminate(Matrix const& r) {
    std::size_t const n = std::size_t(size_);
    Sequence<double> y(n, 0.0), d(n, 0.0);
    Sequence<int> path(n, 0), pattern(n, 0);
    mark_.assign(n, -1);
    filled_.assign(n, 0);
    negative_.clear();
    zero_ = 0;
    for (int k = 0; k < int(size_); ++k) {
      std::size_t top = n;
      reach(r, k, [&](int i, double value) {
        y[std::size_t(i)] += value;
        std::size_t length = 0;
        for (; mark_[std::size_t(i)] != k; i = parent_[std::size_t(i)]) {
          path[length++] = i;
          mark_[std::size_t(i)] = k;
        }
        while (length > 0) pattern[--top] = path[--length];
      });
      double pivot = r.coeff(order_[std::size_t(k)], order_[std::size_t(k)]), terms = std::abs(pivot);
      for (; top < n; ++top) {
        std::size_t const i = std::size_t(pattern[top]);
        double const yi = y[i], lki = yi / d[i];
        y[i] = 0.0;
        for (Index p = first_[i]; p < first_[i] + filled_[i]; ++p)
          y[std::size_t(row_[std::size_t(p)])] -= value_[std::size_t(p)] * yi;
        pivot -= lki * yi;
        terms += std::abs(lki * yi);
        Index const at = first_[i] + filled_[i]++;
        row_[std::size_t(at)] = k;
        value_[std::size_t(at)] = lki;
      }
      if (std::abs(pivot) <= rounding * terms) {
        ++zero_;
        pivot = terms > 0.0 ? terms : 1.0;
      } else if (pivot < 0.0) {
        negative_.push_back(k);
      }
      d[std::size_t(k)] = pivot;
    }
  }

  Index size_ = 0, zero_ = 0;
  Sequence<int> order_, place_, parent_, mark_, row_;
  Sequence<Index> first_, filled_, negative_;
  Sequence<double> value_;
};

/// Nonzero entries of the matrix of the equations of statics, in separate lists for K and G.
struct StaticEntries {
  struct Entry {
    int row, col;
    double value;
  };
  Index velocities;
  Sequence<Entry> stiffness = {}, rows = {};

  void add(Index row, Index col, BlockView const& b) {
    if (col >= velocities) return;  // block of Gᵀ
    for (Index j = 0; j < b.cols; ++j)
      for (Index i = 0; i < b.rows; ++i)
        if (double const value = b(i, j); value != 0.0) {
          Entry const entry{int(row + i), int(col + j), value};
          if (row < velocities)
            stiffness.push_back(entry);
          else
            rows.push_back({int(row + i - velocities), entry.col, value});
        }
  }
};

/// Linear combination of coordinates.
struct CoordinateSum {
  Sequence<int> columns = {};
  Sequence<double> factors = {};
};

/// Dependent coordinates, expressed by others through the constraint equations.
class DependentCoordinates {
 public:
  /// Largest remainder of a redundant constraint equation, relative to its largest entry.
  static constexpr double redundant = 1e-10;
  static constexpr std::size_t most_terms = 20000000;

  /// Computes the linear combinations of free coordinates. Returns false if they have more than `most_terms` terms.
  template <class = void>  // compiled where it is used
  bool find(StaticEntries const& entries, Index rows) {
    std::size_t const n = std::size_t(entries.velocities);
    order_.assign(n, -1);
    work_.assign(n, 0.0);
    used_.assign(n, 0);
    Sequence<Sequence<StaticEntries::Entry>> by_row{std::size_t(rows)};
    for (auto const& e : entries.rows) by_row[std::size_t(e.row)].push_back(e);
    for (auto const& row : by_row) {
      double largest = 0.0;
      for (auto const& e : row) {
        add(e.col, e.value);
        largest = std::max(largest, std::abs(e.value));
      }
      reduce();
      give(redundant * largest);
    }
    std::size_t terms = 0;
    for (std::size_t k = sums_.size(); k-- > 0;) {  // from last to first, expressed by free coordinates
      for (std::size_t i = 0; i < sums_[k].columns.size(); ++i) add(sums_[k].columns[i], sums_[k].factors[i]);
      reduce();
      sums_[k] = take();
      terms += sums_[k].columns.size();
      if (terms > most_terms) return false;
    }
    return true;
  }
  /// Linear combination of free coordinates for a dependent one; null if the coordinate is free.
  CoordinateSum const* sum(int column) const {
    int const k = order_[std::size_t(column)];
    return k < 0 ? nullptr : &sums_[std::size_t(k)];
  }

 private:
  void add(int column, double value) {
    if (!used_[std::size_t(column)]) {
      used_[std::size_t(column)] = 1;
      touched_.push_back(column);
      if (order_[std::size_t(column)] >= 0) {
        pending_.push_back(order_[std::size_t(column)]);
        std::push_heap(pending_.begin(), pending_.end(), std::greater<int>());
      }
    }
    work_[std::size_t(column)] += value;
  }
  /// Substitutes linear combinations for dependent coordinates, in the order of their computation.
  void reduce() {
    while (!pending_.empty()) {
      std::pop_heap(pending_.begin(), pending_.end(), std::greater<int>());
      CoordinateSum const& sum = sums_[std::size_t(pending_.back())];
      std::size_t const column = std::size_t(dependent_[std::size_t(pending_.back())]);
      pending_.pop_back();
      double const value = std::exchange(work_[column], 0.0);
      if (value == 0.0) continue;
      for (std::size_t i = 0; i < sum.columns.size(); ++i) add(sum.columns[i], value * sum.factors[i]);
    }
  }
  /// Solves the present constraint equation for the coordinate with the largest entry, if this entry exceeds `least`.
  void give(double least) {
    int best = -1;
    double most = least;
    for (int const c : touched_)
      if (std::abs(work_[std::size_t(c)]) > most) {
        most = std::abs(work_[std::size_t(c)]);
        best = c;
      }
    double const pivot = best < 0 ? 1.0 : std::exchange(work_[std::size_t(best)], 0.0);
    CoordinateSum sum = take();
    if (best < 0) return;
    for (double& f : sum.factors) f /= -pivot;
    order_[std::size_t(best)] = int(sums_.size());
    dependent_.push_back(best);
    sums_.push_back(std::move(sum));
  }
  /// Returns the present linear combination and clears it.
  CoordinateSum take() {
    CoordinateSum sum;
    for (int const c : touched_) {
      double const value = std::exchange(work_[std::size_t(c)], 0.0);
      used_[std::size_t(c)] = 0;
      if (value == 0.0) continue;
      sum.columns.push_back(c);
      sum.factors.push_back(value);
    }
    touched_.clear();
    return sum;
  }

  Sequence<int> order_, dependent_, touched_, pending_;
  Sequence<char> used_;
  Sequence<double> work_;
  Sequence<CoordinateSum> sums_;
};

/// Stability of an equilibrium: number of negative eigenvalues of ZᵀK Z, with a basis Z of the motions that the
/// constraint equations permit, G Z = 0. Z is computed by elimination. Each constraint equation expresses one
/// coordinate by others,
///   G_d x_d + G_f x_f = 0,  Z = [−G_d⁻¹ G_f; 1].
/// K is symmetrised. A negative pivot is counted only if its motion x has a negative xᵀK x. The sum xᵀK x is computed
/// in long double and must be negative beyond the round-off of its terms, and in neighbouring states too. The spin of a
/// payload about its rope, for example, has an xᵀK x proportional to the square of the error of the state.
struct Stability {
  Index negative = -1;  ///< number of negative eigenvalues; −1: more than `most_entries` or `most_terms`
  VecX motion = {};     ///< (nv) motion with negative xᵀK x; empty if there is none
};

/// Returns true if xᵀK x is negative beyond round-off.
template <class = void>  // compiled where it is used
bool is_negative(StaticEntries const& entries, VecX const& x) {
  long double sum = 0.0L, terms = 0.0L;
  for (auto const& e : entries.stiffness) {
    long double const term = static_cast<long double>(e.value) * x[e.row] * x[e.col];
    sum += term;
    terms += std::abs(term);
  }
  return sum < -1e-15L * terms;
}

/// Stability in the state x with x.v = 0, up to changes of the coordinates by `error`, relative to 1 + max |q|.
template <LinearSolver Solver>
Stability stability(System& system, StaticTangent<Solver>& tangent, State const& x, double error) {
  Stability out;
  auto const entries_at = [&](VecX const& q) {
    system.evaluate(q, x.v, x.t);
    StaticEntries entries{system.velocities()};
    tangent.write_scaled(x.lambda, entries);
    return entries;
  };
  StaticEntries const entries = entries_at(x.q);
  DependentCoordinates dependent;
  if (!dependent.find(entries, system.rows())) return out;
  Sequence<int> place(std::size_t(system.velocities()), -1);
  int free = 0;
  for (std::size_t i = 0; i < place.size(); ++i)
    if (dependent.sum(int(i)) == nullptr) place[i] = free++;
  Sequence<Eigen::Triplet<double>> reduced;
  auto const each = [&](int column, auto&& visit) {
    CoordinateSum const* const sum = dependent.sum(column);
    if (sum == nullptr) return visit(place[std::size_t(column)], 1.0);
    for (std::size_t i = 0; i < sum->columns.size(); ++i) visit(place[std::size_t(sum->columns[i])], sum->factors[i]);
  };
  for (auto const& e : entries.stiffness)
    each(e.row, [&](int i, double a) {
      each(e.col, [&](int j, double b) {
        reduced.emplace_back(i, j, 0.5 * a * b * e.value);
        reduced.emplace_back(j, i, 0.5 * a * b * e.value);
      });
    });
  if (reduced.size() > 4 * DependentCoordinates::most_terms) return out;
  out.negative = 0;
  if (free == 0) return out;
  SymmetricPivots::Matrix r(free, free);
  r.setFromTriplets(reduced.begin(), reduced.end());
  SymmetricPivots pivots;
  if (!pivots.factor(r)) return {};
  Sequence<StaticEntries> near;  // in two states on opposite sides of x
  for (Index const k : pivots.negative()) {
    VecX const z = pivots.direction(k);
    VecX motion = VecX::Zero(system.velocities());
    for (std::size_t i = 0; i < place.size(); ++i) each(int(i), [&](int j, double a) { motion[Index(i)] += a * z[j]; });
    if (!is_negative<>(entries, motion)) continue;
    if (near.empty()) {
      VecX change(system.velocities()), q = x.q;
      tangent.fill_without_order(0, change);
      change *= error * (1.0 + largest_size(x.q));
      for (double const side : {1.0, -1.0}) {
        system.plus(x.q, side * change, q);
        near.push_back(entries_at(q));
      }
    }
    if (!(is_negative<>(near[0], motion) && is_negative<>(near[1], motion))) continue;
    if (out.negative++ == 0) out.motion = std::move(motion);
  }
  if (!near.empty()) system.evaluate(x.q, x.v, x.t);
  return out;
}

}  // namespace polybody::detail
