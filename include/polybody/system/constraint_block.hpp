#pragma once
/// \file
/// Waist 2 as data: the rows of joints and bodies, and who pushes which marker, after geometries and policies have
/// spoken. Their types are gone.

#include <polybody/kinematics/marker_kinematics.hpp>
#include <polybody/math/with_constant.hpp>

namespace polybody {

/// One end of a block of rows: a marker whose twist the rows read, or speeds that they read themselves.
template <StateScalar T = double>
struct ConstraintSide {
  Index marker = -1;       ///< −1: none; the map's columns are speeds
  Index first = 0;         ///< first of these speeds
  Index columns = 0;       ///< of the map: six of a marker; none for an end that is fixed to the ground
  T const* map = nullptr;  ///< (rows × columns) by columns
};

/// Who brings rows.
enum class ConstraintSource : unsigned char {
  body,      ///< rows that a body owns, such as the norm of Euler parameters
  linear,    ///< rows of a joint that are linear in coordinates
  joint,     ///< rows of a joint between frames
  compliant  ///< what a compliant joint measures and answers by a force: no rows of the model
};

/// Up to six rows of one source: ġ = a.map · (twist or speeds of a) + b.map · (…) + rate. A linear joint may have more.
template <StateScalar T = double>
struct ConstraintBlock {
  ConstraintSource source = ConstraintSource::joint;  ///< who brings them
  bool opposite = false;                              ///< both ends are markers, and the map of b is that of a times −1
  Index row = -1;                                     ///< first row of the model; −1 for a compliant joint
  int rows = 0;                                       ///< m
  int positions = 0;                 ///< of a linear joint: its first rows, which are those of the position
  Index owner = 0;                   ///< the body or the joint, by its place in the model's layout
  ConstraintSide<T> a = {}, b = {};  ///< its two ends
  T const* g = nullptr;              ///< (m) violation
  T const* rate = nullptr;           ///< (m) Φ_t; null where rows do not know time
  T const* answer = nullptr;         ///< (m) λ(g, ġ) of a compliant joint

  /// λ (m): the multipliers of the rows, or what the joint's policy answers.
  T const* multiplier(VecXOf<T> const& lambda) const { return row >= 0 ? lambda.data() + row : answer; }
};

/// A wrench on a marker, about its origin, in world axes.
template <StateScalar T = double>
struct AppliedWrench {
  Index source = 0;  ///< the force element, by its place in the model's layout
  Index marker = 0;  ///< published
  T w[6] = {};       ///< [f; m] [N, N m]; loads are not yet scaled
};

namespace detail {

/// r[columns of the marker] += sign · Jᵀ w.
template <StateScalar T>
void add_pulled(MarkerKinematics<T> const& p, T const* w, double sign, T* r) {
  switch (p.shape) {
    case JacobianShape::ground:
      return;
    case JacobianShape::rigid: {
      T const f[3] = {w[0] * sign, w[1] * sign, w[2] * sign};
      T const m[3] = {w[3] * sign + p.arm[1] * f[2] - p.arm[2] * f[1], w[4] * sign + p.arm[2] * f[0] - p.arm[0] * f[2],
                      w[5] * sign + p.arm[0] * f[1] - p.arm[1] * f[0]};
      for (int i = 0; i < 3; ++i) {
        r[p.first + i] += f[i];
        r[p.first + 3 + i] += p.body_axes(0, i) * m[0] + p.body_axes(1, i) * m[1] + p.body_axes(2, i) * m[2];
      }
      return;
    }
    case JacobianShape::dense:
      for (Index c = 0; c < p.columns; ++c) {
        T const* const j = p.jacobian + 6 * c;
        T sum = j[0] * w[0];
        for (int i = 1; i < 6; ++i) sum += j[i] * w[i];
        r[p.first + c] += sum * sign;
      }
  }
}

/// [f; m] = mapᵀ λ of a marker's end.
template <int m, StateScalar T>
void wrench_of(T const* map, T const* lambda, T* w) {
  for (int i = 0; i < 6; ++i) {
    T sum = map[m * i] * lambda[0];
    for (int k = 1; k < m; ++k) sum += map[m * i + k] * lambda[k];
    w[i] = sum;
  }
}

/// [ṙ; ω] of a frame.
template <StateScalar T>
void read_twist(Frame<T> const& f, T* w) {
  for (int i = 0; i < 3; ++i) {
    w[i] = f.v[i];
    w[3 + i] = f.w[i];
  }
}

/// out (m) += map · x; m as a constant, or `rows` where it is zero.
template <int m, StateScalar T>
void add_mapped(T const* map, Index columns, T const* x, int rows, T* out) {
  int const n = m > 0 ? m : rows;
  for (Index c = 0; c < columns; ++c)
    for (int k = 0; k < n; ++k) out[k] += map[n * c + k] * x[c];
}

}  // namespace detail

/// out (6) = mapᵀ λ: the wrench that λ puts on an end of a block, where it is a marker; else zero.
template <StateScalar T>
void wrench_at(ConstraintBlock<T> const& block, ConstraintSide<T> const& end, T const* lambda, T* out) {
  for (int i = 0; i < 6; ++i) out[i] = T(0.0);
  if (end.marker < 0) return;
  with_constant(block.rows, [&](auto m) {
    if constexpr (m > 0) detail::wrench_of<m>(end.map, lambda, out);
  });
}

}  // namespace polybody
