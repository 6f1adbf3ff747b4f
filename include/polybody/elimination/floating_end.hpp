#pragma once
/// \file
/// End of a joint of a `JointTree` on a body with a floating frame. The end moves with the deformation of the body, so
/// the motion of the carried body depends on deformation rates in addition to the joint's velocities.
/// Theory: Eq. 5.21.

#include <numbers>

#include <polybody/elimination/tree_body.hpp>
#include <polybody/kinematics/marker_kinematics.hpp>
#include <polybody/math/sequence.hpp>

namespace polybody {

/// Marker of a body with a floating frame, with erased body type. \tparam T scalar type of the body's coordinates
template <class T = double>
struct FloatingEndOf {
  /// Function that evaluates the marker of `end`. q and v are those of the body of `end` only.
  using Publish = void (*)(FloatingEndOf const& end, T const* q, T const* v, MarkerKinematics<T>& out);

  Publish evaluate_marker = nullptr;             ///< function for the types of `body` and `point`
  void const *body = nullptr, *point = nullptr;  ///< body and point on it, with erased types
  Mat3 axes = Mat3::Identity();                  ///< (3×3) axes of the joint relative to those of the section
  RigidLayout layout = RigidLayout::quaternion;  ///< coordinates of the floating frame
  Index q0 = 0, v0 = 0;                          ///< first coordinate and velocity of the body in full vectors
  Index deformations = 0;                        ///< number of deformation coordinates, after those of the frame
  Index first_column = 0;                        ///< index of the first column of this end in `TreeStateOf::columns`

