#pragma once
/// \file
/// Bodies that carry one another through joint coordinates [thesis Eq. 3.4–3.5; Shabana 2020, §3]: a body's pose is its
/// parent's followed by the joint's motions, and with D the arm from the parent's origin to its own,
///   ω = ω_p + S_ω u,   ṙ = ṙ_p + ω_p × D + S_r u,
///   ω˙ = ω˙_p + S_ω u̇ + b_ω,   r̈ = r̈_p + ω˙_p × D + S_r u̇ + b_r,
/// all in world axes; b is what is left for u̇ = 0 and a parent without accelerations. The origin of a rigid body is its
/// centre of mass. A body that floats on a frame is carried by this frame; its deformation q stays as it is, and an end
/// of a joint on it moves with q: then S_D q̇ comes in beside S u (`FloatingEnd`). Whole vectors hold every body, narrow
/// ones the joints and deformations. Everything is one walk from the roots to the tips or back.

#include <polybody/system/floating_end.hpp>
#include <polybody/system/joint_jacobian.hpp>
#include <polybody/system/tree_velocities.hpp>
#include <polybody/system/turning_joint.hpp>

namespace polybody {

/// \tparam T scalar of the vectors
template <class T = double>
class JointTreeOf {
  using Vec3 = Vec<T, 3>;
  using Vec6 = Vec<T, 6>;
  using VecX = VecXOf<T>;
  using TreeFrame = TreeFrameOf<T>;
  using TreeState = TreeStateOf<T>;
  using FloatingEnd = FloatingEndOf<T>;

 public:
  /// Bodies in an order in which each stands behind its parent.
  Sequence<TreeBody> bodies;
  Sequence<FloatingEnd> ends;  ///< of joints on bodies that deform

  /// Whether no body is carried: there is no tree.
  bool empty() const { return bodies.empty(); }

  /// Poses and speeds of the carried bodies from the joints' coordinates qn and speeds vn; those of roots are read.
  /// `q`, `v` are whole.
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

  /// out = T u, or T u + b with `bias`: whole from narrow, where the parts of roots stand already.
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

  /// The u with T u next to x (whole): exact where x keeps to the joints. Parts of roots are left to the caller. With
  /// `bias`, of x − b.
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

  /// out = Tᵀ r: narrow from whole. Parts of roots and of deformations: in r, where the caller reads them. Generalised
  /// forces and wrenches change in the same way as speeds and twists, for A is orthogonal.
  void reduce_forces(TreeState& s, VecX& r, VecX& out) const {
    for (std::size_t i = 0; i < bodies.size(); ++i) s.held[i] = detail::twist_of<T>(bodies[i], s.frames[i], r);
    for (std::size_t i = bodies.size(); i-- > 0;) {
      TreeBody const& body = bodies[i];
      TreeFrame const& f = s.frames[i];
      Vec6 const& w = s.held[i];
      if (!body.carried()) {
        detail::put_twist<T>(body, f, w, r);
        continue;
      }
      for (int k = 0; k < f.velocities; ++k) out[body.vn + k] = detail::along_column<T>(f.column(k), w);
      for_each_rate(body, [&](std::size_t column, Index rate) {
        r[rate] += detail::along_column<T>(s.columns[column].data(), w);
      });
      if (body.parent >= 0) add_back<T>(w, f.arm, s.held[std::size_t(body.parent)]);
    }
  }

  /// A whole r with Tᵀ r = `given` (narrow); parts of roots and of deformations stand already.
  void expand_forces(TreeState& s, VecX const& given, VecX& r) const {
    for (std::size_t i = 0; i < bodies.size(); ++i)
      s.held[i] = bodies[i].carried() ? detail::zeros<Vec6>() : detail::twist_of<T>(bodies[i], s.frames[i], r);
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
      for (int j = 0; j < 6; ++j) s.held[i][j] += w[j];
      if (body.parent < 0) continue;
      add_back<T>(w, f.arm, carried);
      for (int j = 0; j < 6; ++j) s.held[std::size_t(body.parent)][j] -= carried[j];
    }
    for (std::size_t i = 0; i < bodies.size(); ++i) detail::put_twist<T>(bodies[i], s.frames[i], s.held[i], r);
  }

  /// Frame of the body that carries this one, or of the ground.
  TreeFrame const& parent_of(TreeBody const& body, TreeState const& s) const {
    return body.parent < 0 ? ground_ : s.frames[std::size_t(body.parent)];
  }
  /// Scratch for this tree, as large as it will ever be.
  TreeState state() const {
    TreeState s;
    s.frames.resize(bodies.size());
    s.twists.resize(bodies.size());
    s.held.resize(bodies.size());
    for (FloatingEnd const& end : ends) end.make_room(s.columns, s.q, s.v, s.jacobian);
    return s;
  }

  /// f(column in the state, rate in whole speeds) for the deformations that move a carried body.
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
  /// The frame that one motion after the other leads to, from an end on the parent to one on the body.
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

using JointTree = JointTreeOf<>;  ///< the tree of joint coordinates

}  // namespace polybody
