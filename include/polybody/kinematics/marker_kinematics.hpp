#pragma once
/// \file
/// Kinematics of a marker as arrays, independent of the body's type, for joints, forces and solvers.
/// Theory: Eqs. 1.25, 1.26, 1.28, 1.29.

#include <algorithm>
#include <cassert>

#include <polybody/kinematics/frame.hpp>

namespace polybody {

/// Storage format of a marker's Jacobian.
enum class JacobianShape : unsigned char {
  ground,  ///< no columns
  /// [1, −A ũ; 0, A] for [ṙ; ω_body], with the position u of the marker in body axes. Only A and the moment arm ρ = A u
  /// are stored.
  rigid,
  dense  ///< 6×n matrix
};

/// Marker kinematics: frame, Jacobian J and bias acceleration of a marker. The twist is V = [ṙ; ω] = J v, and its
/// rate is V̇ = J v̇ + bias.
template <StateScalar T = double>
struct MarkerKinematics {
  Frame<T> frame;                          ///< position, axes and velocities
  Vec<T, 6> bias = Vec<T, 6>::Zero();      ///< V̇ for v̇ = 0, world axes [m/s²], [rad/s²]
  Mat<T, 3, 3> body_axes = identity<T>();  ///< rigid format only: rotation matrix A of the body
  Vec<T, 3> arm = Vec<T, 3>::Zero();       ///< rigid format only: moment arm ρ = A u, world axes [m]
  T* jacobian = nullptr;                   ///< dense format only: J, 6×columns, column-major; in the memory of `Data`
  Index first = 0;                         ///< index in the model of the generalised velocity of column 0
  Index columns = 0;                       ///< number of columns of J
  JacobianShape shape = JacobianShape::ground;  ///< storage format of J

  using DenseMap = Eigen::Map<Mat<T, 6, Eigen::Dynamic> const>;      ///< 6×columns
  DenseMap dense() const { return DenseMap(jacobian, 6, columns); }  ///< J of the dense format

  /// Computes the generalised forces of k wrenches, out (columns×k) = Jᵀ `wrenches`. Each column of `wrenches` (6×k) is
  /// [force; moment].
  template <class In, class Out>
  void pull(In const& wrenches, Out&& out) const {
    switch (shape) {
      case JacobianShape::ground:
        return;
      case JacobianShape::rigid:
        multiply_transposed_rigid(wrenches, out);
        return;
      case JacobianShape::dense:  // plain loops: a matrix product of Eigen compiles and runs more slowly
        for (Index k = 0; k < wrenches.cols(); ++k)
          for (Index c = 0; c < columns; ++c) {
            T const* const j = jacobian + 6 * c;
            T sum = j[0] * wrenches(0, k);
            for (int i = 1; i < 6; ++i) sum += j[i] * wrenches(i, k);
            out(c, k) = sum;
          }
    }
  }

  /// `pull` for the rigid format: columns [f; m] of w (6×k) yield columns [f; Aᵀ(m + ρ × f)] of out (6×k). The loops
  /// over the wrenches are innermost, so that they vectorise.
  template <class In, class Out>
  void multiply_transposed_rigid(In const& w, Out& out) const {
    constexpr int fixed = In::ColsAtCompileTime;
    constexpr int room = fixed > 0 ? fixed : 6;
    for (Index begin = 0; begin < w.cols(); begin += room) {
      int const count = fixed > 0 ? fixed : int(std::min<Index>(room, w.cols() - begin));
      T f[3][room], m[3][room];
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < count; ++k) {
          out(i, begin + k) = f[i][k] = w(i, begin + k);
          m[i][k] = w(3 + i, begin + k);
        }
      for (int i = 0; i < 3; ++i) {
        int const j = (i + 1) % 3, l = (i + 2) % 3;
        for (int k = 0; k < count; ++k) m[i][k] += arm[j] * f[l][k] - arm[l] * f[j][k];
      }
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < count; ++k)
          out(3 + i, begin + k) = body_axes(0, i) * m[0][k] + body_axes(1, i) * m[1][k] + body_axes(2, i) * m[2][k];
    }
  }

  /// Twist J b (6) for the generalised velocities b, one for each column of J.
  Vec<T, 6> push(T const* b) const {
    Vec<T, 6> t;
    for (int i = 0; i < 6; ++i) t[i] = T(0.0);
    if (shape == JacobianShape::rigid) {
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) t[3 + i] += body_axes(i, j) * b[3 + j];
      for (int i = 0; i < 3; ++i)
        t[i] = b[i] + t[3 + (i + 1) % 3] * arm[(i + 2) % 3] - t[3 + (i + 2) % 3] * arm[(i + 1) % 3];
    } else {
      for (Index c = 0; c < columns; ++c)
        for (int i = 0; i < 6; ++i) t[i] += jacobian[6 * c + i] * b[c];
    }
    return t;
  }

  /// J as a full 6×columns matrix, for tests and analyses.
  Mat<T, 6, Eigen::Dynamic> full() const {
    Mat<T, 6, Eigen::Dynamic> j = Mat<T, 6, Eigen::Dynamic>::Zero(6, columns);
    if (shape == JacobianShape::rigid) {
      j.template leftCols<3>().template topRows<3>().setIdentity();
      j.template rightCols<3>().template topRows<3>() = -skew<T>(arm) * body_axes;
      j.template rightCols<3>().template bottomRows<3>() = body_axes;
    } else if (shape == JacobianShape::dense) {
      j = dense();
    }
    return j;
  }
};

}  // namespace polybody