  /// Number of coordinates of the floating frame: (x, y, angle), or position and quaternion.
  Index frame_coordinates() const { return layout == RigidLayout::plane ? 3 : 7; }
  /// Number of velocities of the floating frame. They precede the deformation rates of the body.
  Index frame_velocities() const { return layout == RigidLayout::plane ? 3 : 6; }
  /// Enlarges the arrays of a tree's state as this end requires: `columns`, q and v of a body, `jacobian`.
  template <class Columns, class Numbers>
  void make_room(Columns& columns, Numbers& q, Numbers& v, Numbers& jacobian) const {
    std::size_t const velocities = std::size_t(frame_velocities() + deformations);
    columns.resize(std::max(columns.size(), std::size_t(first_column + deformations)));
    q.resize(std::max(q.size(), velocities + 1));
    v.resize(std::max(v.size(), velocities));
    jacobian.resize(std::max(jacobian.size(), 6 * velocities));
  }
  /// Index of the first deformation rate in full velocities.
  Index first_rate() const { return v0 + frame_velocities(); }
};
using FloatingEnd = FloatingEndOf<>;  ///< end with coordinates in doubles

namespace detail {

/// Evaluates the marker of an end, with its Jacobian in the workspace s.
template <class T>
MarkerKinematics<T> place_end(FloatingEndOf<T> const& end, T const* q, T const* v, TreeStateOf<T>& s) {
  MarkerKinematics<T> out;
  out.jacobian = s.jacobian.data();
  end.evaluate_marker(end, q, v, out);
  return out;
}
/// Angle x modulo 2π, from −π to π [rad].
inline double within_a_turn(double x) { return std::remainder(x, 2.0 * std::numbers::pi); }
template <class T>
T within_a_turn(T const& x) {
  return x + (within_a_turn(value_of(x)) - value_of(x));
}
/// Rotation [rad] of a marker's section relative to a planar floating frame that is rotated by `angle` [rad]. It is
/// taken between −π and π, because deformations are small. \param a (3×3) axes of the marker
template <class T>
T bent_by(FloatingEndOf<T> const& end, Mat<T, 3, 3> const& a, T angle) {
  using std::atan2;
  Mat<T, 3, 3> const section = product<T, 3>(a, in_scalar<T>(transposed<double>(end.axes)));
  return within_a_turn(atan2(section(1, 0), section(0, 0)) - angle);
}
/// Jacobian column of a motion with the translation `slide` at r and the rotation `turn`, referred to the world's
/// origin. `move_column` refers it to the body's origin.
template <class T>
Vec<T, 6> column_from(Vec<T, 3> const& r, Vec<T, 3> const& slide, Vec<T, 3> const& turn) {
  Vec<T, 3> const carried = cross<T>(r, turn);
  Vec<T, 6> out;
  for (int i = 0; i < 3; ++i) {
    out[i] = slide[i] + carried[i];
    out[3 + i] = turn[i];
  }
  return out;
}

/// Moves `run` from the frame of the parent to the joint's frame on the parent. q and v are full and already contain
/// the parent's state.
template <class T>
void leave_body(FloatingEndOf<T> const& end, VecXOf<T> const& q, VecXOf<T> const& v, RunnerOf<T>& run, T& angle,
                TreeStateOf<T>& s) {
  MarkerKinematics<T> const p = place_end<T>(end, q.data() + end.q0, v.data() + end.v0, s);
  if (end.layout == RigidLayout::plane) angle += bent_by<T>(end, p.frame.A, q[end.q0 + 2]);
  run = {p.frame.r, p.frame.v, {p.bias[0], p.bias[1], p.bias[2]},
         p.frame.A, p.frame.w, {p.bias[3], p.bias[4], p.bias[5]}};
  for (Index k = 0; k < end.deformations; ++k) {
    T const* const j = p.jacobian + 6 * (end.frame_velocities() + k);
    s.columns[std::size_t(end.first_column + k)] = column_from<T>(run.r, {j[0], j[1], j[2]}, {j[3], j[4], j[5]});
  }
}

/// Moves `run` from the joint's frame on a body to the floating frame of the body. With the position u, rotation R and
/// angular velocity ω_d of the marker (index m) relative to the floating frame, in the axes of this frame,
///   A = A_m Rᵀ,  ω = ω_m − A ω_d,  r = r_m − A u,  ṙ = ṙ_m − ω × A u − A u˙,
///   ω˙ = ω˙_m − ω × A ω_d − A ω˙_d,  r̈ = r̈_m − ω˙ × A u − ω × (ω × A u) − 2 ω × A u˙ − A u¨.
/// q and v are full and already contain the body's deformation.
template <class T>
void arrive_on_body(FloatingEndOf<T> const& end, VecXOf<T> const& q, VecXOf<T> const& v, RunnerOf<T>& run, T& angle,
                    TreeStateOf<T>& s) {
  Index const nq = end.frame_coordinates(), nv = end.frame_velocities();
  for (Index i = 0; i < nq; ++i) s.q[std::size_t(i)] = nq == 7 && i == 3 ? 1.0 : 0.0;
  for (Index i = 0; i < nv; ++i) s.v[std::size_t(i)] = 0.0;
  for (Index k = 0; k < end.deformations; ++k) {
    s.q[std::size_t(nq + k)] = q[end.q0 + nq + k];
    s.v[std::size_t(nv + k)] = v[end.v0 + nv + k];
  }
  MarkerKinematics<T> const p = place_end<T>(end, s.q.data(), s.v.data(), s);
  if (end.layout == RigidLayout::plane) angle -= bent_by<T>(end, p.frame.A, T(0.0));
  Mat<T, 3, 3> const A = product<T>(run.A, transposed<T>(p.frame.A));
  auto const turned = [&](T const* x) { return product<T, 1>(A, Vec<T, 3>(x[0], x[1], x[2])); };
  Vec<T, 3> const arm = turned(p.frame.r.data()), rate = turned(p.frame.v.data()), spin = turned(p.frame.w.data()),
                  rate_bias = turned(p.bias.data()), spin_bias = turned(p.bias.data() + 3);
  for (Index k = 0; k < end.deformations; ++k) {
    T const* const j = p.jacobian + 6 * (nv + k);
    Vec<T, 3> const slide = scaled<T>(turned(j), -1.0), turn = scaled<T>(turned(j + 3), -1.0);
    s.columns[std::size_t(end.first_column + k)] = column_from<T>(run.r, slide, turn);
  }
  run.A = A;
  for (int i = 0; i < 3; ++i) run.w[i] -= spin[i];
  Vec<T, 3> const bent = cross<T>(run.w, spin), along = cross<T>(run.w, rate);
  for (int i = 0; i < 3; ++i) {
    run.alpha[i] -= bent[i] + spin_bias[i];
    run.v[i] -= rate[i];
    run.a[i] -= 2.0 * along[i] + rate_bias[i];
  }
  run.go(scaled<T>(arm, -1.0));
}

}  // namespace detail

}  // namespace polybody
