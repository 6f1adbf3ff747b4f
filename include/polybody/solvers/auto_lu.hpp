#pragma once
/// \file
/// Linear solver of statics, `AutoLu`: dense up to 64 unknowns, sparse above.
/// Theory: Eq. 7.8.

#include <span>

#include <polybody/math/sequence.hpp>
#include <polybody/solvers/dense_lu.hpp>
#include <polybody/solvers/eigen_sparse_lu.hpp>

namespace polybody {

/// Linear solver that uses `Small` up to `limit` unknowns, and `Large` for larger systems.
template <class Small, class Large>
class SolverBySize {
 public:
  static constexpr Index limit = 64;  ///< largest number of unknowns for `Small`

  void analyse(Index size, std::span<Block const> blocks) {
    small_ = size <= limit;
    if (small_)
      few_.analyse(size, blocks);
    else
      many_.analyse(size, blocks);
  }
  void begin() { small_ ? few_.begin() : many_.begin(); }
  void add(Index row, Index col, BlockView const& b) { small_ ? few_.add(row, col, b) : many_.add(row, col, b); }
  Index factor() { return small_ ? few_.factor() : many_.factor(); }
  /// Sign of the determinant of the last factorisation: −1, 0 or 1.
  double sign_of_determinant() const { return small_ ? few_.sign_of_determinant() : many_.sign_of_determinant(); }
  double least_pivot() const { return small_ ? few_.least_pivot() : many_.least_pivot(); }
  void solve(VecX const& b, VecX& x) const { small_ ? few_.solve(b, x) : many_.solve(b, x); }

 private:
  bool small_ = true;
  Small few_;
  Large many_;
};

/// LU factorisation with pivoting over the whole matrix. Statics needs it because single diagonal blocks may be
/// singular.
using AutoLu = SolverBySize<DenseLu, EigenSparseLu>;

}  // namespace polybody
