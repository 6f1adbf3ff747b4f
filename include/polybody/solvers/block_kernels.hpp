#pragma once
/// \file
/// Products of small blocks that stand by rows, padded to multiples of four doubles.

#include <Eigen/Core>
#include <cstring>
#include <vector>

namespace polybody::detail {


/// As many doubles as the machine for which we compile takes at once, two or four (a wider vector than its own would be
/// taken apart entry by entry). All rows of a block are padded with zeros to a multiple of four.
constexpr int lane_size = Eigen::internal::packet_traits<double>::size >= 4 ? 4 : 2;
using Lane [[gnu::vector_size(8 * lane_size), gnu::may_alias]] = double;
static_assert(sizeof(Lane) == 8 * lane_size, "The block solvers need the vector extensions of g++ or clang++.");
constexpr int padded(int n) { return (n + 3) & ~3; }
inline Lane* lanes(double* x) { return reinterpret_cast<Lane*>(x); }
inline Lane const* lanes(double const* x) { return reinterpret_cast<Lane const*>(x); }

/// Doubles on a boundary of 32 bytes.
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
  std::vector<Four> quads_;
};

/// C (m × width) −= Aᵀ B; A (n × m) and B (n × width) by rows.
template <int width>
void subtract_product(double* __restrict c, Eigen::Index c_stride, double const* a, Eigen::Index a_stride, double const* b,
                      Eigen::Index b_stride, int n, int m) {
  constexpr int count = width / lane_size;
  int i = 0;
  for (; i + 2 <= m; i += 2) {
    Lane s0[count], s1[count];
#pragma GCC unroll 4
    for (int k = 0; k < count; ++k) {
      s0[k] = lanes(c + i * c_stride)[k];
      s1[k] = lanes(c + (i + 1) * c_stride)[k];
    }
    for (int p = 0; p < n; ++p) {
      double const f0 = a[p * a_stride + i], f1 = a[p * a_stride + i + 1];
      Lane const* const row = lanes(b + p * b_stride);
#pragma GCC unroll 4
      for (int k = 0; k < count; ++k) {
        s0[k] -= f0 * row[k];
        s1[k] -= f1 * row[k];
      }
    }
#pragma GCC unroll 4
    for (int k = 0; k < count; ++k) {
      lanes(c + i * c_stride)[k] = s0[k];
      lanes(c + (i + 1) * c_stride)[k] = s1[k];
    }
  }
  for (; i < m; ++i) {
    Lane s[count];
#pragma GCC unroll 4
    for (int k = 0; k < count; ++k) s[k] = lanes(c + i * c_stride)[k];
    for (int p = 0; p < n; ++p) {
      double const f = a[p * a_stride + i];
      Lane const* const row = lanes(b + p * b_stride);
#pragma GCC unroll 4
      for (int k = 0; k < count; ++k) s[k] -= f * row[k];
    }
#pragma GCC unroll 4
    for (int k = 0; k < count; ++k) lanes(c + i * c_stride)[k] = s[k];
  }
}

/// The same for any padded width.
inline void subtract_product(double* c, Eigen::Index c_stride, double const* a, Eigen::Index a_stride, double const* b,
                             Eigen::Index b_stride, int n, int m, int width) {
  for (; width > 8; width -= 8, c += 8, b += 8) subtract_product<8>(c, c_stride, a, a_stride, b, b_stride, n, m);
  if (width > 4)
    subtract_product<8>(c, c_stride, a, a_stride, b, b_stride, n, m);
  else
    subtract_product<4>(c, c_stride, a, a_stride, b, b_stride, n, m);
}

/// y −= f x, `width` a multiple of four.
inline void subtract_row(double* __restrict y, double f, double const* __restrict x, int width) {
  for (int k = 0; k < width / lane_size; ++k) lanes(y)[k] -= f * lanes(x)[k];
}

/// y = f x.
inline void scale_row(double* y, double f, double const* x, int width) {
  for (int k = 0; k < width / lane_size; ++k) lanes(y)[k] = f * lanes(x)[k];
}

/// x·y, `width` a multiple of four.
inline double dot_rows(double const* x, double const* y, int width) {
  Lane sum = lanes(x)[0] * lanes(y)[0];
  for (int k = 1; k < width / lane_size; ++k) sum += lanes(x)[k] * lanes(y)[k];
  double total = 0.0;
  for (int k = 0; k < lane_size; ++k) total += sum[k];
  return total;
}

}  // namespace polybody::detail
