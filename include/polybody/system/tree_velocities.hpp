#pragma once
/// \file
/// Conversion between the full vectors of a model and the poses and twists of a tree's bodies.

#include <polybody/math/quaternion.hpp>
#include <polybody/system/tree_body.hpp>

namespace polybody {
namespace detail {

/// Three entries of a full vector, from index `first` on.
template <class T>
Vec<T, 3> triple(VecXOf<T> const& x, Index first) {
  return {x[first], x[first + 1], x[first + 2]};
}
template <class T>
void set_pair(Vec<T, 3> const& a, Vec<T, 3> const& b, Vec<T, 6>& out) {
  for (int i = 0; i < 6; ++i) out[i] = i < 3 ? a[i] : b[i - 3];
}

/// [v; ω] of a body from a full vector of velocities or accelerations, in world axes.
template <class T>
[[gnu::always_inline]] inline Vec<T, 6> twist_of(TreeBody const& body, TreeFrameOf<T> const& f, VecXOf<T> const& x) {
  T const* const u = x.data() + body.v0;
  if (body.layout == RigidLayout::plane) return {u[0], u[1], 0.0, 0.0, 0.0, u[2]};
  Vec<T, 6> t;
  for (int i = 0; i < 3; ++i) {
    t[i] = u[i];
    t[3 + i] = f.A(i, 0) * u[3] + f.A(i, 1) * u[4] + f.A(i, 2) * u[5];
  }
  return t;
}
template <class T>
[[gnu::always_inline]] inline void put_twist(TreeBody const& body, TreeFrameOf<T> const& f, Vec<T, 6> const& t,
                                             VecXOf<T>& x) {
  T* const u = x.data() + body.v0;
  if (body.layout == RigidLayout::plane) {
    u[0] = t[0];
    u[1] = t[1];
    u[2] = t[5];
    return;
  }
  for (int i = 0; i < 3; ++i) {
    u[i] = t[i];
    u[3 + i] = f.A(0, i) * t[3] + f.A(1, i) * t[4] + f.A(2, i) * t[5];
  }
}

}  // namespace detail

/// t += twist due to the rigid motion of the parent, with twist `parent` (6), at a body at `arm` (3) from the parent.
template <class T>
void add_carried(Vec<T, 6> const& parent, Vec<T, 3> const& arm, Vec<T, 6>& t) {
  Vec<T, 3> const rate = cross<T>({parent[3], parent[4], parent[5]}, arm);
  for (int i = 0; i < 6; ++i) t[i] += parent[i];
  for (int i = 0; i < 3; ++i) t[i] += rate[i];
}
/// parent += wrench w = [f; m] (6) of a body at `arm` (3) from the parent.
template <class T>
void add_back(Vec<T, 6> const& w, Vec<T, 3> const& arm, Vec<T, 6>& parent) {
  Vec<T, 3> const moment = cross<T>(arm, {w[0], w[1], w[2]});
  for (int i = 0; i < 6; ++i) parent[i] += w[i];
  for (int i = 0; i < 3; ++i) parent[3 + i] += moment[i];
}

namespace detail {

/// t += column · factor. `column` points to the first of six entries.
template <class T>
void add_column(T const* column, T factor, Vec<T, 6>& t) {
  for (int i = 0; i < 6; ++i) t[i] += column[i] * factor;
}
/// Dot product column · t. `column` points to the first of six entries.
template <class T>
T along_column(T const* column, Vec<T, 6> const& t) {
  T sum = 0.0;
  for (int i = 0; i < 6; ++i) sum += column[i] * t[i];
  return sum;
}

/// Reads the frame of a body from full vectors. `write_frame` is the inverse operation.
template <class T>
void read_frame(TreeBody const& body, VecXOf<T> const& q, VecXOf<T> const& v, TreeFrameOf<T>& f) {
  if (body.layout == RigidLayout::plane) {
    f.r = {q[body.q0], q[body.q0 + 1], 0.0};
    f.angle = q[body.q0 + 2];
    f.A = turn_about<T>(2, f.angle);
  } else {
    f.r = triple<T>(q, body.q0);
    f.rotation = {q[body.q0 + 3], q[body.q0 + 4], q[body.q0 + 5], q[body.q0 + 6]};
    f.A = rotation_matrix<T>(f.rotation);
  }
  Vec<T, 6> const t = twist_of<T>(body, f, v);
  f.v = {t[0], t[1], t[2]};
  f.w = {t[3], t[4], t[5]};
}
template <class T>
void write_frame(TreeBody const& body, TreeFrameOf<T> const& f, VecXOf<T>& q, VecXOf<T>& v) {
  bool const plane = body.layout == RigidLayout::plane;
  for (int i = 0; i < 3; ++i) q[body.q0 + i] = plane && i == 2 ? f.angle : f.r[i];
  for (int i = 0; i < 4 && !plane; ++i) q[body.q0 + 3 + i] = f.rotation[i];
  put_twist<T>(body, f, {f.v[0], f.v[1], f.v[2], f.w[0], f.w[1], f.w[2]}, v);
}

}  // namespace detail
}  // namespace polybody
