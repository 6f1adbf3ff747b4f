#pragma once
/// \file
/// Operations of a block factorisation at one node. The number N of unknowns is a constant for nodes of at most six
/// unknowns; N = 0 if the number is known only at run time. The rows of the node are U = [D | W], its columns Lt; see
/// `BlockFactor`.

#include <algorithm>

#include <polybody/solvers/block_kernels.hpp>

namespace polybody::detail {

/// Sizes and addresses of the arrays of a node.
struct NodeStorage {
  int size, pad, width;  ///< unknowns, unknowns with padding, columns of W
  double *u, *l;         ///< rows [D | W] (size × stride); Lt (size × width), or memory for Δ⁻¹ W
  double* f;             ///< factors of L, by rows (size × size)
  double* inverse;       ///< inverses of the pivots (size)
  char* direct;          ///< size; 0 without multipliers: more than six unknowns, pivoted or nearly singular
  int stride() const { return pad + width; }
};

/// Ratio of a pivot to the sum of the magnitudes of its terms, up to which a node is nearly singular. D⁻¹ is then large
/// compared with the solutions.
inline constexpr double weak_threshold = 1e-5;

/// Factorises D = L Δ R in registers and returns −1 on success. Calls `reject(r, pivot)` for a pivot of at most
/// threshold · (scale[r] + |D_rr|). If `reject` returns true, `factor_block` returns r; otherwise it drops row r.
template <int N, class Reject>
int factor_block(NodeStorage const& n, double threshold, double const* scale, Reject&& reject) {
  constexpr int count = padded(N) / lane_size;
  int const stride = n.stride();
  Lane d[N][count];
  double of[N];
  bool weak = false;
#pragma GCC unroll 8
  for (int r = 0; r < N; ++r) {
    of[r] = scale[r] + std::abs(n.u[r * stride + r]);
#pragma GCC unroll 8
    for (int k = 0; k < count; ++k) d[r][k] = lanes(n.u + r * stride)[k];
  }
#pragma GCC unroll 8
  for (int r = 0; r < N; ++r) {
    double const pivot = d[r][r / lane_size][r % lane_size];
    double inverse = 1.0 / pivot;
    if (!(std::abs(pivot) > weak_threshold * of[r])) [[unlikely]] {
      weak = true;
      if (!(std::abs(pivot) > threshold * of[r])) {
        if (reject(r, pivot)) {
          n.u[r * stride + r] = pivot;
          return r;
        }
        inverse = 0.0;
      }
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
  *n.direct = weak ? 0 : N;
  return -1;
}

/// For `count` SIMD vectors of columns: W ← L⁻¹ W, and Lt ← Δ⁻¹ W or, without symmetry, Lt ← Δ⁻¹ R⁻ᵀ Lt.
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

/// Eliminates a node without pivoting; see `factor_block`.
template <int N, class Reject>
int eliminate_node(NodeStorage const& n, bool symmetric, double threshold, double* scale, Reject&& reject) {
  if constexpr (N > 0) {
    if (int const bad = factor_block<N>(n, threshold, scale, reject); bad >= 0) return bad;
    symmetric ? finish_panels<N, true>(n) : finish_panels<N, false>(n);
  } else {
    *n.direct = 0;
    int const stride = n.stride();
    for (int r = 0; r < n.size; ++r) scale[r] += std::abs(n.u[r * stride + r]);
    for (int r = 0; r < n.size; ++r) {
      double const pivot = n.u[r * stride + r];
      n.inverse[r] = 1.0 / pivot;
      if (!(std::abs(pivot) > threshold * scale[r])) {
        if (reject(r, pivot)) return r;
        n.inverse[r] = 0.0;
        for (int s = r + 1; s < n.size; ++s) n.f[s * n.size + r] = 0.0;
        continue;
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

/// Eliminates a node with partial pivoting among its rows. A pivot must be above `threshold` · max(c, 1e-3 `threshold`
/// m), with the largest entry c of its column and the largest entry m of the node.
inline int eliminate_pivoted(NodeStorage const& n, bool symmetric, double threshold, double const* scale, int* swaps) {
  *n.direct = 0;
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

/// Upper triangular matrix with the entries t_rp = t[r · row + p · column].
struct Triangle {
  double const* t;
  int row, column;
  double operator()(int r, int p) const { return t[r * row + p * column]; }
};

/// For `count` SIMD vectors of columns: x_r ← x_r − Σ t_rp x_p over p > r, from the last row up. If `inverse` is not
/// null, each x_r is multiplied by the inverse of its pivot before the rows above use it.
template <int N, int count>
inline void substitute_back(double* x, int stride, Triangle t, double const* inverse) {
  Lane y[N][count];
#pragma GCC unroll 8
  for (int r = N - 1; r >= 0; --r) {
#pragma GCC unroll 8
    for (int k = 0; k < count; ++k) y[r][k] = lanes(x + r * stride)[k];
#pragma GCC unroll 8
    for (int p = N - 1; p > r; --p)
#pragma GCC unroll 8
      for (int k = 0; k < count; ++k) y[r][k] -= t(r, p) * y[p][k];
#pragma GCC unroll 8
    for (int k = 0; k < count; ++k) {
      if (inverse) y[r][k] *= inverse[r];
      lanes(x + r * stride)[k] = y[r][k];
    }
  }
}
template <int N>
void substitute_back(double* x, int width, int stride, Triangle t, double const* inverse) {
  constexpr int wide = 2 * lane_size;
  int column = 0;
  for (; column + wide <= width; column += wide) substitute_back<N, 2>(x + column, stride, t, inverse);
  if (column < width) substitute_back<N, 1>(x + column, stride, t, inverse);
}

/// Elimination multipliers of a node, after the update of the later blocks: W ← R⁻¹ Δ⁻¹ W and, if `columns`,
/// Lt ← L⁻ᵀ Lt. The results are D⁻¹ and D⁻ᵀ times the W and Lt before the elimination of the node.
template <int N>
void finish_node(NodeStorage const& n, bool columns) {
  substitute_back<N>(n.u + n.pad, n.width, n.stride(), {n.u, n.stride(), 1}, n.inverse);
  if (columns) substitute_back<N>(n.l, n.width, n.width, {n.f, 1, n.size}, nullptr);
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

/// z = R⁻¹ Δ⁻¹ y, where Δ R is the upper half of D; y and z may be the same.
template <int N>
inline void solve_upper(NodeStorage const& n, double const* y, double* z) {
#pragma GCC unroll 8
  for (int r = (N > 0 ? N : n.size) - 1; r >= 0; --r) {
    double sum = y[r] * n.inverse[r];
#pragma GCC unroll 8
    for (int p = (N > 0 ? N : n.size) - 1; p > r; --p) sum -= n.inverse[r] * n.u[r * n.stride() + p] * z[p];
    z[r] = sum;
  }
}

/// Later nodes that share blocks with a node. `w` stores the vector entries of all nodes.
template <class Neighbour, class Node>
struct LaterNodes {
  Neighbour const* first;
  int count;
  Node const* nodes;
  double* w;
  Neighbour const* begin() const { return first; }
  Neighbour const* end() const { return first + count; }
  double* of(Neighbour const& k) const { return w + nodes[k.node].x; }
};

/// x −= Cᵀ y for the vectors x of all later nodes. `c` stores the elimination multipliers C, with `size` rows. Two sums
/// per entry shorten the chain of dependent additions.
template <int N, class Later>
inline void pass_down(double const* c, int stride, int size, double const* y, Later later) {
  constexpr int at_once = N > 0 ? N : 4;
  int const all = N > 0 ? N : size;
  for (int first = 0; first < all; first += at_once) {
    int const rows = N > 0 ? N : std::min(at_once, all - first);
    double part[at_once];
#pragma GCC unroll 8
    for (int r = 0; r < rows; ++r) part[r] = y[first + r];
    for (auto const& k : later) {
      double* const x = later.of(k);
      double const* const from = c + first * stride + k.column;
      for (int i = 0; i < padded(k.size) / lane_size; ++i) {
        Lane even = lanes(x)[i], odd = {};
#pragma GCC unroll 8
        for (int r = 0; r < rows; r += 2) {
          even -= part[r] * lanes(from + r * stride)[i];
          if (r + 1 < rows) odd += part[r + 1] * lanes(from + (r + 1) * stride)[i];
        }
        lanes(x)[i] = even - odd;
      }
    }
  }
}

/// Adds the sum of W x over all later nodes to `sums`, for `rows` rows from row `first` on (N rows if N > 0).
template <int N, class Later>
inline void pull_up(NodeStorage const& n, int first, int rows, Later later, Lane* sums) {
  for (auto const& k : later) {
    double const *const x = later.of(k), *const from = n.u + first * n.stride() + n.pad + k.column;
    for (int i = 0; i < padded(k.size) / lane_size; ++i) {
      Lane const f = lanes(x)[i];
#pragma GCC unroll 8
      for (int r = 0; r < (N > 0 ? N : rows); ++r) sums[r] += f * lanes(from + r * n.stride())[i];
    }
  }
}

/// y ← R⁻¹ Δ⁻¹ y − W x, where W are the elimination multipliers. Assembles y in registers, because a SIMD load soon
/// after scalar stores to the same memory would wait for all of these stores.
template <int N, class Later>
inline void pass_up(NodeStorage const& n, Later later, double* y) {
  constexpr int count = padded(N) / lane_size;
  double z[padded(N)] = {};
  solve_upper<N>(n, y, z);
  Lane sums[padded(N)] = {};
  pull_up<N>(n, 0, N, later, sums);
#pragma GCC unroll 8
  for (int k = 0; k < count; ++k) lanes(y)[k] = lane_of<Lane>(z + k * lane_size) - sums_of(sums + k * lane_size);
}

/// y ← R⁻¹ Δ⁻¹ (y − W x) for a node of any size without elimination multipliers.
template <class Later>
void pull_and_solve(NodeStorage const& n, Later later, double* y) {
  for (int first = 0; first < n.size; first += lane_size) {
    Lane sums[lane_size] = {};
    pull_up<0>(n, first, std::min(lane_size, n.size - first), later, sums);
    lanes(y + first)[0] -= sums_of(sums);
  }
  solve_upper<0>(n, y, y);
}

}  // namespace polybody::detail
