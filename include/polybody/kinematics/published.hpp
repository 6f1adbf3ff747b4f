#pragma once
/// \file
/// Waist 1 as data: a marker after its body has published it. The body's type is gone.

#include <cassert>

#include <polybody/kinematics/frame.hpp>

namespace polybody {

/// Shape of a marker's Jacobian.
enum class JacobianShape : unsigned char {
  ground,  ///< no columns
  rigid,   ///< twist = [1, −A ũ; 0, A] [ṙ; ω_body]: kept as A and the arm ρ = A u, never multiplied out
  dense    ///< 6×n, stored
};

/// A marker's frame, Jacobian and bias. twist [ṙ; ω] = J v, twist˙ = J v̇ + bias.
template <StateScalar T = double>
struct Published {
  Frame<T> frame;
  Vec<T, 6> bias = Vec<T, 6>::Zero();
  Mat<T, 3, 3> body_axes = Mat<T, 3, 3>::Identity();  ///< rigid only: A of the body
  Vec<T, 3> arm = Vec<T, 3>::Zero();                  ///< rigid only: ρ = A u, world axes [m]
  T* jacobian = nullptr;  ///< dense only: 6×columns, column-major, in the arena of the data
  Index first = 0;        ///< first velocity column it touches
  Index columns = 0;      ///< how many
  JacobianShape shape = JacobianShape::ground;

  using DenseMap = Eigen::Map<Mat<T, 6, Eigen::Dynamic> const>;
  DenseMap dense() const { return DenseMap(jacobian, 6, columns); }

  /// out (columns×k) = (rows · J)ᵀ for `rows` given as 6×k columns [force part; moment part]:
  /// the generalised forces of k wrenches.
  template <class In, class Out>
  void pull(In const& wrenches, Out&& out) const {
    switch (shape) {
      case JacobianShape::ground:
        return;
      case JacobianShape::rigid:
        for (Index k = 0; k < wrenches.cols(); ++k) {
          Vec<T, 3> const f = wrenches.col(k).template head<3>();
          Vec<T, 3> const m = wrenches.col(k).template tail<3>() + arm.cross(f);
          out.col(k).template head<3>() = f;
          out.col(k).template tail<3>() = body_axes.transpose() * m;
        }
        return;
      case JacobianShape::dense:  // in plain loops: a matrix product of Eigen costs more, to compile and to run
        for (Index k = 0; k < wrenches.cols(); ++k)
          for (Index c = 0; c < columns; ++c) {
            T const* const j = jacobian + 6 * c;
            T sum = j[0] * wrenches(0, k);
            for (int i = 1; i < 6; ++i) sum += j[i] * wrenches(i, k);
            out(c, k) = sum;
          }
    }
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
