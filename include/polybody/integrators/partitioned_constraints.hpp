#pragma once
/// \file
/// Partition of dense constraint equations into dependent and independent columns.

#include <polybody/math/sequence.hpp>
#include <polybody/solvers/linear_solver.hpp>

namespace polybody {

/// Constraint equations G b = r (m×n) of rank k, with a partition into k dependent and n − k independent columns,
///   b_d = G_d⁻¹ r − R b_i,   R = G_d⁻¹ G_i,
/// by Gauss–Jordan elimination. Full pivoting selects the partition; redundant equations remain to the end and are
/// ignored [Wehage & Haug 1982; Shabana 2020]. A partition is kept while no entry of R exceeds a limit: |R_di| is the
/// factor by which |det G_d| would grow if columns i and d were exchanged. G is dense; an elimination costs m² n
/// operations. The class is also the block sink that collects G from a tangent [M, Gᵀ; G, 0].
/// Theory: Eq. 6.26.
class PartitionedConstraints {
 public:
  static constexpr int sides = 2;  ///< number of right-hand sides

  /// Allocates memory for m rows and n columns.
  PartitionedConstraints(Index rows, Index columns)
      : rows_(rows),
        columns_(columns),
        width_(columns + sides),
        a_(std::size_t(rows * width_)),
        dependents_(std::size_t(rows)),
        state_(std::size_t(columns)) {}

  long choices = 0;  ///< number of selected partitions

  Index rank() const { return rank_; }  ///< k, number of dependent columns; −1 before a partition is selected
  /// True if the column is dependent in the present partition.
  bool is_dependent(Index column) const { return state_[std::size_t(column)] != Column::independent; }
  /// Discards the partition, so that the next `reduce` returns false.
  void forget() { rank_ = none; }

  void begin() { std::fill(a_.begin(), a_.end(), 0.0); }  ///< sets all entries of G and r to zero
  /// Adds a block of a tangent [M, Gᵀ; G, 0] with its first entry at (row, col); only entries of G are used.
  void add(Index row, Index col, BlockView const& b) {
    if (row < columns_ || col >= columns_) return;
    for (Index i = 0; i < b.rows; ++i)
      for (Index j = 0; j < b.cols; ++j) at(row - columns_ + i, col + j) += b(i, j);
  }
  /// Excludes a row until the next `begin`, by setting its entries to zero.
  void mark_redundant(Index row) { std::fill_n(&at(row, 0), width_, 0.0); }
  /// Entry `row` of right-hand side number `side`.
  double& right(int side, Index row) { return at(row, columns_ + side); }

  /// Solves for b_d with b_i = 0 in the present partition. Returns false if no partition is selected, or if the rank or
  /// an entry of R does not permit the present partition. All entries must then be added again before `choose`. \param
  /// limit largest permitted |R|
  bool reduce(double limit) {
    if (rank_ == none) return false;
    for (Column& c : state_)
      if (c == Column::used) c = Column::dependent;
    double const enough = redundant_below * largest(0, columns_);
    for (Index k = 0; k < rank_; ++k)
      if (!eliminate(k, Column::dependent, enough)) return false;
    if (largest(rank_, columns_) > enough) return false;  // redundant equations are now independent
    for (Index k = 0; k < rank_; ++k)
      for (Index j = 0; j < columns_; ++j)
        if (!is_dependent(j) && !(std::abs(at(k, j)) <= limit)) return false;
    return true;
  }

  /// Selects a partition and solves for b_d with b_i = 0.
  void choose() {
    ++choices;
    std::fill(state_.begin(), state_.end(), Column::independent);
    double const enough = redundant_below * largest(0, columns_);
    for (rank_ = 0; rank_ < rows_ && eliminate(rank_, Column::independent, enough);) ++rank_;
  }

  /// Computes b for right-hand side number `side`, with b_i = 0.
  void solution(int side, VecX& b) {
    b.setZero();
    for (Index k = 0; k < rank_; ++k) b[dependents_[std::size_t(k)]] = right(side, k);
  }

 private:
  enum class Column : char { independent, dependent, used };  ///< used: dependent, and its pivot is found
  static constexpr Index none = -1;
  /// A pivot below this fraction of the largest entry belongs to a redundant equation.
  static constexpr double redundant_below = 1e-9;

  double& at(Index i, Index j) { return a_[std::size_t(i * width_ + j)]; }

  /// Largest magnitude in the first `columns` columns of the rows from `first` on.
  double largest(Index first, Index columns) {
    double most = 0.0;
    for (Index i = first; i < rows_; ++i)
      for (Index j = 0; j < columns; ++j) most = std::max(most, std::abs(at(i, j)));
    return most;
  }

  /// Elimination step k: finds the largest pivot in columns of state `from` and in rows from k on, and transforms its
  /// column to column k of the identity. Returns false if no pivot exceeds `enough`.
  bool eliminate(Index k, Column from, double enough) {
    double most = enough;
    Index row = none, column = none;
    for (Index i = k; i < rows_; ++i)
      for (Index j = 0; j < columns_; ++j)
        if (state_[std::size_t(j)] == from && std::abs(at(i, j)) > most) {
          most = std::abs(at(i, j));
          row = i;
          column = j;
        }
    if (row == none) return false;
    state_[std::size_t(column)] = Column::used;
    dependents_[std::size_t(k)] = column;
    double* const pivot = &at(k, 0);
    if (row != k) std::swap_ranges(pivot, pivot + width_, &at(row, 0));
    double const inverse = 1.0 / pivot[column];
    for (Index j = 0; j < width_; ++j) pivot[j] *= inverse;
    for (Index i = 0; i < rows_; ++i) {
      double const f = at(i, column);
      if (i == k || f == 0.0) continue;
      for (Index j = 0; j < width_; ++j) at(i, j) -= f * pivot[j];
    }
    return true;
  }

  Index rows_, columns_, width_;
  Index rank_ = none;
  Sequence<double> a_;  // by rows, right-hand sides last
  Sequence<Index> dependents_;
  Sequence<Column> state_;
};

}  // namespace polybody
