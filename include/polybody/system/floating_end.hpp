#pragma once
/// \file
/// Where a joint of a `JointTree` meets a body that floats on a frame: the end moves with the body's deformation, so
/// the rates of this one move what the joint carries beside the joint's own speeds.

#include <numbers>

#include <polybody/kinematics/marker_kinematics.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/system/tree_body.hpp>

namespace polybody {

/// A marker of a floating body, without the body's type. \tparam T scalar of the body's coordinates
template <class T = double>
struct FloatingEndOf {
  /// Publishes the marker of `end` on a body with coordinates q and speeds v of its own, both from its first on.
  using Publish = void (*)(FloatingEndOf const& end, T const* q, T const* v, MarkerKinematics<T>& out);

  Publish evaluate_marker = nullptr;             ///< the marker where the body has these coordinates and speeds
  void const *body = nullptr, *point = nullptr;  ///< the body and the point on it, whose types `evaluate_marker` knows
  Mat3 axes = Mat3::Identity();                  ///< relative to the section's: the joint's axes
  RigidLayout layout = RigidLayout::quaternion;  ///< how the coordinates of the floating frame are written
  Index q0 = 0, v0 = 0;                          ///< of the body in whole vectors
  Index deformations = 0;                        ///< behind its frame
  Index first_column = 0;                        ///< in the state of the tree

  /// How many coordinates the body's floating frame has: (x, y, angle), or position and quaternion.
  Index frame_coordinates() const { return layout == RigidLayout::plane ? 3 : 7; }
  /// How many speeds it has: they come before those of the deformation.
  Index frame_velocities() const { return layout == RigidLayout::plane ? 3 : 6; }
  /// Lengthens what a tree's state holds for its ends: `columns`, q and v of a body, `jacobian`.
  template <class Columns, class Numbers>
  void make_room(Columns& columns, Numbers& q, Numbers& v, Numbers& jacobian) const {
    std::size_t const velocities = std::size_t(frame_velocities() + deformations);
    columns.resize(std::max(columns.size(), std::size_t(first_column + deformations)));
    q.resize(std::max(q.size(), velocities + 1));
    v.resize(std::max(v.size(), velocities));
    jacobian.resize(std::max(jacobian.size(), 6 * velocities));
  }
  /// Where the first deformation's rate stands in whole speeds.
  Index first_rate() const { return v0 + frame_velocities(); }
};
using FloatingEnd = FloatingEndOf<>;  ///< in doubles

namespace detail {

/// The marker, with its Jacobian in the tree's scratch.
template <class T>
MarkerKinematics<T> place_end(FloatingEndOf<T> const& end, T const* q, T const* v, TreeStateOf<T>& s) {
  MarkerKinematics<T> out;
  out.jacobian = s.jacobian.data();
  end.evaluate_marker(end, q, v, out);
  return out;
}
/// The angle x without full turns, −π to π [rad].
inline double within_a_turn(double x) { return std::remainder(x, 2.0 * std::numbers::pi); }
template <class T>
T within_a_turn(T const& x) {
  return x + (within_a_turn(value_of(x)) - value_of(x));
}
/// The turn of the joint's frame against the body's reference axes at this angle, in the plane: small, as deformations
/// are.
template <class T>
T bent_by(FloatingEndOf<T> const& end, Mat<T, 3, 3> const& a, T angle) {
  using std::atan2;
  Mat<T, 3, 3> const section = product<T, 3>(a, in_scalar<T>(transposed<double>(end.axes)));
  return within_a_turn(atan2(section(1, 0), section(0, 0)) - angle);
}
/// A column of a motion at r, at the world's origin until `finish_columns`.
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

/// From the frame of the parent to the joint's frame on it. `q`, `v` are whole, and hold the parent.
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

/// From the joint's frame on a body to the frame on which this one floats: with u, R, ω_d of the marker in the frame's
/// axes, all by deformation alone,
///   A = A_m Rᵀ,  ω = ω_m − A ω_d,  r = r_m − A u,  ṙ = ṙ_m − ω × A u − A u˙,
///   ω˙ = ω˙_m − ω × A ω_d − A ω˙_d,  r̈ = r̈_m − ω˙ × A u − ω × (ω × A u) − 2 ω × A u˙ − A u¨.
/// `q`, `v` are whole, and hold the body's deformation.
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
