#pragma once
/// \file
/// Projection of marker wrenches and marker stiffness onto generalised coordinates, Jᵀ w and Jᵀ S J, as blocks of the
/// tangent. At these sizes, plain loops compile and run faster than Eigen's matrix products.

#include <array>
#include <utility>

#include <polybody/math/block_sink.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/system/data.hpp>

namespace polybody::detail {

/// out = Jᵀ w for n wrenches and the Jacobian J of a rigid marker. Entry i of wrench k is w[down i + right k]. out
/// (6×n) is stored by rows.
template <int n>
void multiply_transposed_rigid(MarkerKinematics<double> const& p, double const* w, Index down, Index right,
                               double* out) {
  double f[3][n], m[3][n];
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < n; ++k) {
      out[n * i + k] = f[i][k] = w[down * i + right * k];
      m[i][k] = w[down * (3 + i) + right * k];
    }
  for (int i = 0; i < 3; ++i) {
    int const j = (i + 1) % 3, l = (i + 2) % 3;
    for (int k = 0; k < n; ++k) m[i][k] += p.arm[j] * f[l][k] - p.arm[l] * f[j][k];
  }
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < n; ++k)
      out[n * (3 + i) + k] = p.body_axes(0, i) * m[0][k] + p.body_axes(1, i) * m[1][k] + p.body_axes(2, i) * m[2][k];
}
/// out = Jᵀ w for n wrenches and a stored Jacobian. Entry i of wrench k is w[down i + right k]. out (columns×n) is
/// stored by columns.
template <class = void>
void pull_dense(MarkerKinematics<double> const& p, double const* w, Index down, Index right, int n, double* out) {
  for (int k = 0; k < n; ++k)
    for (Index c = 0; c < p.columns; ++c) {
      double const* const j = p.jacobian + 6 * c;
      double sum = j[0] * w[right * k];
      for (int i = 1; i < 6; ++i) sum += j[i] * w[down * i + right * k];
      out[p.columns * k + c] = sum;
    }
}

/// Jᵀ w (columns×m) for m wrenches, stored in `scratch`. Entry i of wrench k is w[down i + right k].
template <int m>
BlockView pulled(MarkerKinematics<double> const& p, double const* w, Index down, Index right,
                 Sequence<double>& scratch) {
  if (p.shape == JacobianShape::rigid) {  // by rows, like the storage of the block solvers
    multiply_transposed_rigid<m>(p, w, down, right, scratch.data());
    return {scratch.data(), 6, m, m, 1};
  }
  pull_dense(p, w, down, right, m, scratch.data());
  return {scratch.data(), p.columns, m, 1, p.columns};
}

/// Adds (map J)ᵀ and its transpose to the sink for the m constraint equations from `row` on, at one marker.
template <int m>
void add_pulled_rows(MarkerKinematics<double> const& p, double const* map, Index row, Sequence<double>& scratch,
                     BlockSink& sink) {
  if (p.columns == 0) return;
  BlockView const columns = pulled<m>(p, map, m, 1, scratch);
  sink.add(p.first, row, columns);
  sink.add(row, p.first, columns.transposed());
}

/// sink += JaᵀS Jb. Entry (i, j) of S is s[i + stride j].
template <class = void>
void add_pulled_pair(MarkerKinematics<double> const& a, MarkerKinematics<double> const& b, double const* s,
                     Index stride, Sequence<double>& scratch, BlockSink& sink) {
  if (a.columns == 0 || b.columns == 0) return;
  if (a.shape == JacobianShape::rigid && b.shape == JacobianShape::rigid) {
    double half[36], out[36];
    multiply_transposed_rigid<6>(a, s, 1, stride, half);  // JaᵀS by rows
    multiply_transposed_rigid<6>(b, half, 1, 6, out);     // (JaᵀS Jb)ᵀ by rows
    sink.add(a.first, b.first, BlockView(out, 6, 6, 1, 6));
    return;
  }
  double* const half = scratch.data();  // JaᵀS, a.columns×6
  Index down = 1, right = a.columns;
  if (a.shape == JacobianShape::rigid) {
    multiply_transposed_rigid<6>(a, s, 1, stride, half);
    down = 6, right = 1;
  } else {
    pull_dense(a, s, 1, stride, 6, half);
  }
  double* const out = half + 6 * a.columns;  // (JaᵀS Jb)ᵀ, b.columns×a.columns
  for (Index r = 0; r < a.columns; ++r) {
    double const* const row = half + down * r;
    double* const to = out + b.columns * r;
    if (b.shape == JacobianShape::rigid)
      multiply_transposed_rigid<1>(b, row, right, 0, to);
    else
      pull_dense(b, row, right, 0, 1, to);
  }
  sink.add(a.first, b.first, BlockView(out, a.columns, b.columns, b.columns, 1));
}

/// sink += Jiᵀ S_ij Jj for all pairs of n markers, or only for i = j if `couples` is false. S is 6n×6n by columns.
template <int n>
void add_pulled_pairs(std::array<MarkerKinematics<double> const*, std::size_t(n)> const& markers, double const* s,
                      bool couples, Sequence<double>& scratch, BlockSink& sink) {
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      if (couples || i == j)
        add_pulled_pair(*markers[std::size_t(i)], *markers[std::size_t(j)], s + 6 * i + 36 * n * j, 6 * n, scratch,
                        sink);
}

