#pragma once
/// \file
/// Tree of bodies with joint coordinates [thesis Eq. 3.4–3.5; Shabana 2020, §3]. The pose of a body is that of its
/// parent followed by the motions of the joint. With the arm D from the parent's origin to the body's origin,
///   ω = ω_p + S_ω u,   ṙ = ṙ_p + ω_p × D + S_r u,
///   ω˙ = ω˙_p + S_ω u̇ + b_ω,   r̈ = r̈_p + ω˙_p × D + S_r u̇ + b_r,
/// all in world axes; b is the acceleration for u̇ = 0 and a parent without acceleration. The origin of a rigid body is
/// its centre of mass. For a body with a floating frame, the joint carries the frame, and the deformation coordinates q
/// remain unknowns. An end of a joint on such a body moves with q, which adds S_D q̇ to S u (`FloatingEnd`). Full
/// vectors contain all bodies; reduced vectors contain the joint coordinates and deformations. Each function loops over
/// the bodies, from the roots to the tips or back.
/// Theory: Eqs. 5.17 to 5.20.

#include <utility>

#include <polybody/elimination/floating_end.hpp>
#include <polybody/elimination/tree_body.hpp>
#include <polybody/math/quaternion.hpp>

namespace polybody::detail {

// Jacobian S of a joint: motion of the carried body due to each velocity of the joint.

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
/// Sorts columns, computed from the last motion to the first, into the order of the coordinates.
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

namespace polybody {

// Rigid body on a revolute joint: the most frequent case of `JointTree`, without a loop over the motions of a joint.

/// Fills in `body.turn` if the joint permits a single rotation only. The sign of the quaternions `still` and `turning`
/// is chosen so that the quaternion of the body agrees with its value in `reference`, the full coordinates of the
/// reference state. \param parent index of the first coordinate of the parent; −1: the ground
template <class = void>
[[gnu::cold]] void prepare_turn(TreeBody& body, double const* reference, Index parent) {
  if (body.motions.count != 1 || body.motions.list[0].kind != JointMotion::Kind::turn) return;
  int const k = body.motions.list[0].axis;
  double const sign = body.backwards ? -1.0 : 1.0;
  JointTurn& turn = body.turn;
  turn.only = true;
  for (int i = 0; i < 3; ++i) turn.axis[i] = sign * body.from.axes(i, k);
  if (body.layout == RigidLayout::plane) return;
  Quaternion<double> const from = quaternion_of(body.from.axes), back = conjugate(quaternion_of(body.to.axes));
  Quaternion<double> half(0.0, 0.0, 0.0, 0.0);
  half[1 + k] = sign;
  turn.still = quaternion_product(from, back);
  turn.turning = quaternion_product(quaternion_product(from, half), back);
  auto const at = [&](Index q) {
    return Quaternion<double>(reference[q], reference[q + 1], reference[q + 2], reference[q + 3]);
  };
  Quaternion<double> const stands = at(body.q0 + 3),
                           led = quaternion_product(parent < 0 ? Quaternion<double>(1, 0, 0, 0) : at(parent + 3),
                                                    turn.still);
  double along = 0.0;
  for (int i = 0; i < 4; ++i) along += stands[i] * led[i];
  for (int i = 0; i < 4 && along < 0.0; ++i) {
    turn.still[i] = -turn.still[i];
    turn.turning[i] = -turn.turning[i];
  }
}

namespace detail {

/// Computes the frame f of a body from the frame p of its parent, for a joint with a single rotation. \param x, u angle
/// [rad] and its rate [rad/s]
template <class T>
void carry_by_turn(TreeBody const& body, TreeFrameOf<T> const& p, T const& x, T const& u, TreeFrameOf<T>& f) {
  using std::cos, std::sin;
  RunnerOf<T> run{p.r, p.v, {0, 0, 0}, {}, p.w, {0, 0, 0}};
  run.go(product<T, 1>(p.A, in_scalar<T>(body.from.origin)));
  Vec<T, 3> const n = product<T, 1>(p.A, in_scalar<T>(body.turn.axis));
  run.turn(times<T>(n, u));
  if (body.layout == RigidLayout::plane) {
    f.angle = p.angle + body.angle + n[2] * x;
    f.A = turn_about<T>(2, f.angle);
  } else {
    T const c = cos(0.5 * x), s = sin(0.5 * x);
    Quaternion<T> by;
    for (int i = 0; i < 4; ++i) by[i] = body.turn.still[i] * c + body.turn.turning[i] * s;
    f.rotation = quaternion_product<T>(p.rotation, by);
    set_rotation<T>(f.rotation, f.A);
  }
  Vec<T, 3> const to_centre = scaled<T>(product<T, 1>(f.A, in_scalar<T>(body.to.origin)), -1.0);
  run.go(to_centre);
  f.r = run.r;
  f.v = run.v;
  f.w = run.w;
  Vec<T, 3> const slide = cross<T>(n, to_centre);
  T size = 0.0;
  for (int i = 0; i < 3; ++i) {
    f.arm[i] = f.r[i] - p.r[i];
    f.bias[i] = run.a[i];
    f.bias[3 + i] = run.alpha[i];
    f.s(i, 0) = slide[i];
    f.s(3 + i, 0) = n[i];
    size += slide[i] * slide[i] + n[i] * n[i];
  }
  f.velocities = 1;
  f.inverse(0, 0) = 1.0 / size;
}

}  // namespace detail

/// Tree of bodies with joint coordinates. A joint carries each body except the roots. \tparam T scalar type of the
/// vectors
template <class T = double>
class JointTreeOf {
  using Vec3 = Vec<T, 3>;
  using Vec6 = Vec<T, 6>;
  using VecX = VecXOf<T>;
  using TreeFrame = TreeFrameOf<T>;
  using TreeState = TreeStateOf<T>;
  using FloatingEnd = FloatingEndOf<T>;

