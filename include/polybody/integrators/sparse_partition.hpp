#pragma once
#include <memory>

#include <Eigen/SparseLU>
#include <Eigen/SparseQR>

#include <polybody/math/sequence.hpp>
#include <polybody/solvers/linear_solver.hpp>

namespace polybody {

/// The split of `PartitionedConstraints` for large systems: rows G b = r (m×n) of rank k, b_d = G_d⁻¹ r for b_i = 0.
/// The first split is that of a rank-revealing sparse QR factorisation, of G for its columns and of G_dᵀ for the rows
/// that repeat no others. Each renewal looks at R = G_d⁻¹ G_i: where an entry exceeds the limit, its column i changes
/// places with the dependent one of its row, which multiplies |det G_d| by that entry, until none does [Wehage & Haug
/// 1982; the exchanges as in Knuth 1985]. Factors of G_d are kept between renewals. Itself the sink of the rows of a
/// tangent [M, Gᵀ; G, 0]. T is `double`: a template, so that a program without it compiles none of it.
template <class T = double>
class SparsePartitionOf {
 public:
  using Matrix = Eigen::SparseMatrix<T, Eigen::ColMajor, int>;  ///< G and its parts

  /// For m rows and n columns.
  SparsePartitionOf(Index rows, Index columns)
      : rows_(rows), columns_(columns), left_out_(std::size_t(rows), false), g_(rows, columns) {}

  long choices = 0;         ///< how often the split changed
  long factorisations = 0;  ///< of G_d

  Index rank() const { return Index(dependents_.size()); }  ///< k, the dependent columns
  /// Whether a column is a dependent one, as the split stands; none is before the first split.
  bool is_dependent(Index column) const { return chosen_ && place_[std::size_t(column)] >= 0; }
  /// The largest entry of G at the last renewal; zero before.
  T largest_entry() const { return largest_entry_; }
  bool has_factors() const { return factored_; }  ///< G_d has been factored since the last `forget`
  /// The next renewal chooses from nothing.
  void forget() { factored_ = chosen_ = false; }

  void begin() { entries_.clear(); }  ///< the rows are written anew
  /// Adds a block of a tangent [M, Gᵀ; G, 0] whose first entry is at (row, col); only G is taken.
  void add(Index row, Index col, BlockView const& b) {
    if (row < columns_ || col >= columns_) return;
    for (Index i = 0; i < b.rows; ++i)
      if (!left_out_[std::size_t(row - columns_ + i)])
        for (Index j = 0; j < b.cols; ++j) entries_.emplace_back(int(row - columns_ + i), int(col + j), b(i, j));
  }
  /// Leaves a row out of account for good.
  void mark_redundant(Index row) { left_out_[std::size_t(row)] = true; }

  /// Factors of G_d for the rows that were written; the split changes where it must. \param limit of |R|
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

  /// b = [b_d, 0] with G_d b_d = given, in the rows that repeat no others.
  void solve(VecXOf<T> const& given, VecXOf<T>& b) {
    b.setZero();
    if (rank() == 0) return;
    for (std::size_t k = 0; k < kept_rows_.size(); ++k) right_[Index(k)] = given[kept_rows_[k]];
    solution_ = lu_->solve(right_);
    for (std::size_t k = 0; k < dependents_.size(); ++k) b[dependents_[k]] = solution_[Index(k)];
  }

 private:
  using Qr = Eigen::SparseQR<Matrix, Eigen::COLAMDOrdering<int>>;
  /// Shares of the largest entry: a column that adds less repeats others; one that adds more is taken at sight.
  static constexpr T repeats = 1e-9, adds_enough = 0.1;
  using Lu = Eigen::SparseLU<Matrix, Eigen::COLAMDOrdering<int>>;

  [[noreturn]] static void throw_lost() {
    throw SingularMatrix("partition.singular",
                         {ErrorObject{"CoordinatePartitioning"},
                          ": no set of dependent velocities solves the constraint equations, because the configuration "
                          "is close to a singular configuration. Start elsewhere, or use an implicit integrator."});
  }

  /// Columns of g that are independent, by their numbers. A factorisation takes a column where it adds more than its
  /// threshold, in the order that keeps the factors sparse: the highest threshold that still finds all columns there
  /// are, so that none is taken that hardly adds anything.
  static Sequence<Index> independent_columns(Matrix g) {
    T const most = largest(g);
    if (most == 0.0) return {};  // no rows, or none of them acts
    g.makeCompressed();
    Qr qr;
    qr.analyzePattern(g);
    auto const rank_at = [&](T threshold) {
      qr.setPivotThreshold(threshold * most);
      qr.factorize(g);
      return qr.rank();
    };
    if (rank_at(adds_enough) < std::min(g.rows(), g.cols())) {
      Index const all = rank_at(repeats);
      for (T threshold = adds_enough; rank_at(std::max(threshold, repeats)) < all;) threshold *= 0.1;
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
  /// G_d, and where its columns stand.
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

  /// Columns change places until no entry of R exceeds the limit. Whether one did.
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
      if (!(most > limit)) break;  // also where it is no number, which the factors will tell
      pivot(row, col);
      place_[std::size_t(dependents_[std::size_t(row)])] = -1;
      std::swap(dependents_[std::size_t(row)], free_[std::size_t(col)]);
      place_[std::size_t(dependents_[std::size_t(row)])] = row;
      changed = true;
      analysed_ = false;
    }
    return changed;
  }
  /// R after the dependent of a row and the independent of a column have changed places.
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
  std::unique_ptr<Lu> lu_ = std::make_unique<Lu>();                    // does not move
  Sequence<Index> dependents_, free_, kept_rows_, place_, row_place_;  ///< places: among dependents, among kept rows
  T largest_entry_ = 0.0;
  MatXOf<T> r_;
  VecXOf<T> right_, solution_;
  bool chosen_ = false, analysed_ = false, factored_ = false;
};

}  // namespace polybody
