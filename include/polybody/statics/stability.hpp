#pragma once
/// \file
/// Stability of an equilibrium.

#include <algorithm>
#include <functional>
#include <utility>

#include <polybody/statics/static_tangent.hpp>
#include <polybody/statics/symmetric_pivots.hpp>

namespace polybody::detail {

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
  static constexpr double redundant =
      1e-10;  ///< largest remainder of a redundant constraint equation, relative to its largest entry
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
/// K is symmetrised. A negative pivot counts only if its motion x has a negative xᵀK x. This sum is computed in long
/// double and must be negative beyond the round-off of its terms.
struct Stability {
  Index negative = -1;  ///< number of negative eigenvalues; −1: the matrix is too large
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

/// Stability at the state of the last factorisation of `tangent`.
template <LinearSolver Solver>
Stability stability(System const& system, StaticTangent<Solver>& tangent, VecX const& lambda) {
  Stability out;
  StaticEntries entries{system.velocities()};
  tangent.write_scaled(lambda, entries);
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
  for (Index const k : pivots.negative()) {
    VecX const z = pivots.direction(k);
    VecX x = VecX::Zero(system.velocities());
    for (std::size_t i = 0; i < place.size(); ++i) each(int(i), [&](int j, double a) { x[Index(i)] += a * z[j]; });
    if (!is_negative<>(entries, x)) continue;
    if (out.negative++ == 0) out.motion = std::move(x);
  }
  return out;
}

}  // namespace polybody::detail