 public:
  /// Bodies of the tree; each parent precedes its children.
  Sequence<TreeBody> bodies;
  Sequence<FloatingEnd> ends;  ///< ends of joints on bodies with a floating frame

  /// True if the tree has no bodies.
  bool empty() const { return bodies.empty(); }

  /// Computes poses and velocities of the carried bodies from the reduced coordinates qn and velocities vn and writes
  /// them to the full vectors q, v. The state of roots and deformations must already be in q, v.
  void expand_state(VecX const& qn, VecX const& vn, VecX& q, VecX& v, TreeState& s) const {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      TreeBody const& body = bodies[i];
      TreeFrame& f = s.frames[i];
      if (!body.carried()) {
        detail::read_frame<T>(body, q, v, f);
        continue;
      }
      TreeFrame const& p = parent_of(body, s);
      if (body.turn.only)
        detail::carry_by_turn<T>(body, p, qn[body.qn], vn[body.vn], f);
      else
        carry(body, {qn, vn}, {q, v}, f, s);
      detail::write_frame<T>(body, f, q, v);
    }
  }

  /// out = T u, or T u + b with `bias`; u is reduced, out is full. Entries of roots and deformations must already be in
  /// `out`.
  void expand_rates(TreeState& s, VecX const& u, bool bias, VecX& out) const {
    Sequence<Vec6>& twist = s.twists;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      TreeBody const& body = bodies[i];
      TreeFrame const& f = s.frames[i];
      if (!body.carried()) {
        twist[i] = detail::twist_of<T>(body, f, out);
        continue;
      }
      Vec6& t = twist[i];
      for (int j = 0; j < 6; ++j) t[j] = bias ? f.bias[j] : T(0.0);
      if (body.parent >= 0) add_carried<T>(twist[std::size_t(body.parent)], f.arm, t);
      for (int k = 0; k < f.velocities; ++k) detail::add_column<T>(f.column(k), u[body.vn + k], t);
      for_each_rate(
          body, [&](std::size_t column, Index rate) { detail::add_column<T>(s.columns[column].data(), out[rate], t); });
      detail::put_twist<T>(body, f, t, out);
    }
  }

