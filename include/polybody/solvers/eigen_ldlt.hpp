#pragma once
/// \file
/// Linear solver with Eigen's sparse LDLᵀ factorisation.
/// Theory: Eq. 7.8.

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>

#include <polybody/math/sequence.hpp>
#include <polybody/solvers/eigen_sparse_lu.hpp>
#include <polybody/solvers/sparse_sink.hpp>

namespace polybody {

/// Eigen's sparse LDLᵀ factorisation (AMD order) for symmetric tangents [A, Gᵀ; G, 0] with A ≻ 0. Rows without a
/// diagonal block get the diagonal entry −ε. The matrix is then quasi-definite and has a factorisation in any order
/// [Vanderbei 1995]. Iterative refinement with the matrix itself removes the error due to ε and to an asymmetry up to
/// `largest_asymmetry` (gyroscopic terms, damping of rotating bodies). If refinement does not contract, BiCGSTAB solves
/// the equations with the factors as preconditioner [van der Vorst 1992].
class EigenLdlt {
 public:
  static constexpr double shift = 1e-9;  ///< ratio of ε to g²/a, where g and a are the largest entries of G and A
  static constexpr double largest_asymmetry = 0.1;  ///< largest ratio ‖A − Aᵀ‖/‖A‖; above it `factor` throws
  static constexpr int most_refinements = 20;       ///< largest number of refinement steps of a solution
  static constexpr int most_iterations = 60;        ///< largest number of BiCGSTAB iterations in a refinement step
  /// Solver that algorithms with unsymmetric matrices use instead (`UnsymmetricSolver`).
  using Unsymmetric = EigenSparseLu;

  void analyse(Index size, std::span<Block const> blocks) {
    Sequence<char> has_diagonal(std::size_t(size), 0);
    for (Block const& b : blocks)
      if (b.row == b.col) std::fill_n(has_diagonal.begin() + b.row, std::min(b.rows, b.cols), char(1));
    rows_.clear();
    Sequence<Block> all(blocks.begin(), blocks.end());
    for (Index i = 0; i < size; ++i)
      if (!has_diagonal[std::size_t(i)]) {
        rows_.push_back(i);
        all.push_back({i, i, 1, 1});
      }
    sink_.analyse(size, all);
    r_ = dx_ = VecX::Zero(size);
    ldlt_->analyzePattern(sink_.matrix());
  }
  void begin() { sink_.begin(); }
  void add(Index row, Index col, BlockView const& b) { sink_.add(row, col, b); }

  /// Returns −1 on success, otherwise the index of an unknown without a usable pivot. \throws InvalidInput if the
  /// asymmetry is above `largest_asymmetry`.
  Index factor() {
    Matrix const& a = sink_.matrix();
    if (a.cols() == 0) return -1;
    require_symmetric(a);
    double body = 0.0, joint = 0.0;
    std::size_t k = 0;
    for (Index j = 0; j < a.cols(); ++j) {
      bool const is_row = k < rows_.size() && rows_[k] == j;
      if (is_row) ++k;
      for (Matrix::InnerIterator e(a, j); e; ++e) {
        double& largest = is_row ? joint : body;
        largest = std::max(largest, std::abs(e.value()));
      }
    }
    epsilon_ = shift * (body > 0.0 ? joint * joint / body : 1.0);
    Mat<double, 1, 1> const block(-epsilon_);
    for (Index const i : rows_) sink_.add(i, i, block);
    ldlt_->factorize(a);
    if (ldlt_->info() != Eigen::Success) return first_bad(0.0);
    return first_bad(1e-14);
  }

  /// Least ratio of the pivot of a row without a diagonal block to g²/a, where g and a are the largest entries of G and
  /// A. The pivot of a redundant row has the least possible ratio, `shift`.
  double least_pivot() const {
    VecX const& d = ldlt_->pivots();
    double least = epsilon_ / shift;
    for (Index const i : rows_) least = std::min(least, std::abs(d[ldlt_->permutationP().indices()[i]]));
    return rows_.empty() ? 1.0 : least * shift / epsilon_;
  }

  /// x = A⁻¹ b; b and x may be the same vector.
  void solve(VecX const& b, VecX& x) const {
    if (b.size() == 0) return;
    VecX const rhs = b;
    x = ldlt_->solve(rhs);
    if (refine(rhs, x, [&] { dx_ = ldlt_->solve(r_); }) <= 1e-12 * rhs.norm()) return;
    Eigen::BiCGSTAB<Matrix, Factors> method;
    method.preconditioner().ldlt = ldlt_.get();
    method.setTolerance(1e-8);
    method.setMaxIterations(most_iterations);
    method.compute(sink_.matrix());
    refine(rhs, x, [&] { dx_ = method.solve(r_); });
  }
  SparseSink::Matrix const& matrix() const { return sink_.matrix(); }

 private:
  using Matrix = SparseSink::Matrix;

  /// Adds corrections dx_ for the residual r_ of x, as long as each correction halves ‖r_‖. Returns ‖r_‖.
  template <class Correct>
  double refine(VecX const& rhs, VecX& x, Correct&& correct) const {
    double left = leave(rhs, x);
    for (int k = 0; k < most_refinements && left > 1e-15 * rhs.norm(); ++k) {
      double const before = left;
      correct();
      x += dx_;
      left = leave(rhs, x);
      if (left < 0.5 * before) continue;
      if (left < before) return left;
      x -= dx_;
      return leave(rhs, x);
    }
    return left;
  }
  /// Computes r_ = rhs − A x, where A does not contain ε. Returns ‖r_‖.
  double leave(VecX const& rhs, VecX const& x) const {
    r_ = rhs - sink_.matrix() * x;
    for (Index const i : rows_) r_[i] -= epsilon_ * x[i];
    return r_.norm();
  }

  static void require_symmetric(Matrix const& a) {
    Matrix const t = a.transpose();
    double const off = (a - t).norm(), size = a.norm();
    if (off > largest_asymmetry * size)
      throw InvalidInput("solver.not_symmetric",
                         {ErrorObject{"EigenLdlt"}, ": the tangent is not symmetric: the relative asymmetry is ",
                          ErrorValue{off / size}, ", but the limit is ", largest_asymmetry,
                          ". Use EigenSparseLu or the default BlockSolver."});
  }
  /// First unknown with a pivot not above `threshold` times the largest entry of its column; −1 if there is none.
  Index first_bad(double threshold) const {
    VecX const& d = ldlt_->pivots();
    for (Index i = 0; i < d.size(); ++i) {
      double largest = 0.0;
      for (Matrix::InnerIterator e(sink_.matrix(), i); e; ++e) largest = std::max(largest, std::abs(e.value()));
      if (!(std::abs(d[ldlt_->permutationP().indices()[i]]) > threshold * largest)) return i;
    }
    return -1;
  }

  SparseSink sink_;
  Sequence<Index> rows_;
  double epsilon_ = 0.0;
  mutable VecX r_, dx_;
  struct Ldlt : Eigen::SimplicialLDLT<Matrix, Eigen::Lower> {
    VecX const& pivots() const { return this->m_diag; }  // valid after a failed factorisation
  };
  /// Adapter that makes the factors a preconditioner of Eigen's iterative solvers.
  struct Factors {
    Ldlt const* ldlt = nullptr;

    Factors& compute(Matrix const&) { return *this; }
    VecX solve(VecX const& b) const { return ldlt->solve(b); }
    Eigen::ComputationInfo info() const { return Eigen::Success; }
  };
  std::unique_ptr<Ldlt> ldlt_ = std::make_unique<Ldlt>();  // Eigen's class is not movable
};

}  // namespace polybody
