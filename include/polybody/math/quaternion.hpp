#pragma once
/// \file
/// Unit quaternions (w, x, y, z) as four coordinates of a state. The increments of ⊞ and ⊟ are rotation vectors in body
/// axes.
/// [Solà, Deray & Atchuthan 2018, §4; Shabana 2020, §2.4]
/// Theory: Eqs. 1.15 to 1.17, 1.19.

#include <polybody/math/so3.hpp>

namespace polybody {

/// Quaternion q = (w, x, y, z). Its rotation matrix A(q) transforms components of vectors from body axes to world axes.
template <class T>
using Quaternion = Vec<T, 4>;

/// Quaternion product p q: the rotation q followed by the rotation p.
template <class T>
Quaternion<T> quaternion_product(Quaternion<T> const& p, Quaternion<T> const& q) {
  return {p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3], p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
          p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1], p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]};
}

/// Inverse of a unit quaternion.
template <class T>
Quaternion<T> conjugate(Quaternion<T> const& q) {
  return {q[0], -q[1], -q[2], -q[3]};
}

/// Unit quaternion q/|q|.
template <class T>
Quaternion<T> unit_quaternion(Quaternion<T> const& q) {
  using std::sqrt;
  T const scale = 1.0 / sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  return {q[0] * scale, q[1] * scale, q[2] * scale, q[3] * scale};
}

/// Writes the rotation matrix A(q), 3×3, of a unit quaternion q to `a`.
template <class T>
void set_rotation(Quaternion<T> const& q, Mat<T, 3, 3>& a) {
  T const ww = q[0] * q[0], xx = q[1] * q[1], yy = q[2] * q[2], zz = q[3] * q[3];
  T const xy = q[1] * q[2], xz = q[1] * q[3], yz = q[2] * q[3];
  T const wx = q[0] * q[1], wy = q[0] * q[2], wz = q[0] * q[3];
  a(0, 0) = ww + xx - yy - zz;
  a(1, 0) = 2.0 * (xy + wz);
  a(2, 0) = 2.0 * (xz - wy);
  a(0, 1) = 2.0 * (xy - wz);
  a(1, 1) = ww - xx + yy - zz;
  a(2, 1) = 2.0 * (yz + wx);
  a(0, 2) = 2.0 * (xz + wy);
  a(1, 2) = 2.0 * (yz - wx);
  a(2, 2) = ww - xx - yy + zz;
}

/// Rotation matrix A(q), 3×3, of a unit quaternion q.
template <class T>
Mat<T, 3, 3> rotation_matrix(Quaternion<T> const& q) {
  Mat<T, 3, 3> a;
  set_rotation<T>(q, a);
  return a;
}

/// Exponential map exp(φ): unit quaternion of the rotation vector φ [rad].
template <class T>
Quaternion<T> quaternion_exp(Vec<T, 3> const& phi) {
  using std::sqrt;
  Vec<T, 3> const half(phi[0] * 0.5, phi[1] * 0.5, phi[2] * 0.5);
  T const x = squared_norm(half);
  ExpSeries<T> const s(x);
  return {1.0 - x * s.b, half[0] * s.a, half[1] * s.a, half[2] * s.a};
}

/// Logarithm log(q): rotation vector of a unit quaternion, |φ| ≤ π [rad]. q and −q have the same rotation vector.
template <class T>
Vec<T, 3> quaternion_log(Quaternion<T> const& q) {
  using std::atan2, std::sqrt;
  T const sign = value_of(q[0]) < 0.0 ? T(-1.0) : T(1.0);
  Vec<T, 3> const v(q[1] * sign, q[2] * sign, q[3] * sign);
  T const w = q[0] * sign;
  T const x = squared_norm(v);
  if (value_of(x) < 1e-8) {  // series of atan(n)/n, n² = x/w²; the first neglected term is 2e-17
    T const factor = 2.0 / w * (1.0 - x / (3.0 * w * w));
    return {v[0] * factor, v[1] * factor, v[2] * factor};
  }
  T const n = sqrt(x);
  T const factor = 2.0 * atan2(n, w) / n;
  return {v[0] * factor, v[1] * factor, v[2] * factor};
}

/// Computes `out` (4) = q ⊞ δ = q exp(δ), normalised, from q (4) and `delta` (3), δ in body axes [rad]. Each number is
/// read separately from memory. Loading several numbers at once would wait for the separate stores that wrote them.
template <class T>
void set_quaternion_plus(T const* q, T const* delta, T* out) {
  using std::sqrt;
  Quaternion<T> const r =
      quaternion_product<T>({q[0], q[1], q[2], q[3]}, quaternion_exp<T>({delta[0], delta[1], delta[2]}));
  T const square = r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3], off = square - 1.0;
  bool const near = value_of(off) * value_of(off) < 1e-16;  // the next term of the series, 3/8 off², is below round-off
  T const scale = near ? T(1.0 - 0.5 * off) : T(1.0 / sqrt(square));
  for (int i = 0; i < 4; ++i) out[i] = r[i] * scale;
}
/// Retraction q ⊞ δ with δ in body axes [rad].
template <class T>
Quaternion<T> quaternion_plus(Quaternion<T> const& q, Vec<T, 3> const& delta) {
  Quaternion<T> turned;
  set_quaternion_plus<T>(q.data(), delta.data(), turned.data());
  return turned;
}

/// Difference q ⊟ p = log(p⁻¹ q): the rotation vector δ [rad], body axes, with p ⊞ δ = ±q.
template <class T>
Vec<T, 3> quaternion_minus(Quaternion<T> const& q, Quaternion<T> const& p) {
  return quaternion_log<T>(quaternion_product<T>(conjugate<T>(p), q));
}

/// Unit quaternion (w ≥ 0) of the rotation matrix `a` (3×3).
template <class T>
Quaternion<T> quaternion_from(Mat<T, 3, 3> const& a) {
  using std::sqrt;
  // the largest of 4w², 4x², 4y², 4z² is computed without cancellation [Shepperd 1978]
  T const trace = a(0, 0) + a(1, 1) + a(2, 2);
  int largest = -1;  // axis of the largest diagonal entry; −1 if the trace is larger
  T most = trace;
  for (int i = 0; i < 3; ++i)
    if (a(i, i) > most) {
      most = a(i, i);
      largest = i;
    }
  T q[4];
  if (largest < 0) {
    q[0] = 1.0 + trace;
    for (int i = 0; i < 3; ++i) q[1 + i] = a((i + 2) % 3, (i + 1) % 3) - a((i + 1) % 3, (i + 2) % 3);
  } else {
    int const i = largest, j = (i + 1) % 3, k = (i + 2) % 3;
    q[0] = a(k, j) - a(j, k);
    q[1 + i] = 1.0 + 2.0 * a(i, i) - trace;
    q[1 + j] = a(j, i) + a(i, j);
    q[1 + k] = a(k, i) + a(i, k);
  }
  T inverse = 1.0 / sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (q[0] < 0.0) inverse = -inverse;
  return {q[0] * inverse, q[1] * inverse, q[2] * inverse, q[3] * inverse};
}
/// Unit quaternion of the rotation matrix `a` (3×3) of doubles.
template <class = void>  // compiled where it is used
Quaternion<double> quaternion_of(Mat3 const& a) {
  return quaternion_from<double>(a);
}

/// Rotation vector of the rotation matrix `a`, |φ| ≤ π [rad].
template <class = void>  // compiled where it is used
Vec3 log_so3(Mat3 const& a) {
  return quaternion_log<double>(quaternion_of(a));
}

}  // namespace polybody
