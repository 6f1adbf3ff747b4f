#pragma once
/// \file
/// Assembly of the tangent as a sparse matrix, stored by columns, for solvers that require a sparse matrix.

#include <Eigen/SparseCore>
#include <cstdint>
#include <span>

#include <polybody/math/sequence.hpp>
#include <polybody/solvers/linear_solver.hpp>

namespace polybody {

/// Sink that adds blocks to a sparse matrix.
template <class T = double>  // a template, to be compiled only if it is used
class SparseSinkOf {
 public:
  using Matrix = Eigen::SparseMatrix<T, Eigen::ColMajor, int>;  ///< sparse matrix, stored by columns

  /// Computes the position of each block entry in the values of a matrix of `size` unknowns, so that `add` needs no
  /// search.
  void analyse(Index size, std::span<Block const> blocks) {
    Sequence<Sequence<int>> columns(static_cast<std::size_t>(size));
    for (Block const& b : blocks)
      for (Index j = 0; j < b.cols; ++j)
        for (Index i = 0; i < b.rows; ++i) columns[std::size_t(b.col + j)].push_back(int(b.row + i));
    Sequence<Eigen::Triplet<T>> entries;
    for (Index j = 0; j < size; ++j) {
      auto& rows = columns[std::size_t(j)];
      sort_once(rows);
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
  }
  void begin() {
    std::fill_n(a_.valuePtr(), a_.nonZeros(), 0.0);
    cursor_ = 0;
  }
  void add(Index, Index, BlockView const& b) {
    T* const values = a_.valuePtr();
    std::int32_t const* slot = slots_.data() + cursor_;
    for (Index j = 0; j < b.cols; ++j)
      for (Index i = 0; i < b.rows; ++i) values[*slot++] += b(i, j);
    cursor_ = std::size_t(slot - slots_.data());
  }
  Matrix const& matrix() const { return a_; }

 private:
  Matrix a_;
  Sequence<std::int32_t> slots_;
  std::size_t cursor_ = 0;
};

using SparseSink = SparseSinkOf<>;  ///< sink of doubles

}  // namespace polybody
