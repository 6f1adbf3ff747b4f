#pragma once
/// \file
/// What a block factorisation does at one node, with its N unknowns a constant where it can (N = 0: at run time). The
/// node's rows are U = [D | W], its columns Lt; see `BlockFactor`.

#include <algorithm>

#include <polybody/solvers/block_kernels.hpp>

namespace polybody::detail {

/// Where the numbers of a node stand.
struct NodeStorage {
  int size, pad, width;  ///< unknowns, padded, and columns of W
  double *u, *l;         ///< rows [D | W] (size × stride); Lt (size × width), or room for Δ⁻¹ W
  double* f;             ///< factors of L, by rows (size × size)
  double* inverse;       ///< of the pivots
  int stride() const { return pad + width; }
};

/// D = L Δ R in the registers. `reject(r, pivot)` is asked about pivots not above threshold · (scale[r] + |D_rr|): true
/// ends it (r is returned), false drops the row. −1 when all is done.
template <int N, class Reject>
int factor_block(NodeStorage const& n, double threshold, double const* scale, Reject&& reject) {
  constexpr int count = padded(N) / lane_size;
  int const stride = n.stride();
  Lane d[N][count];
  double least[N];
#pragma GCC unroll 8
  for (int r = 0; r < N; ++r) {
    least[r] = threshold * (scale[r] + std::abs(n.u[r * stride + r]));
#pragma GCC unroll 8
    for (int k = 0; k < count; ++k) d[r][k] = lanes(n.u + r * stride)[k];
  }
#pragma GCC unroll 8
  for (int r = 0; r < N; ++r) {
    double const pivot = d[r][r / lane_size][r % lane_size];
    double inverse = 1.0 / pivot;
    if (!(std::abs(pivot) > least[r])) [[unlikely]] {
      if (reject(r, pivot)) {
        n.u[r * stride + r] = pivot;
        return r;
      }
      inverse = 0.0;
    }
    n.inverse[r] = inverse;
#pragma GCC unroll 8
    for (int s = r + 1; s < N; ++s) {
      double const factor = d[s][r / lane_size][r % lane_size] * inverse;
      n.f[s * N + r] = factor;
#pragma GCC unroll 8
      for (int k = (r + 1) / lane_size; k < count; ++k) d[s][k] -= factor * d[r][k];
    }
#pragma GCC unroll 8
    for (int k = 0; k < count; ++k) lanes(n.u + r * stride)[k] = d[r][k];
  }
  return -1;
}

/// `count` lanes of columns: W ← L⁻¹ W, and Lt ← Δ⁻¹ W or, without symmetry, Lt ← Δ⁻¹ R⁻ᵀ Lt.
template <int N, int count, bool symmetric>
inline void finish_panel(NodeStorage const& n, int column) {
  double* const w = n.u + n.pad + column;
  double* const l = n.l + column;
  int const stride = n.stride();
  Lane x[N][count];
#pragma GCC unroll 8
  for (int r = 0; r < N; ++r) {
#pragma GCC unroll 8
    for (int k = 0; k < count; ++k) x[r][k] = lanes(w + r * stride)[k];
#pragma GCC unroll 8
    for (int p = 0; p < r; ++p)
#pragma GCC unroll 8
      for (int k = 0; k < count; ++k) x[r][k] -= n.f[r * N + p] * x[p][k];
#pragma GCC unroll 8
    for (int k = 0; k < count; ++k) {
      lanes(w + r * stride)[k] = x[r][k];
      if (symmetric) lanes(l + r * n.width)[k] = n.inverse[r] * x[r][k];
    }
  }
  if (symmetric) return;
#pragma GCC unroll 8
  for (int r = 0; r < N; ++r) {
#pragma GCC unroll 8
    for (int k = 0; k < count; ++k) x[r][k] = lanes(l + r * n.width)[k];
#pragma GCC unroll 8
    for (int p = 0; p < r; ++p)
#pragma GCC unroll 8
      for (int k = 0; k < count; ++k) x[r][k] -= n.u[p * stride + r] * x[p][k];
#pragma GCC unroll 8
    for (int k = 0; k < count; ++k) {
      x[r][k] *= n.inverse[r];
      lanes(l + r * n.width)[k] = x[r][k];
    }
  }
}

template <int N, bool symmetric>
void finish_panels(NodeStorage const& n) {
  constexpr int wide = 2 * lane_size;
  int column = 0;
  for (; column + wide <= n.width; column += wide) finish_panel<N, 2, symmetric>(n, column);
  if (column < n.width) finish_panel<N, 1, symmetric>(n, column);
}

/// Lt ← Δ⁻¹ R⁻ᵀ Lt for any size.
inline void finish_columns(NodeStorage const& n) {
  for (int r = 0; r < n.size; ++r) {
    double* const row = n.l + r * n.width;
    scale_row(row, n.inverse[r], row, n.width);
    for (int s = r + 1; s < n.size; ++s) subtract_row(n.l + s * n.width, n.u[r * n.stride() + s], row, n.width);
  }
}

/// The node's own elimination, without pivoting; see `factor_block`.
template <int N, class Reject>
int eliminate_node(NodeStorage const& n, bool symmetric, double threshold, double* scale, Reject&& reject) {
  if constexpr (N > 0) {
    if (int const bad = factor_block<N>(n, threshold, scale, reject); bad >= 0) return bad;
    symmetric ? finish_panels<N, true>(n) : finish_panels<N, false>(n);
  } else {
    int const stride = n.stride();
    for (int r = 0; r < n.size; ++r) scale[r] += std::abs(n.u[r * stride + r]);
    for (int r = 0; r < n.size; ++r) {
      double const pivot = n.u[r * stride + r];
      n.inverse[r] = 1.0 / pivot;
      if (!(std::abs(pivot) > threshold * scale[r])) {
        if (reject(r, pivot)) return r;
        n.inverse[r] = 0.0;
      }
      int const begin = (r + 1) & ~(lane_size - 1);
      for (int s = r + 1; s < n.size; ++s) {
        double const factor = n.u[s * stride + r] * n.inverse[r];
        n.f[s * n.size + r] = factor;
        subtract_row(n.u + s * stride + begin, factor, n.u + r * stride + begin, stride - begin);
      }
    }
    if (symmetric)
      for (int r = 0; r < n.size; ++r) scale_row(n.l + r * n.width, n.inverse[r], n.u + r * stride + n.pad, n.width);
    else
      finish_columns(n);
  }
  return -1;
}

/// With partial pivoting among the node's rows; a pivot must be above `threshold` of its column.
inline int eliminate_pivoted(NodeStorage const& n, bool symmetric, double threshold, double const* scale, int* swaps) {
  int const stride = n.stride();
  double largest = 0.0;
  for (int i = 0; i < n.size; ++i) {
    largest = std::max(largest, scale[i]);
    for (int j = 0; j < stride; ++j) largest = std::max(largest, std::abs(n.u[i * stride + j]));
  }
  if (symmetric)
    for (int r = 0; r < n.size; ++r) std::copy_n(n.u + r * stride + n.pad, n.width, n.l + r * n.width);
  for (int r = 0; r < n.size; ++r) {
    int best = r;
    double column = 0.0;
    for (int s = r; s < n.size; ++s)
      if (std::abs(n.u[s * stride + r]) > std::abs(n.u[best * stride + r])) best = s;
    for (int s = 0; s < n.size; ++s) column = std::max(column, std::abs(n.u[s * stride + r]));
    swaps[r] = best;
    if (best != r) {
      std::swap_ranges(n.u + r * stride, n.u + (r + 1) * stride, n.u + best * stride);
      std::swap_ranges(n.f + r * n.size, n.f + r * n.size + r, n.f + best * n.size);
    }
    double const pivot = n.u[r * stride + r];
    if (!(std::abs(pivot) > threshold * std::max(column, 1e-3 * threshold * largest))) return r;
    n.inverse[r] = 1.0 / pivot;
    int const begin = (r + 1) & ~(lane_size - 1);
    for (int s = r + 1; s < n.size; ++s) {
      double const factor = n.u[s * stride + r] * n.inverse[r];
      n.f[s * n.size + r] = factor;
      subtract_row(n.u + s * stride + begin, factor, n.u + r * stride + begin, stride - begin);
    }
  }
  finish_columns(n);
  return -1;
}

/// y ← L⁻¹ y.
template <int N>
inline void solve_lower(NodeStorage const& n, double* y) {
#pragma GCC unroll 8
  for (int r = 1; r < (N > 0 ? N : n.size); ++r) {
    double sum = y[r];
#pragma GCC unroll 8
    for (int p = 0; p < r; ++p) sum -= n.f[r * (N > 0 ? N : n.size) + p] * y[p];
    y[r] = sum;
  }
}

/// y ← R⁻¹ Δ⁻¹ y, with Δ R = D's upper half.
template <int N>
inline void solve_upper(NodeStorage const& n, double* y) {
#pragma GCC unroll 8
  for (int r = (N > 0 ? N : n.size) - 1; r >= 0; --r) {
    double sum = y[r];
#pragma GCC unroll 8
    for (int p = (N > 0 ? N : n.size) - 1; p > r; --p) sum -= n.u[r * n.stride() + p] * y[p];
    y[r] = sum * n.inverse[r];
  }
}

/// x −= Ltᵀ y, x a neighbour's `pad` entries; `lt` points to its columns.
template <int N>
inline void pass_down(double const* lt, int stride, int size, double const* y, int pad, double* x) {
  for (int k = 0; k < pad / lane_size; ++k) {
    Lane sum = lanes(x)[k];
#pragma GCC unroll 8
    for (int r = 0; r < (N > 0 ? N : size); ++r) sum -= y[r] * lanes(lt + r * stride)[k];
    lanes(x)[k] = sum;
  }
}

/// y −= W x over all `count` neighbours; their x stand in w.
template <int N, class Neighbour, class Node>
inline void pass_up(NodeStorage const& n, Neighbour const* neighbours, int count, Node const* nodes, double const* w,
                    double* y) {
  constexpr int at_once = N > 0 ? N : 4;
  int const size = N > 0 ? N : n.size;
  for (int first = 0; first < size; first += at_once) {
    int const rows = N > 0 ? N : std::min(at_once, size - first);
    Lane sums[at_once] = {};
    for (Neighbour const* of = neighbours; of != neighbours + count; ++of) {
      double const* const x = w + nodes[of->node].x;
      double const* const from = n.u + first * n.stride() + n.pad + of->column;
      for (int k = 0; k < padded(of->size) / lane_size; ++k) {
        Lane const f = lanes(x)[k];
#pragma GCC unroll 8
        for (int r = 0; r < rows; ++r) sums[r] += f * lanes(from + r * n.stride())[k];
      }
    }
    for (int r = 0; r < rows; ++r) y[first + r] -= sum_of(sums[r]);
  }
}

}  // namespace polybody::detail
