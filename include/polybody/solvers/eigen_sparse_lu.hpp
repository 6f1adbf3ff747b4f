#pragma once
#include <Eigen/SparseLU>
#include <algorithm>
#include <cstdint>
#include <memory>

#include <polybody/solvers/linear_solver.hpp>

namespace polybody {

/// Eigen's sparse LU; the pattern is analysed once and blocks are scattered through a table, without searching. Eigen
/// itself allocates inside `factor`. \tparam Ordering one of Eigen's.
template <class Ordering>
class EigenSparseLuBy {
 public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

  void analyse(Index size, std::vector<Block> const& blocks) {
    // Compressed columns: gather the rows of each column, sort, remove twins.
    std::vector<std::vector<int>> columns(static_cast<std::size_t>(size));
    for (Block const& b : blocks)
      for (Index j = 0; j < b.cols; ++j)
        for (Index i = 0; i < b.rows; ++i)
          columns[std::size_t(b.col + j)].push_back(int(b.row + i));
    std::vector<Eigen::Triplet<double>> entries;
    for (Index j = 0; j < size; ++j) {
      auto& rows = columns[std::size_t(j)];
      std::sort(rows.begin(), rows.end());
      rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
      for (int i : rows) entries.emplace_back(i, int(j), 1.0);
    }
    a_.resize(size, size);
    a_.setFromTriplets(entries.begin(), entries.end());
    slots_.clear();
    for (Block const& b : blocks)
      for (Index j = 0; j < b.cols; ++j) {
        int const* const begin = a_.innerIndexPtr() + a_.outerIndexPtr()[b.col + j];
        int const* const end = a_.innerIndexPtr() + a_.outerIndexPtr()[b.col + j + 1];
        for (Index i = 0; i < b.rows; ++i)
          slots_.push_back(std::int32_t(std::lower_bound(begin, end, int(b.row + i)) - a_.innerIndexPtr()));
      }
    lu_->analyzePattern(a_);
  }
  void begin() {
    std::fill_n(a_.valuePtr(), a_.nonZeros(), 0.0);
    cursor_ = 0;
  }
  void add(Index, Index, BlockView const& b) {
    double* const values = a_.valuePtr();
    std::int32_t const* slot = slots_.data() + cursor_;
    for (Index j = 0; j < b.cols; ++j)
      for (Index i = 0; i < b.rows; ++i) values[*slot++] += b(i, j);
    cursor_ = std::size_t(slot - slots_.data());
  }
  /// −1, or a column whose pivot is below 1e-14 of the column's largest entry.
  Index factor() {
    if (a_.cols() == 0) return -1;
    lu_->factorize(a_);
    auto const& place = lu_->colsPermutation().indices();  // of a column in the order of elimination
    if (lu_->info() != Eigen::Success) {
      // Eigen tells a pivot that is exactly zero by its place, counted from one, at the end of a message.
      std::string const message = lu_->lastErrorMessage();
      std::size_t const first = message.find_last_not_of("0123456789") + 1;
      if (first == message.size()) return 0;
      for (Index i = 0; i < place.size(); ++i)
        if (place[i] + 1 == std::stol(message.substr(first))) return i;
      return 0;
    }
    auto const upper = lu_->matrixU();  // its diagonal stands in the supernodes of L
    for (Index i = 0; i < a_.cols(); ++i) {
      double largest = 0.0, pivot = 0.0;
      for (typename Matrix::InnerIterator entry(a_, i); entry; ++entry) largest = std::max(largest, std::abs(entry.value()));
      for (typename Lu::SCMatrix::InnerIterator entry(upper.m_mapL, place[i]); entry; ++entry)
        if (entry.index() == place[i]) {
          pivot = entry.value();
          break;
        }
      if (!(std::abs(pivot) > 1e-14 * largest)) return i;
    }
    return -1;
  }
  void solve(VecX const& b, VecX& x) const {
    if (b.size() > 0) x = lu_->solve(b);
  }
  Matrix const& matrix() const { return a_; }

 private:
  Matrix a_;
  std::vector<std::int32_t> slots_;
  std::size_t cursor_ = 0;
  using Lu = Eigen::SparseLU<Matrix, Ordering>;
  std::unique_ptr<Lu> lu_ = std::make_unique<Lu>();  // Eigen's does not move
};

/// … in the order of COLAMD.
using EigenSparseLu = EigenSparseLuBy<Eigen::COLAMDOrdering<int>>;

}  // namespace polybody
