#pragma once
/// \file
/// Algebra of vectors and matrices with three rows. Explicit entries compile faster than expressions of Eigen.
/// Theory: Eq. 1.2.

#include <polybody/math/types.hpp>

namespace polybody {

/// Squared norm |a|².
template <class T>
T squared_norm(Vec<T, 3> const& a) {
  return a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
}
/// Scalar product a·b.
template <class T>
T dot(Vec<T, 3> const& a, Vec<T, 3> const& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
/// Difference a − b.
template <class T>
Vec<T, 3> difference(Vec<T, 3> const& a, Vec<T, 3> const& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
/// Product of the vector `a` and the number `s`.
template <class T>
Vec<T, 3> scaled(Vec<T, 3> const& a, double s) {
  return {a[0] * s, a[1] * s, a[2] * s};
}
/// Vector product a × b.
template <class T>
Vec<T, 3> cross(Vec<T, 3> const& a, Vec<T, 3> const& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Product a b of matrices a (3×3) and b (3×n).
template <class T, int n>
Mat<T, 3, n> product(Mat<T, 3, 3> const& a, Mat<T, 3, n> const& b) {
  Mat<T, 3, n> m;
  for (int j = 0; j < n; ++j) {
    T const x = b(0, j), y = b(1, j), z = b(2, j);
    m(0, j) = a(0, 0) * x + a(0, 1) * y + a(0, 2) * z;
    m(1, j) = a(1, 0) * x + a(1, 1) * y + a(1, 2) * z;
    m(2, j) = a(2, 0) * x + a(2, 1) * y + a(2, 2) * z;
  }
  return m;
}
/// Product aᵀ b of matrices a (3×k) and b (3×n).
template <class T, int k, int n>
Mat<T, k, n> transposed_product(Mat<T, 3, k> const& a, Mat<T, 3, n> const& b) {
  Mat<T, k, n> m;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < k; ++i) m(i, j) = a(0, i) * b(0, j) + a(1, i) * b(1, j) + a(2, i) * b(2, j);
  return m;
}
/// Transpose aᵀ.
template <class T>
Mat<T, 3, 3> transposed(Mat<T, 3, 3> const& a) {
  Mat<T, 3, 3> m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m(i, j) = a(j, i);
  return m;
}

/// Skew-symmetric matrix ã with ã b = a × b, 3×3.
template <class T>
Mat<T, 3, 3> skew(Vec<T, 3> const& a) {
  Mat<T, 3, 3> s;
  for (int i = 0; i < 3; ++i) {
    int const j = (i + 1) % 3, k = (i + 2) % 3;
    s(i, i) = T(0);
    s(j, i) = a[k];
    s(i, j) = -a[k];
  }
  return s;
}

/// Product ã b (3×n): vector product of `a` with each column of `b`.
template <class T, int n>
Mat<T, 3, n> skew_product(Vec<T, 3> const& a, Mat<T, 3, n> const& b) {
  Mat<T, 3, n> m;
  for (int i = 0; i < 3; ++i) {
    int const j = (i + 1) % 3, k = (i + 2) % 3;
    for (int c = 0; c < n; ++c) m(i, c) = a[j] * b(k, c) - a[k] * b(j, c);
  }
  return m;
}
/// Product ã b̃ = b aᵀ − (a·b) 1 of two skew-symmetric matrices.
template <class T>
Mat<T, 3, 3> skew_of_skew(Vec<T, 3> const& a, Vec<T, 3> const& b) {
  T const along = dot(a, b);
  Mat<T, 3, 3> m;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) m(i, j) = b[i] * a[j];
    m(i, i) -= along;
  }
  return m;
}

}  // namespace polybody
