#pragma once
/// \file
/// Partition of sparse constraint equations into dependent and independent columns.

#include <memory>

#include <Eigen/SparseLU>
#include <Eigen/SparseQR>

#include <polybody/math/sequence.hpp>
#include <polybody/solvers/linear_solver.hpp>

namespace polybody {

/// Partition as in `PartitionedConstraints`, for sparse G: constraint equations G b = r (m×n) of rank k, with b_d =
/// G_d⁻¹ r for b_i = 0. The first partition results from rank-revealing sparse QR factorisations: of G for the columns,
/// and of G_dᵀ for the independent equations. Each renewal computes R = G_d⁻¹ G_i. If an entry exceeds the limit, its
/// column i and the dependent column of its row are exchanged, which multiplies |det G_d| by that entry. Exchanges
/// continue until no entry exceeds the limit [Wehage & Haug 1982; the exchanges as in Knuth 1985]. The factorisation of
/// G_d is reused between renewals. The class is also the block sink that collects G from a tangent [M, Gᵀ; G, 0]. T is
/// `double`; a program that does not use this template does not compile it.
/// Theory: Eq. 6.26.
template <class T = double>
class SparsePartitionOf {
 public:
  using Matrix = Eigen::SparseMatrix<T, Eigen::ColMajor, int>;  ///< type of G and its parts

  /// Partition for m rows and n columns.
  SparsePartitionOf(Index rows, Index columns)
      : rows_(rows), columns_(columns), left_out_(std::size_t(rows), false), g_(rows, columns) {}

  long choices = 0;         ///< number of changes of the partition
  long factorisations = 0;  ///< number of factorisations of G_d

  Index rank() const { return Index(dependents_.size()); }  ///< k, number of dependent columns
  /// True if the column is dependent in the present partition; false before the first partition.
  bool is_dependent(Index column) const { return chosen_ && place_[std::size_t(column)] >= 0; }
  /// Largest magnitude of an entry of G at the last renewal; zero before the first one.
  T largest_entry() const { return largest_entry_; }
  bool has_factors() const { return factored_; }  ///< true if G_d has been factorised since the last `forget`
  /// Discards the partition: the next renewal selects a new one.
  void forget() { factored_ = chosen_ = false; }

  void begin() { entries_.clear(); }  ///< discards the entries of G
  /// Adds a block of a tangent [M, Gᵀ; G, 0] with its first entry at (row, col); only entries of G are used.
  void add(Index row, Index col, BlockView const& b) {
    if (row < columns_ || col >= columns_) return;
    for (Index i = 0; i < b.rows; ++i)
      if (!left_out_[std::size_t(row - columns_ + i)])
        for (Index j = 0; j < b.cols; ++j) entries_.emplace_back(int(row - columns_ + i), int(col + j), b(i, j));
  }
  /// Excludes a row permanently.
  void mark_redundant(Index row) { left_out_[std::size_t(row)] = true; }

  /// Factorises G_d of the entries added since `begin`, and changes the partition if necessary. \param limit largest
  /// permitted |R| \throws SingularMatrix if the factorisation fails
  void renew(T limit) {
    g_.setFromTriplets(entries_.begin(), entries_.end());
    largest_entry_ = largest(g_);
    if (!(chosen_ && factor())) {
      choose();
      if (!factor()) throw_lost();
    }
    if (exchange(limit)) {
      ++choices;
      if (!factor()) throw_lost();
    }
  }

  /// Solves the independent equations of G_d b_d = `given`, and sets the other entries of b to zero.
  void solve(VecXOf<T> const& given, VecXOf<T>& b) {
    b.setZero();
    if (rank() == 0) return;
    for (std::size_t k = 0; k < kept_rows_.size(); ++k) right_[Index(k)] = given[kept_rows_[k]];
    solution_ = lu_->solve(right_);
    for (std::size_t k = 0; k < dependents_.size(); ++k) b[dependents_[k]] = solution_[Index(k)];
  }

 private:
  using Qr = Eigen::SparseQR<Matrix, Eigen::COLAMDOrdering<int>>;
  /// Pivot thresholds relative to the largest entry. A column with a pivot below `redundant_below` is a linear
  /// combination of others. `adds_enough` is the first threshold of the selection.
  static constexpr T redundant_below = 1e-9, adds_enough = 0.1;
  using Lu = Eigen::SparseLU<Matrix, Eigen::COLAMDOrdering<int>>;

  [[noreturn]] static void throw_lost() {
    throw SingularMatrix("partition.singular",
                         {ErrorObject{"CoordinatePartitioning"},
                          ": no set of dependent velocities solves the constraint equations, because the configuration "
                          "is nearly singular. Start from another configuration, or use an implicit integrator."});
  }