/// Skips the blocks of all pairs of n markers in a sink, in the order of `add_pulled_pairs`. Used if no force acts
/// between the markers.
template <int n>
void skip_pulled_pairs(std::array<MarkerKinematics<double> const*, std::size_t(n)> const& markers, BlockSink& sink) {
  for (MarkerKinematics<double> const* a : markers)
    for (MarkerKinematics<double> const* b : markers)
      if (a->columns > 0 && b->columns > 0) sink.skip(a->first, b->first, a->columns, b->columns);
}

/// Adds the effect of a marker's pose on its twist, at constant velocities of its body, to `of_pose`. On a rigid body,
/// v = ṙ₀ + ω × ρ, with the arm ρ from the body's origin to the marker. A small rotation e changes ω by e × ω, and v by
///   (e × ω) × ρ + ω × (e × ρ) = e × (ω × ρ)   (Jacobi's identity).
/// The effect is omitted unless p.shape is `JacobianShape::rigid`. \param of_twist, of_pose derivatives with respect to
/// twist and pose (rows × 6), by columns
template <int rows>
void add_rates_of_pose(MarkerKinematics<double> const& p, double const* of_twist, double* of_pose) {
  if (p.shape != JacobianShape::rigid) return;
  Vec3 const &w = p.frame.w, &arm = p.arm;
  double const u[3] = {w[1] * arm[2] - w[2] * arm[1], w[2] * arm[0] - w[0] * arm[2], w[0] * arm[1] - w[1] * arm[0]};
  for (int k = 0; k < 3; ++k) {
    int const j = (k + 1) % 3, l = (k + 2) % 3;
    double const *const by_v = of_twist, *const by_w = of_twist + 3 * rows;
    double* const to = of_pose + rows * (3 + k);
    for (int i = 0; i < rows; ++i)
      to[i] +=
          u[j] * by_v[i + rows * l] - u[l] * by_v[i + rows * j] + w[j] * by_w[i + rows * l] - w[l] * by_w[i + rows * j];
  }
}

/// out (rows×cols) = a (rows×m) bᵀ with b (cols×m), all stored by columns.
template <int m>
void times_transposed(double const* a, double const* b, Index rows, Index cols, double* out) {
  for (Index j = 0; j < cols; ++j)
    for (Index i = 0; i < rows; ++i) {
      double sum = a[i] * b[j];
      for (int k = 1; k < m; ++k) sum += a[i + rows * k] * b[j + cols * k];
      out[i + rows * j] = sum;
    }
}

/// Writes (map J)ᵀ (columns×m), by columns, for m constraint equations at one marker.
template <int m>
void pull_rows(MarkerKinematics<double> const& p, double const* map, double* out) {
  if (p.shape != JacobianShape::rigid) return pull_dense(p, map, m, 1, m, out);
  double by_rows[6 * m];
  multiply_transposed_rigid<m>(p, map, m, 1, by_rows);
  for (int k = 0; k < m; ++k)
    for (int i = 0; i < 6; ++i) out[6 * k + i] = by_rows[m * i + k];
}

/// sink += (Gi Ji)ᵀ k (Gj Jj) for a compliant joint with m constraint functions between two markers. The tangent k of
/// the joint is stored as an m×m matrix by columns, or only as the diagonal of this matrix. The rows Gi are projected
/// before the multiplication by k. Thus m wrenches per marker are projected, instead of six per pair.
template <int m, bool diagonal>
void add_pulled_slope(std::array<MarkerKinematics<double> const*, 2> const& markers, double const* const (&maps)[2],
                      double const* slope, Sequence<double>& scratch, BlockSink& sink) {
  double* place = scratch.data();
  auto const take = [&](Index size) { return std::exchange(place, place + size); };
  double* const rows[2] = {take(m * markers[0]->columns), take(m * markers[1]->columns)};  // (Gi Ji)ᵀ, columns×m
  double* const bent = take(m * std::max(markers[0]->columns, markers[1]->columns));       // (Gj Jj)ᵀ kᵀ
  for (std::size_t i = 0; i < 2; ++i)
    if (markers[i]->columns > 0) pull_rows<m>(*markers[i], maps[i], rows[i]);
  for (std::size_t j = 0; j < 2; ++j) {
    Index const nj = markers[j]->columns;
    if (nj == 0) continue;
    for (int k = 0; k < m; ++k)
      for (Index c = 0; c < nj; ++c) {
        double sum = 0.0;
        if constexpr (diagonal)
          sum = slope[k] * rows[j][c + nj * k];
        else
          for (int l = 0; l < m; ++l) sum += slope[k + m * l] * rows[j][c + nj * l];
        bent[c + nj * k] = sum;
      }
    for (std::size_t i = 0; i < 2; ++i) {
      Index const ni = markers[i]->columns;
      if (ni == 0) continue;
      if (ni == 6 && nj == 6)
        times_transposed<m>(rows[i], bent, 6, 6, place);
      else
        times_transposed<m>(rows[i], bent, ni, nj, place);
      sink.add(markers[i]->first, markers[j]->first, BlockView(place, ni, nj, 1, ni));
    }
  }
}

}  // namespace polybody::detail