  /// Computes the reduced u from the full x = T u, or from x = T u + b with `bias`. If x violates the equations of the
  /// joints, u minimises the error of each joint for the given motion of its parent. Entries of roots and deformations
  /// are not written.
  void reduce_rates(TreeState& s, VecX const& x, bool bias, VecX& u) const {
    for (std::size_t i = 0; i < bodies.size(); ++i) s.twists[i] = detail::twist_of<T>(bodies[i], s.frames[i], x);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      TreeBody const& body = bodies[i];
      if (!body.carried()) continue;
      TreeFrame const& f = s.frames[i];
      auto carried = detail::zeros<Vec6>();
      if (body.parent >= 0) add_carried<T>(s.twists[std::size_t(body.parent)], f.arm, carried);
      Vec6 t, st;
      for_each_rate(body, [&](std::size_t column, Index rate) {
        detail::add_column<T>(s.columns[column].data(), x[rate], carried);
      });
      for (int j = 0; j < 6; ++j) t[j] = s.twists[i][j] - (bias ? f.bias[j] : T(0.0)) - carried[j];
      for (int k = 0; k < f.velocities; ++k) st[k] = detail::along_column<T>(f.column(k), t);
      for (int k = 0; k < f.velocities; ++k) {
        T sum = 0.0;
        for (int j = 0; j < f.velocities; ++j) sum += f.inverse(k, j) * st[j];
        u[body.vn + k] = sum;
      }
    }
  }

  /// out = Tᵀ r; r is full, out is reduced. Entries of roots and deformations are written to r only; the caller copies
  /// them. Generalised forces and wrenches transform like velocities and twists, because A is orthogonal.
  void reduce_forces(TreeState& s, VecX& r, VecX& out) const {
    for (std::size_t i = 0; i < bodies.size(); ++i) s.residuals[i] = detail::twist_of<T>(bodies[i], s.frames[i], r);
    for (std::size_t i = bodies.size(); i-- > 0;) {
      TreeBody const& body = bodies[i];
      TreeFrame const& f = s.frames[i];
      Vec6 const& w = s.residuals[i];
      if (!body.carried()) {
        detail::put_twist<T>(body, f, w, r);
        continue;
      }
      for (int k = 0; k < f.velocities; ++k) out[body.vn + k] = detail::along_column<T>(f.column(k), w);
      for_each_rate(body, [&](std::size_t column, Index rate) {
        r[rate] += detail::along_column<T>(s.columns[column].data(), w);
      });
      if (body.parent >= 0) add_back<T>(w, f.arm, s.residuals[std::size_t(body.parent)]);
    }
  }

  /// Computes a full r with Tᵀ r = `given` (reduced). Entries of roots and deformations must already be in r.
  void expand_forces(TreeState& s, VecX const& given, VecX& r) const {
    for (std::size_t i = 0; i < bodies.size(); ++i)
      s.residuals[i] = bodies[i].carried() ? detail::zeros<Vec6>() : detail::twist_of<T>(bodies[i], s.frames[i], r);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      TreeBody const& body = bodies[i];
      if (!body.carried()) continue;
      TreeFrame const& f = s.frames[i];
      auto w = detail::zeros<Vec6>(), carried = w;
      for (int k = 0; k < f.velocities; ++k) {
        T sum = 0.0;
        for (int j = 0; j < f.velocities; ++j) sum += f.inverse(k, j) * given[body.vn + j];
        detail::add_column<T>(f.column(k), sum, w);
      }
      for_each_rate(body, [&](std::size_t column, Index rate) {
        r[rate] -= detail::along_column<T>(s.columns[column].data(), w);
      });
      for (int j = 0; j < 6; ++j) s.residuals[i][j] += w[j];
      if (body.parent < 0) continue;
      add_back<T>(w, f.arm, carried);
      for (int j = 0; j < 6; ++j) s.residuals[std::size_t(body.parent)][j] -= carried[j];
    }
    for (std::size_t i = 0; i < bodies.size(); ++i) detail::put_twist<T>(bodies[i], s.frames[i], s.residuals[i], r);
  }

  /// Frame of the body that carries `body`, or of the ground.
  TreeFrame const& parent_of(TreeBody const& body, TreeState const& s) const {
    return body.parent < 0 ? ground_ : s.frames[std::size_t(body.parent)];
  }
  /// Workspace for this tree, in its final size.
  TreeState state() const {
    TreeState s;
    s.frames.resize(bodies.size());
    s.twists.resize(bodies.size());
    s.residuals.resize(bodies.size());
    for (FloatingEnd const& end : ends) end.make_room(s.columns, s.q, s.v, s.jacobian);
    return s;
  }

  /// Calls f(column, rate) for each deformation that moves a carried body, with its index in `TreeState::columns` and
  /// the index of its rate in full velocities.
  template <class F>
  void for_each_rate(TreeBody const& body, F&& f) const {
    for (Index const e : {body.from_end, body.to_end}) {
      if (e < 0) continue;
      FloatingEnd const& end = ends[std::size_t(e)];
      for (Index k = 0; k < end.deformations; ++k) f(std::size_t(end.first_column + k), end.first_rate() + k);
    }
  }

 private:
  struct Vectors {
    VecX const &q, &v;
  };
  /// Computes the frame f of a body by all motions from the end on the parent to the end on the body.
  void carry(TreeBody const& body, Vectors const& reduced, Vectors const& full, TreeFrame& f, TreeState& s) const {
    TreeFrame const& p = parent_of(body, s);
    detail::RunnerOf<T> run{p.r, p.v, {0, 0, 0}, p.A, p.w, {0, 0, 0}};
    f.angle = p.angle + body.angle;
    if (body.from_end >= 0) {
      detail::leave_body<T>(ends[std::size_t(body.from_end)], full.q, full.v, run, f.angle, s);
    } else {
      if (body.from_turned) run.A = product<T, 3>(p.A, detail::in_scalar<T>(body.from.axes));
      run.go(product<T, 1>(p.A, detail::in_scalar<T>(body.from.origin)));
    }
    detail::move_by_joint<T>(body, reduced.q.data() + body.qn, reduced.v.data() + body.vn, run, f);
    if (body.to_end >= 0) {
      detail::arrive_on_body<T>(ends[std::size_t(body.to_end)], full.q, full.v, run, f.angle, s);
      f.A = run.A;
    } else {
      f.A = body.to_turned ? product<T, 3>(run.A, detail::in_scalar<T>(transposed<double>(body.to.axes))) : run.A;
      run.go(scaled<T>(product<T, 1>(f.A, detail::in_scalar<T>(body.to.origin)), -1.0));
    }
    if (body.layout != RigidLayout::plane) f.rotation = quaternion_from<T>(f.A);
    f.r = run.r;
    f.v = run.v;
    f.w = run.w;
    detail::set_pair<T>(run.a, run.alpha, f.bias);
    f.arm = difference<T>(f.r, p.r);
    detail::finish_columns<T>(f);
    for_each_rate(body, [&](std::size_t column, Index) { detail::move_column<T>(f.r, s.columns[column].data()); });
  }

  TreeFrame ground_ = {};
};

using JointTree = JointTreeOf<>;  ///< tree with vectors of doubles

}  // namespace polybody
