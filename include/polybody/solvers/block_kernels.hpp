#pragma once
/// \file
/// Products of small blocks that are stored by rows. The rows are padded to whole SIMD vectors.

#include <Eigen/Core>
#include <cstring>

#include <polybody/math/sequence.hpp>
#include <polybody/math/simd_vector.hpp>
#include <polybody/math/with_constant.hpp>

namespace polybody::detail {

using Index = Eigen::Index;

/// SIMD vector length [doubles]. All rows of a block are padded with zeros to a multiple of it.
constexpr int lane_size = simd_size;
using Lane [[gnu::vector_size(8 * lane_size), gnu::may_alias]] = double;
static_assert(sizeof(Lane) == 8 * lane_size, "The block solvers need the vector extensions of g++ or clang++.");
constexpr int padded(int n) { return (n + lane_size - 1) & ~(lane_size - 1); }
inline Lane* lanes(double* x) { return reinterpret_cast<Lane*>(x); }
inline Lane const* lanes(double const* x) { return reinterpret_cast<Lane const*>(x); }

/// Array of doubles, aligned to 32 bytes.
class AlignedDoubles {
 public:
  AlignedDoubles() = default;
  explicit AlignedDoubles(std::size_t n) : quads_((n + 3) / 4) {}
  double* data() { return reinterpret_cast<double*>(quads_.data()); }
  double const* data() const { return reinterpret_cast<double const*>(quads_.data()); }
  void zero() {
    if (!quads_.empty()) std::memset(static_cast<void*>(quads_.data()), 0, quads_.size() * sizeof(Four));
  }

 private:
  struct alignas(32) Four {
    double x[4];
  };
  Sequence<Four> quads_;
};

/// Rows of a block: address of the first row, and distance between rows [doubles].
template <class T>
struct RowsOf {
  T* first;
  Index stride;
  T* operator[](Index i) const { return first + i * stride; }
  /// Rows without their first k columns.
  RowsOf operator+(Index k) const { return {first + k, stride}; }
};
using BlockRows = RowsOf<double>;
using ConstBlockRows = RowsOf<double const>;

/// Computes `strip` rows of C −= Aᵀ B in registers.
template <int strip, int count, int inner>
inline void subtract_strip(double* __restrict c, Index stride, ConstBlockRows a, ConstBlockRows b, int n) {
  Lane s[strip][count];
#pragma GCC unroll 4
  for (int i = 0; i < strip; ++i)
#pragma GCC unroll 4
    for (int k = 0; k < count; ++k) s[i][k] = lanes(c + i * stride)[k];
#pragma GCC unroll 8
  for (int p = 0; p < (inner > 0 ? inner : n); ++p)
#pragma GCC unroll 4
    for (int i = 0; i < strip; ++i) {
      double const f = a[p][i];
#pragma GCC unroll 4
      for (int k = 0; k < count; ++k) s[i][k] -= f * lanes(b[p])[k];
    }
#pragma GCC unroll 4
  for (int i = 0; i < strip; ++i)
#pragma GCC unroll 4
    for (int k = 0; k < count; ++k) lanes(c + i * stride)[k] = s[i][k];
}

/// C −= Aᵀ B with A (n × m), B (n × `count` SIMD vectors) and C (m × `count` SIMD vectors), all stored by rows. `inner`
/// is n, or 0 if n is known only at run time.
template <int count, int inner>
void subtract_product(BlockRows c, ConstBlockRows a, ConstBlockRows b, int n, int m) {
  int i = 0;
  for (; i + 3 <= m; i += 3) subtract_strip<3, count, inner>(c[i], c.stride, a + i, b, n);
  for (; i < m; ++i) subtract_strip<1, count, inner>(c[i], c.stride, a + i, b, n);
}

/// C −= Aᵀ B for any padded `width` of B and C.
template <int inner>
void subtract_product(BlockRows c, ConstBlockRows a, ConstBlockRows b, int n, int m, int width) {
  constexpr int most = lane_size == 2 ? 3 : 2, step = most * lane_size;
  for (; width >= step; width -= step, c = c + step, b = b + step) subtract_product<most, inner>(c, a, b, n, m);
  if (lane_size == 2 && width == 2 * lane_size)
    subtract_product<2, inner>(c, a, b, n, m);
  else if (width > 0)
    subtract_product<1, inner>(c, a, b, n, m);
}

/// y −= f x for a padded `width`.
inline void subtract_row(double* __restrict y, double f, double const* __restrict x, int width) {
  for (int k = 0; k < width / lane_size; ++k) lanes(y)[k] -= f * lanes(x)[k];
}

/// y = f x.
inline void scale_row(double* y, double f, double const* x, int width) {
  for (int k = 0; k < width / lane_size; ++k) lanes(y)[k] = f * lanes(x)[k];
}

/// y += Σ |a_r b_r| over n rows, entry by entry; `inner` is n, or 0 if n is known only at run time.
template <int inner>
void add_sizes(double* y, ConstBlockRows a, ConstBlockRows b, int n, int width) {
  using Bits [[gnu::vector_size(8 * lane_size)]] = long long;
  for (int k = 0; k < width / lane_size; ++k) {
    Lane sum = lanes(y)[k];
#pragma GCC unroll 8
    for (int r = 0; r < (inner > 0 ? inner : n); ++r) {
      Bits const product = Bits(Lane(lanes(a[r])[k] * lanes(b[r])[k]));
      sum += Lane(product & 0x7fffffffffffffffLL);  // clears the sign
    }
    lanes(y)[k] = sum;
  }
}

inline double sum_of(Lane const& x) {
  double total = x[0];
  for (int k = 1; k < lane_size; ++k) total += x[k];
  return total;
}

/// Assembles consecutive numbers into a SIMD vector in registers, without a store to memory.
template <class L>
L lane_of(double const* x) {
  if constexpr (sizeof(L) == 16)
    return L{x[0], x[1]};
  else
    return L{x[0], x[1], x[2], x[3]};
}

/// Sums of the entries of x[0], x[1], … in one SIMD vector; x has as many elements as a vector has entries.
template <class L>
L sums_of(L const* x) {
  if constexpr (sizeof(L) == 16) {
    return __builtin_shufflevector(x[0], x[1], 0, 2) + __builtin_shufflevector(x[0], x[1], 1, 3);
  } else {
    auto const pairs = [](L const& a, L const& b) {
      return __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
    };
    L const ab = pairs(x[0], x[1]), cd = pairs(x[2], x[3]);
    return __builtin_shufflevector(ab, cd, 0, 1, 4, 5) + __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
  }
}

/// Difference between the halves of a matrix in the Frobenius norm.
struct Difference {
  Lane lane_sum = {}, lane_apart = {};
  double sum = 0.0, apart = 0.0;

  void enlarge(double x) { sum += x * x; }
  void compare(double x, double y) {
    sum += x * x;
    apart += (x - y) * (x - y);
  }
  void compare(double const* x, double const* y, int width) {
    for (int k = 0; k < width / lane_size; ++k) {
      Lane const d = lanes(x)[k] - lanes(y)[k];
      lane_sum += lanes(x)[k] * lanes(x)[k];
      lane_apart += d * d;
    }
  }
  bool is_round_off() const { return apart + sum_of(lane_apart) <= 1e-24 * (sum + sum_of(lane_sum)); }
};

}  // namespace polybody::detail
