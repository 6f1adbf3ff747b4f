#pragma once
/// \file
/// Test for null vectors of the matrix of the equations of statics, and orthogonalisation of vectors.

#include <polybody/math/sequence.hpp>
#include <polybody/statics/static_tangent.hpp>

namespace polybody::detail {

/// Candidate z for a null vector of A, with A z (`product`) and |A| |z| (`size`).
struct NullColumn {
  VecX z, product, size;

  /// Returns true if A z is round-off, at most 1e-13 max |A| |z| + 1e-15 max |z|. The entries of the scaled A are not
  /// much greater than one.
  bool is_null() const { return largest_size(product) <= 1e-13 * largest_size(size) + 1e-15 * largest_size(z); }
};

/// Receiver of matrix blocks that computes A z and |A| |z| of all columns.
struct NullColumnSink {
  Sequence<NullColumn>& columns;

  void add(Index row, Index col, BlockView const& b) {
    for (NullColumn& c : columns)
      for (Index j = 0; j < b.cols; ++j) {
        double const z = c.z[col + j];
        if (z == 0.0) continue;
        for (Index i = 0; i < b.rows; ++i) {
          c.product[row + i] += b(i, j) * z;
          c.size[row + i] += std::abs(b(i, j) * z);
        }
      }
  }
};

template <LinearSolver Solver>
void multiply(StaticTangent<Solver>& tangent, VecX const& lambda, Sequence<NullColumn>& columns) {
  if (columns.empty()) return;
  for (NullColumn& c : columns) c.product = c.size = VecX::Zero(c.z.size());
  NullColumnSink sink{columns};
  tangent.write_scaled(lambda, sink);
}

/// Scalar product Σ aᵢ bᵢ over the first n entries.
inline double dot_of_first(Index n, VecX const& a, VecX const& b) {
  double sum = 0.0;
  for (Index i = 0; i < n; ++i) sum += a[i] * b[i];
  return sum;
}
inline void add_scaled(double factor, VecX const& z, VecX& to) {
  for (Index i = 0; i < z.size(); ++i) to[i] += factor * z[i];
}
/// Orthogonalises and normalises the last vector with respect to the previous ones, by their first n entries
/// (Gram–Schmidt, twice).
template <class = void>
void make_orthonormal(Sequence<VecX>& vectors, Index n) {
  VecX& last = vectors.back();
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t k = 0; k + 1 < vectors.size(); ++k)
      add_scaled(-dot_of_first(n, vectors[k], last), vectors[k], last);
    double const length = std::sqrt(dot_of_first(n, last, last));
    for (Index i = 0; i < last.size(); ++i) last[i] /= length;
  }
}

}  // namespace polybody::detail
