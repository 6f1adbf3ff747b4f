#pragma once
/// \file
/// Null space of the matrix of the equations of statics, by inverse iteration.

#include <polybody/math/sequence.hpp>
#include <polybody/statics/null_vector.hpp>

namespace polybody::detail {

/// Receiver of matrix blocks that computes the largest absolute entry of each row.
struct RowSizeSink {
  VecX& largest;

  void add(Index row, Index, BlockView const& b) {
    for (Index j = 0; j < b.cols; ++j)
      for (Index i = 0; i < b.rows; ++i) largest[row + i] = std::max(largest[row + i], std::abs(b(i, j)));
  }
};

/// Null space of the matrix A of the equations of statics (StaticTangent), by inverse iteration with a small shift:
///   y ← (A + σ D)⁻¹ D y,  σ = 1e-12,  D = diag(largest entry of the row; negative for constraint equations).
/// Each pass multiplies a vector of the null space by 1/σ, and an eigenvector with the eigenvalue μ relative to D by
/// 1/(σ + μ) [Golub & Van Loan 2013, §8.2]. If K is positive semidefinite, the shifted matrix is quasi-definite, and
/// its pivots are far above round-off. A vector is accepted if A z is round-off compared with |A| |z|.
template <LinearSolver Solver>
class NullSpace {
 public:
  static constexpr double shift = 1e-12;
  static constexpr int passes = 8;

  NullSpace(System& system, StaticTangent<Solver>& tangent)
      : tangent_(tangent), nv_(system.velocities()), scale_(VecX::Zero(system.size())), y_(scale_), one_(1) {}

  /// Computes `pins`, the unknowns that need a spring to remove the null space. Returns −1, or the unknown without a
  /// pivot if the factorisation fails.
  Index find(VecX const& lambda, Sequence<Index>& pins) {
    RowSizeSink sizes{scale_};
    tangent_.write_scaled(lambda, sizes);
    for (Index i = 0; i < scale_.size(); ++i) scale_[i] = (scale_[i] > 0.0 ? scale_[i] : 1.0) * (i < nv_ ? 1.0 : -1.0);
    for (Index i = 0; i < scale_.size(); ++i) y_[i] = shift * scale_[i];
    tangent_.set_springs(y_, lambda);
    if (Index const bad = tangent_.factor(lambda); bad >= 0) return bad;
    vectors_.clear();
    while (Index(vectors_.size()) < scale_.size() && finds_one(lambda)) {
    }
    choose(pins);
    return -1;
  }

 private:
  /// Adds a further vector of the null space to `vectors_`. Returns false if there is none.
  bool finds_one(VecX const& lambda) {
    Index const n = scale_.size();
    vectors_.emplace_back(n);
    tangent_.fill_without_order(vectors_.size(), vectors_.back());
    for (int pass = 0; pass < passes; ++pass) {
      for (Index i = 0; i < n; ++i) y_[i] = scale_[i] * vectors_.back()[i];
      tangent_.solve_scaled(y_, vectors_.back());
      make_orthonormal(vectors_, n);
    }
    one_[0].z = vectors_.back();
    multiply(tangent_, lambda, one_);
    if (one_[0].is_null()) return true;
    vectors_.pop_back();
    return false;
  }

  /// Selects one unknown for each vector by elimination with complete pivoting. Of equal entries the last one is
  /// selected, so that the joint connected last is redundant.
  void choose(Sequence<Index>& pins) {
    pins.clear();
    for (std::size_t k = 0; k < vectors_.size(); ++k) {
      std::size_t best = k;
      Index at = 0;
      double most = 0.0;
      for (std::size_t j = k; j < vectors_.size(); ++j)
        for (Index i = 0; i < scale_.size(); ++i)
          if (std::abs(vectors_[j][i]) >= (1.0 - 1e-6) * most) {
            most = std::max(most, std::abs(vectors_[j][i]));
            best = j;
            at = i;
          }
      std::swap(vectors_[k], vectors_[best]);
      for (std::size_t j = k + 1; j < vectors_.size(); ++j)
        add_scaled(-vectors_[j][at] / vectors_[k][at], vectors_[k], vectors_[j]);
      pins.push_back(at);
    }
    std::sort(pins.begin(), pins.end());
  }

  StaticTangent<Solver>& tangent_;
  Index nv_;
  VecX scale_, y_;
  Sequence<VecX> vectors_;
  Sequence<NullColumn> one_;
};

}  // namespace polybody::detail
