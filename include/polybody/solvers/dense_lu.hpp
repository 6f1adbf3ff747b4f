#pragma once
#include <Eigen/LU>

#include <polybody/solvers/linear_solver.hpp>

namespace polybody {

/// Dense LU with partial pivoting: for small systems and for checking the others.
class DenseLu {
 public:
  void analyse(Index size, std::vector<Block> const&) {
    a_.setZero(size, size);
    scale_.setZero(size);
    lu_ = Eigen::PartialPivLU<MatX>(size);
  }
  void begin() { a_.setZero(); }
  void add(Index row, Index col, BlockView const& b) {
    for (Index j = 0; j < b.cols; ++j)
      for (Index i = 0; i < b.rows; ++i) a_(row + i, col + j) += b(i, j);
  }
  /// −1, or the first column whose pivot is below 1e-14 of the column's largest entry.
  Index factor() {
    if (a_.size() == 0) return -1;
    scale_ = a_.cwiseAbs().colwise().maxCoeff().transpose();
    lu_.compute(a_);
    for (Index i = 0; i < a_.cols(); ++i)
      if (!(std::abs(lu_.matrixLU()(i, i)) > 1e-14 * scale_[i])) return i;
    return -1;
  }
  void solve(VecX const& b, VecX& x) const {
    if (b.size() > 0) x = lu_.solve(b);
  }
  MatX const& matrix() const { return a_; }

 private:
  MatX a_;
  VecX scale_;
  Eigen::PartialPivLU<MatX> lu_;
};

static_assert(LinearSolver<DenseLu>);

}  // namespace polybody
