#pragma once
/// \file
/// Articulated inertia of a body with its descendants about a reference point, and products of 3-vectors for recursions
/// over a tree. All functions work on plain arrays, with any scalar type of a state.

#include <polybody/math/types.hpp>

namespace polybody {
namespace detail {

/// out += a × b.
template <class A, class B, class T>
void add_cross(A const* a, B const* b, T* out) {
  T const x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
  out[0] += x;
  out[1] += y;
  out[2] += z;
}
template <class A, class T>
T dot(A const* a, T const* b, int n) {
  T sum = a[0] * b[0];
  for (int i = 1; i < n; ++i) sum += a[i] * b[i];
  return sum;
}
/// out = a b for a 3×3 matrix a and a matrix b with `columns` columns; all are stored by columns.
template <class T, class B>
void set_product(T const* a, B const* b, int columns, T* out) {
  for (int j = 0; j < columns; ++j)
    for (int i = 0; i < 3; ++i) out[3 * j + i] = a[i] * b[3 * j] + a[3 + i] * b[3 * j + 1] + a[6 + i] * b[3 * j + 2];
}
/// Index of entry (i, j) of a symmetric 3×3 matrix among its six stored entries.
inline constexpr int symmetric_place[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};

/// Inertia I between acceleration and wrench, [f; m] = I [a; α] = [M a + Hᵀα; H a + Θα]. M and Θ are symmetric.
template <class T>
struct ArticulatedInertia {
  T mass[6], first[9], second[6];  ///< M, H (by columns) and Θ

  /// Sets M and H for a body with mass `m` [kg] and first moment `mc` (3) [kg m]. The caller sets Θ.
  void set(double m, T const* mc) {
    for (int i = 0; i < 6; ++i) mass[i] = T(0.0);
    mass[0] = mass[3] = mass[5] = T(m);
    first[0] = first[4] = first[8] = T(0.0);
    first[5] = mc[0];
    first[7] = -mc[0];
    first[6] = mc[1];
    first[2] = -mc[1];
    first[1] = mc[2];
    first[3] = -mc[2];
  }
  /// out += [M a; H a].
  void add_by_acceleration(T const* a, T* out) const {
    add_symmetric(mass, a, out);
    for (int i = 0; i < 3; ++i) out[3 + i] += first[i] * a[0] + first[3 + i] * a[1] + first[6 + i] * a[2];
  }
  /// out += [Hᵀα; Θα].
  void add_by_angular(T const* alpha, T* out) const {
    for (int i = 0; i < 3; ++i) out[i] += dot(first + 3 * i, alpha, 3);
    add_symmetric(second, alpha, out + 3);
  }
  /// I −= u uᵀ/D; `inverse` is 1/D.
  void remove(T const* u, T const& inverse) {
    for (int i = 0; i < 3; ++i) {
      T const f = u[i] * inverse, m = u[3 + i] * inverse;
      for (int j = i; j < 3; ++j) {
        mass[symmetric_place[i][j]] -= f * u[j];
        second[symmetric_place[i][j]] -= m * u[3 + j];
      }
      for (int j = 0; j < 3; ++j) first[3 * i + j] -= f * u[3 + j];
    }
  }
  /// Adds the inertia I = `from`, whose reference point lies at the vector d from that of this inertia. The product XᵀI
  /// X is added, with X [a; α] = [a + α × d; α]. Its blocks are M, H' = H + d̃ M and Θ − H'd̃ + d̃ Hᵀ.
  void add_carried(ArticulatedInertia const& from, T const* d) {
    T moved[9];
    for (int j = 0; j < 3; ++j) {
      T column[3];
      for (int i = 0; i < 3; ++i) {
        column[i] = from.mass[symmetric_place[i][j]];
        moved[3 * j + i] = from.first[3 * j + i];
      }
      detail::add_cross(d, column, moved + 3 * j);
    }
    for (int i = 0; i < 6; ++i) mass[i] += from.mass[i];
    for (int i = 0; i < 9; ++i) first[i] += moved[i];
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) {
        int const j1 = (j + 1) % 3, j2 = (j + 2) % 3, i1 = (i + 1) % 3, i2 = (i + 2) % 3;
        second[symmetric_place[i][j]] += from.second[symmetric_place[i][j]] - moved[3 * j1 + i] * d[j2] +
                                         moved[3 * j2 + i] * d[j1] + d[i1] * from.first[3 * i2 + j] -
                                         d[i2] * from.first[3 * i1 + j];
      }
  }

 private:
  static void add_symmetric(T const* s, T const* x, T* out) {
    out[0] += s[0] * x[0] + s[1] * x[1] + s[2] * x[2];
    out[1] += s[1] * x[0] + s[3] * x[1] + s[4] * x[2];
    out[2] += s[2] * x[0] + s[4] * x[1] + s[5] * x[2];
  }
};

}  // namespace detail

}  // namespace polybody