  /// Indices of linearly independent columns of g. A factorisation selects each column whose pivot exceeds a threshold,
  /// in an order that keeps the factors sparse. Of the thresholds 0.1, 0.01, …, the highest one that selects as many
  /// columns as `redundant_below` is used, to avoid nearly dependent columns.
  static Sequence<Index> independent_columns(Matrix g) {
    T const most = largest(g);
    if (most == 0.0) return {};  // no entries, or all are zero
    g.makeCompressed();
    Qr qr;
    qr.analyzePattern(g);
    auto const rank_at = [&](T threshold) {
      qr.setPivotThreshold(threshold * most);
      qr.factorize(g);
      return qr.rank();
    };
    if (rank_at(adds_enough) < std::min(g.rows(), g.cols())) {
      Index const all = rank_at(redundant_below);
      for (T threshold = adds_enough; rank_at(std::max(threshold, redundant_below)) < all;) threshold *= 0.1;
    }
    Sequence<Index> out;
    for (Index k = 0; k < qr.rank(); ++k) out.push_back(qr.colsPermutation().indices()[k]);
    return out;
  }
  static T largest(Matrix const& g) {
    T most = 0.0;
    for (Index k = 0; k < g.nonZeros(); ++k) most = std::max(most, std::abs(g.valuePtr()[k]));
    return most;
  }

  void choose() {
    ++choices;
    dependents_ = independent_columns(g_);
    place_.assign(std::size_t(columns_), -1);
    kept_rows_.clear();
    row_place_.assign(std::size_t(rows_), -1);
    for (Index i = 0; i < rows_; ++i) {
      row_place_[std::size_t(i)] = i;
      kept_rows_.push_back(i);
    }
    take_columns();
    kept_rows_ = independent_columns(Matrix(gd_.transpose()));
    if (kept_rows_.size() != dependents_.size()) throw_lost();
    row_place_.assign(std::size_t(rows_), -1);
    for (std::size_t k = 0; k < kept_rows_.size(); ++k) row_place_[std::size_t(kept_rows_[k])] = Index(k);
    right_.setZero(rank());
    solution_.setZero(rank());
    chosen_ = true;
    analysed_ = false;
  }
  /// Assembles G_d, and stores the position of each dependent column in G_d.
  void take_columns() {
    some_.clear();
    for (std::size_t k = 0; k < dependents_.size(); ++k) {
      place_[std::size_t(dependents_[k])] = Index(k);
      for (typename Matrix::InnerIterator e(g_, dependents_[k]); e; ++e)
        if (Index const row = row_place_[std::size_t(e.row())]; row >= 0)
          some_.emplace_back(int(row), int(k), e.value());
    }
    gd_.resize(Index(kept_rows_.size()), rank());
    gd_.setFromTriplets(some_.begin(), some_.end());
  }

  bool factor() {
    ++factorisations;
    take_columns();
    if (rank() == 0) return factored_ = true;
    if (!analysed_) lu_->analyzePattern(gd_);
    analysed_ = true;
    lu_->factorize(gd_);
    return factored_ = lu_->info() == Eigen::Success;
  }

  /// Exchanges columns until no entry of R exceeds the limit. Returns true if there was an exchange.
  bool exchange(T limit) {
    Index const k = rank(), n = columns_ - k;
    free_.clear();
    for (Index j = 0; j < columns_; ++j)
      if (!is_dependent(j)) free_.push_back(j);
    if (k == 0 || n == 0) return false;
    r_.resize(k, n);
    for (Index j = 0; j < n; ++j) {
      right_.setZero();
      for (typename Matrix::InnerIterator e(g_, free_[std::size_t(j)]); e; ++e)
        if (Index const row = row_place_[std::size_t(e.row())]; row >= 0) right_[row] = e.value();
      r_.col(j) = lu_->solve(right_);
    }
    bool changed = false;
    for (;;) {
      Index row = 0, col = 0;
      T const most = r_.cwiseAbs().maxCoeff(&row, &col);
      if (!(most > limit)) break;  // also for NaN, which the factorisation detects
      pivot(row, col);
      place_[std::size_t(dependents_[std::size_t(row)])] = -1;
      std::swap(dependents_[std::size_t(row)], free_[std::size_t(col)]);
      place_[std::size_t(dependents_[std::size_t(row)])] = row;
      changed = true;
      analysed_ = false;
    }
    return changed;
  }
  /// Updates R after an exchange of two columns of G: the dependent one of row `row` of R, and the independent one of
  /// column `col` of R.
  void pivot(Index row, Index col) {
    T const inverse = 1.0 / r_(row, col);
    r_.row(row) *= inverse;
    r_(row, col) = inverse;
    for (Index i = 0; i < r_.rows(); ++i) {
      T const f = r_(i, col);
      if (i == row || f == 0.0) continue;
      r_(i, col) = 0.0;
      r_.row(i) -= f * r_.row(row);
    }
  }

  Index rows_, columns_;
  Sequence<bool> left_out_;
  std::vector<Eigen::Triplet<T>> entries_, some_;
  Matrix g_, gd_;
  std::unique_ptr<Lu> lu_ = std::make_unique<Lu>();                    // a pointer, because Lu cannot be moved
  Sequence<Index> dependents_, free_, kept_rows_, place_, row_place_;  ///< place: index in dependents_ or kept_rows_
  T largest_entry_ = 0.0;
  MatXOf<T> r_;
  VecXOf<T> right_, solution_;
  bool chosen_ = false, analysed_ = false, factored_ = false;
};

}  // namespace polybody
