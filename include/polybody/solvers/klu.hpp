#pragma once
/// \file
/// Linear solver with KLU of SuiteSparse. Requires klu.h and -lklu (Debian: libsuitesparse-dev).
/// Theory: Eq. 7.8.

#if __has_include(<klu.h>)
#include <klu.h>
#else
#include <suitesparse/klu.h>
#endif

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include <polybody/math/sequence.hpp>
#include <polybody/solvers/sparse_sink.hpp>

namespace polybody {

/// Sparse LU factorisation by KLU [Davis & Palamadai Natarajan 2010]. The first factorisation chooses the pivots. Later
/// factorisations reuse pivots and memory until the pivot growth or the condition number requires new pivots. `solve`
/// does not allocate memory.
class Klu {
 public:
  /// Least ratio of KLU's reciprocal pivot growth to the value at the choice of the pivots. Below it, new pivots are
  /// chosen, because reused pivots would lose two digits more.
  static constexpr double least_growth = 1e-2;
  /// Pivots are rejected if KLU's estimate of the reciprocal condition number is at most this value.
  static constexpr double least_condition = 1e-16;

  Klu() = default;
  /// Uses the elimination order `order` (each unknown once) instead of the order of KLU (block triangular form, AMD).
  explicit Klu(std::span<int const> order) : order_(order.begin(), order.end()) {}

  /// \throws InvalidInput if the elimination order of the constructor does not contain each of the `size` unknowns
  /// once.
  void analyse(Index size, std::span<Block const> blocks) {
    sink_.analyse(size, blocks);
    klu_ = std::make_unique<Handle>();
    if (size == 0) return;
    if (!order_.empty()) require_order(size);
    auto [n, columns, rows, values] = arrays();
    klu_->symbolic = order_.empty() ? klu_analyze(n, columns, rows, &klu_->common)
                                    : klu_analyze_given(n, columns, rows, order_.data(), order_.data(), &klu_->common);
  }
  void begin() { sink_.begin(); }
  void add(Index row, Index col, BlockView const& b) { sink_.add(row, col, b); }

  /// Returns −1 on success, otherwise the index of a column without a usable pivot.
  Index factor() {
    if (sink_.matrix().cols() == 0) return -1;
    if (klu_->symbolic == nullptr) return empty_column();
    auto [n, columns, rows, values] = arrays();
    Handle& k = *klu_;
    if (k.numeric != nullptr && klu_refactor(columns, rows, values, k.symbolic, k.numeric, &k.common) != 0 &&
        sound(least_growth * k.growth))
      return -1;
    k.drop_numeric();
    k.numeric = klu_factor(columns, rows, values, k.symbolic, &k.common);
    if (k.numeric != nullptr && sound(0.0)) {
      (void)klu_rgrowth(columns, rows, values, k.symbolic, k.numeric, &k.common);
      k.growth = k.common.rgrowth;
      return -1;
    }
    Index const bad = k.common.singular_col >= 0 && k.common.singular_col < n ? k.common.singular_col : empty_column();
    k.drop_numeric();
    return bad;
  }

  /// Ratio of the least to the largest pivot of the last factorisation, for the matrix with scaled rows.
  double least_pivot() const { return klu_->numeric == nullptr ? 1.0 : klu_->common.rcond; }

  /// x = A⁻¹ b; b and x may be the same vector.
  void solve(VecX const& b, VecX& x) const {
    if (b.size() == 0) return;
    x = b;
    klu_solve(klu_->symbolic, klu_->numeric, int(x.size()), 1, x.data(), &klu_->common);
  }
  SparseSink::Matrix const& matrix() const { return sink_.matrix(); }

 private:
  struct Handle {
    klu_common common;
    klu_symbolic* symbolic = nullptr;
    klu_numeric* numeric = nullptr;
    double growth = 0.0;  ///< reciprocal pivot growth when the pivots were chosen [1]

    Handle() { klu_defaults(&common); }
    Handle(Handle const&) = delete;
    Handle& operator=(Handle const&) = delete;
    ~Handle() {
      drop_numeric();
      klu_free_symbolic(&symbolic, &common);
    }
    void drop_numeric() { klu_free_numeric(&numeric, &common); }
  };
  struct Arrays {
    int n;
    int *columns, *rows;
    double* values;
  };
  void require_order(Index size) const {
    Sequence<int> sorted = order_;
    std::sort(sorted.begin(), sorted.end());
    bool right = Index(sorted.size()) == size;
    for (std::size_t i = 0; right && i < sorted.size(); ++i) right = sorted[i] == int(i);
    if (!right)
      throw InvalidInput("solver.order", {ErrorObject{"Klu"}, ": the elimination order must contain each of the ", size,
                                          " unknowns once."});
  }
  /// Arrays for KLU. Its interface requires non-const pointers, but it does not change the arrays.
  Arrays arrays() const {
    auto const& a = sink_.matrix();
    return {int(a.cols()), const_cast<int*>(a.outerIndexPtr()), const_cast<int*>(a.innerIndexPtr()),
            const_cast<double*>(a.valuePtr())};
  }
  bool sound(double growth) const {
    auto [n, columns, rows, values] = arrays();
    Handle& k = *klu_;
    if (klu_rcond(k.symbolic, k.numeric, &k.common) == 0 || !(k.common.rcond > least_condition)) return false;
    if (growth == 0.0) return true;
    return klu_rgrowth(columns, rows, values, k.symbolic, k.numeric, &k.common) != 0 && k.common.rgrowth > growth;
  }
  /// First column of zeros, or 0 if there is none.
  Index empty_column() const {
    auto const& a = sink_.matrix();
    for (Index j = 0; j < a.cols(); ++j) {
      bool empty = true;
      for (SparseSink::Matrix::InnerIterator entry(a, j); entry; ++entry) empty = empty && entry.value() == 0.0;
      if (empty) return j;
    }
    return 0;
  }

  SparseSink sink_;
  Sequence<int> order_;
  std::unique_ptr<Handle> klu_;
};

static_assert(LinearSolver<Klu>);

}  // namespace polybody
