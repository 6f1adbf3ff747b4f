#pragma once
/// \file
/// Jacobian S of a joint: motion of the carried body due to each velocity of the joint.

#include <utility>

#include <polybody/math/quaternion.hpp>
#include <polybody/system/tree_body.hpp>

namespace polybody::detail {

/// Moves `run` by one joint motion and appends its columns to f.s. The columns refer to the world's origin until
/// `finish_columns`, because the position of the body is not yet known.
/// \param sign 1 from frame a to frame b; −1 from b to a \param x, u coordinates and velocities of the motion
template <class T>
void move(JointMotion const& m, double sign, T const* x, T const* u, RunnerOf<T>& run, TreeFrameOf<T>& f) {
  Vec<T, 3> const none(0, 0, 0), n(sign * run.A(0, m.axis), sign * run.A(1, m.axis), sign * run.A(2, m.axis));
  auto const column = [&](Vec<T, 3> const& slide, Vec<T, 3> const& turn) {
    Vec<T, 3> const carried = cross<T>(run.r, turn);  // velocity at the world's origin
    for (int i = 0; i < 3; ++i) {
      f.s(i, f.velocities) = slide[i] + carried[i];
      f.s(3 + i, f.velocities) = turn[i];
    }
    ++f.velocities;
  };
  switch (m.kind) {
    case JointMotion::Kind::slide:
      column(n, none);
      run.slide(n, x[0], u[0]);
      break;
    case JointMotion::Kind::turn:
    case JointMotion::Kind::screw:
      column(scaled<T>(n, m.pitch), n);
      if (m.kind == JointMotion::Kind::screw) run.slide(n, m.pitch * x[0], m.pitch * u[0]);
      run.turn(times<T>(n, u[0]));
      turn_columns<T>(m.axis, sign * x[0], run.A);
      f.angle += n[2] * x[0];  // in the plane n[2] is 1 or −1
      break;
    case JointMotion::Kind::ball: {
      Mat<T, 3, 3> const turned = rotation_matrix<T>(Quaternion<T>(x[0], x[1], x[2], x[3]));
      Mat<T, 3, 3> const b = sign > 0.0 ? product<T>(run.A, turned) : run.A;  // axes of frame b
      for (int k = 0; k < 3; ++k) column(none, {sign * b(0, k), sign * b(1, k), sign * b(2, k)});
      run.turn(scaled<T>(product<T, 1>(b, Vec<T, 3>(u[0], u[1], u[2])), sign));
      run.A = sign > 0.0 ? b : product<T>(run.A, transposed<T>(turned));
    }
  }
}
/// Sorts columns that were computed from the last motion to the first into the order of the coordinates.
template <class T>
void reverse_columns(TreeBody const& body, TreeFrameOf<T>& f) {
  Mat<T, 6, 6> const back = f.s;
  int to = 0, end = f.velocities;
  for (JointMotion const& m : body.motions) {
    end -= m.velocities();
    for (int k = 0; k < m.velocities(); ++k, ++to)
      for (int i = 0; i < 6; ++i) f.s(i, to) = back(i, end + k);
  }
}
/// Moves `run` by all motions of a joint, from frame a to frame b or back. \param x, u coordinates and velocities of
/// the joint
template <class T>
void move_by_joint(TreeBody const& body, T const* x, T const* u, RunnerOf<T>& run, TreeFrameOf<T>& f) {
  f.velocities = 0;
  if (!body.backwards) {
    for (JointMotion const& m : body.motions) {
      move<T>(m, 1.0, x, u, run, f);
      x += m.coordinates();
      u += m.velocities();
    }
    return;
  }
  x += body.motions.coordinates();
  u += body.motions.velocities();
  for (int k = body.motions.count; k-- > 0;) {
    JointMotion const& m = body.motions.list[std::size_t(k)];
    move<T>(m, -1.0, x -= m.coordinates(), u -= m.velocities(), run, f);
  }
  reverse_columns<T>(body, f);
}
/// Changes the reference point of a column from the world's origin to r.
template <class T>
void move_column(Vec<T, 3> const& r, T* column) {
  Vec<T, 3> const carried = cross<T>({column[3], column[4], column[5]}, r);
  for (int i = 0; i < 3; ++i) column[i] += carried[i];
}
/// Changes the reference point of all columns to the origin of the body, and computes (SᵀS)⁻¹.
template <class T>
void finish_columns(TreeFrameOf<T>& f) {
  for (int k = 0; k < f.velocities; ++k) move_column<T>(f.r, f.column(k));
  for (int i = 0; i < f.velocities; ++i)
    for (int j = 0; j < f.velocities; ++j) {
      T sum = 0.0;
      for (int k = 0; k < 6; ++k) sum += f.s(k, i) * f.s(k, j);
      f.inverse(i, j) = sum;
    }
  invert_leading(f.inverse, f.velocities);
}

}  // namespace polybody::detail
