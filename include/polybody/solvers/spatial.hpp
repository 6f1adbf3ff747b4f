#pragma once
/// \file
/// Spatial algebra [Featherstone 2008, §2] of motions [v; ω] and forces [f; m] about one point, in world axes, on plain
/// arrays of six numbers. Operations on pairs [A B] of matrices that map motions to forces, stored 6×12 by rows.

#include <polybody/solvers/articulated_inertia.hpp>

namespace polybody::detail {

/// out += m ×ₘ s, the rate of a motion s that is constant in a frame with the motion m.
template <class T>
void add_motion_cross(T const* m, T const* s, T* out) {
  add_cross(m + 3, s, out);
  add_cross(m, s + 3, out);
  add_cross(m + 3, s + 3, out + 3);
}
/// out += m ×* f, the rate of a force f that is constant in a frame with the motion m.
template <class T>
void add_force_cross(T const* m, T const* f, T* out) {
  add_cross(m + 3, f, out);
  add_cross(m + 3, f + 3, out + 3);
  add_cross(m, f, out + 3);
}
/// out = X x: the motion x about a point displaced by d.
template <class T>
void carry_motion(T const* x, T const* d, T* out) {
  for (int i = 0; i < 6; ++i) out[i] = x[i];
  add_cross(x + 3, d, out);
}
/// out += Xᵀ f: a force f about a point displaced by d.
template <class T>
void add_carried_force(T const* f, T const* d, T* out) {
  for (int i = 0; i < 6; ++i) out[i] += f[i];
  add_cross(d, f, out + 3);
}

/// Pair [A B] of matrices; row i begins at m[12 i].
template <class T>
struct MatrixPair {
  T m[72];

  T* row(int i) { return m + 12 * i; }
  /// A = I, B = (·) ×* I v + v ×* I for a rigid body with the motion v and the `momentum` I v.
  void set_rigid(ArticulatedInertia<T> const& inertia, T const* v, T const* momentum);
  /// B −= A (w ×ₘ).
  void turn_back(T const* w) {
    for (int i = 0; i < 6; ++i) {
      T* const a = row(i);
      add_cross(w + 3, a, a + 6);
      add_cross(w, a, a + 9);
      add_cross(w + 3, a + 3, a + 9);
    }
  }
  /// out = A a + B v.
  void multiply(T const* a, T const* v, T* out) const {
    for (int i = 0; i < 6; ++i) out[i] = dot(m + 12 * i, a, 6) + dot(m + 12 * i + 6, v, 6);
  }
  /// out (12) = sᵀ [A B].
  void multiply_left(T const* s, T* out) const {
    for (int j = 0; j < 12; ++j) out[j] = s[0] * m[j];
    for (int i = 1; i < 6; ++i)
      for (int j = 0; j < 12; ++j) out[j] += s[i] * m[12 * i + j];
  }
  /// [A B] −= r lᵀ.
  void subtract_product(T const* r, T const* l) {
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 12; ++j) m[12 * i + j] -= r[i] * l[j];
  }
  /// to += Xᵀ [A B] X. Overwrites this pair.
  void add_carried(T const* d, MatrixPair& to) {
    for (int i = 0; i < 6; ++i) {
      T* const a = row(i);
      add_cross(d, a, a + 3);
      add_cross(d, a + 6, a + 9);
    }
    for (int i = 0; i < 3; ++i) {
      T const d1 = d[(i + 1) % 3], d2 = d[(i + 2) % 3];
      T const *const next = m + 12 * ((i + 1) % 3), *const last = m + 12 * ((i + 2) % 3);
      for (int j = 0; j < 12; ++j) {
        to.m[12 * i + j] += m[12 * i + j];
        to.m[36 + 12 * i + j] += m[36 + 12 * i + j] + d1 * last[j] - d2 * next[j];
      }
    }
  }
};

/// With the mass m, its first moment h, its second moment Θ and the momentum [f; g], the columns of B for a change of v
/// and of ω are  [m ω̃; h̃ ω̃]  and  [−f̃ − ω̃ h̃; −g̃ + ω̃ Θ − ṽ h̃],  with ã b̃ = b aᵀ − (a·b) 1.
template <class T>
void MatrixPair<T>::set_rigid(ArticulatedInertia<T> const& inertia, T const* v, T const* momentum) {
  T const *const w = v + 3, *const first = inertia.first, mass = inertia.mass[0];
  T const h[3] = {first[5], first[6], first[1]}, wh = dot(w, h, 3), vh = dot(v, h, 3);
  for (int i = 0; i < 3; ++i) {
    T* const force = row(i);
    T* const moment = row(3 + i);
    for (int j = 0; j < 3; ++j) {
      force[j] = inertia.mass[symmetric_place[i][j]];
      force[3 + j] = first[3 * i + j];
      moment[j] = first[3 * j + i];
      moment[3 + j] = inertia.second[symmetric_place[i][j]];
      force[6 + j] = T(0.0);
      moment[6 + j] = w[i] * h[j];
      force[9 + j] = -h[i] * w[j];
      moment[9 + j] = -h[i] * v[j];
    }
    force[9 + i] += wh;
    moment[6 + i] -= wh;
    moment[9 + i] += vh;
  }
  for (int i = 0; i < 3; ++i) {  // cross products: ã has −a_k at (i, j) and a_j at (i, k)
    int const j = (i + 1) % 3, k = (i + 2) % 3;
    row(i)[6 + j] -= mass * w[k];
    row(i)[6 + k] += mass * w[j];
    row(i)[9 + j] += momentum[k];
    row(i)[9 + k] -= momentum[j];
    row(3 + i)[9 + j] += momentum[3 + k];
    row(3 + i)[9 + k] -= momentum[3 + j];
    for (int c = 0; c < 3; ++c)
      row(3 + i)[9 + c] += w[j] * inertia.second[symmetric_place[k][c]] - w[k] * inertia.second[symmetric_place[j][c]];
  }
}

}  // namespace polybody::detail
