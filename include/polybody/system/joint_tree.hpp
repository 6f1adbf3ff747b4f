#pragma once
/// \file
/// Rigid bodies that carry one another through joint coordinates [thesis Eq. 3.4–3.5; Shabana 2020, §3]: a body's pose
/// is its parent's followed by the joint's motions, and with D the arm from the parent's centre of mass to its own,
///   ω = ω_p + S_ω u,   ṙ = ṙ_p + ω_p × D + S_r u,
///   ω˙ = ω˙_p + S_ω u̇ + b_ω,   r̈ = r̈_p + ω˙_p × D + S_r u̇ + b_r,
/// all in world axes; b is what is left for u̇ = 0 and a parent without accelerations. Whole vectors hold every body,
/// narrow ones the joints. Everything is one walk from the roots to the tips or back.

#include <numbers>

#include <polybody/system/joint_columns.hpp>
#include <polybody/system/turning_joint.hpp>

namespace polybody {

/// T is `double`: a template, so that a program without joint coordinates compiles none of it.
template <class T = double>
class JointTreeOf {
  using Vec3 = Vec<T, 3>;
  using Vec6 = Vec<T, 6>;
  using Mat3 = Mat<T, 3, 3>;
  using Mat6 = Mat<T, 6, 6>;
  using VecX = VecXOf<T>;
  using TreeFrame = TreeFrameOf<T>;
  using TreeState = TreeStateOf<T>;

 public:
  /// Bodies in an order in which each stands behind its parent.
  Sequence<TreeBody> bodies;

  bool empty() const { return bodies.empty(); }

  /// Poses and speeds of the carried bodies from the joints' coordinates and speeds; those of roots are read. `q`, `v`
  /// are whole.
  void expand_state(VecX const& qn, VecX const& vn, VecX& q, VecX& v, TreeState& s) const {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      TreeBody const& body = bodies[i];
      TreeFrame& f = s.frames[i];
      if (!body.carried()) {
        read(body, q, v, f);
        continue;
      }
      TreeFrame const& p = body.parent < 0 ? ground_ : s.frames[std::size_t(body.parent)];
      if (body.motions.count == 1 && body.motions.list[0].kind == JointMotion::Kind::turn) {
        detail::carry_by_turn<T>(body, p, qn[body.qn], vn[body.vn], f);
        write(body, f, q, v);
        continue;
      }
      detail::RunnerOf<T> run{p.r, p.v, {0, 0, 0}, p.A, p.w, {0, 0, 0}};
      if (body.from_turned) run.A = product<T>(p.A, body.from.axes);
      run.go(product<T, 1>(p.A, body.from.origin));
      f.angle = p.angle + body.angle;
      f.speeds = 0;
      double const* x = qn.data() + body.qn;
      double const* u = vn.data() + body.vn;
      if (body.backwards) {
        x += body.motions.coordinates();
        u += body.motions.speeds();
        for (int k = body.motions.count; k-- > 0;) {
          JointMotion const& m = body.motions.list[std::size_t(k)];
          detail::move<T>(m, -1.0, x -= m.coordinates(), u -= m.speeds(), run, f);
        }
        detail::reverse_columns<T>(body, f);
      } else {
        for (JointMotion const& m : body.motions) {
          detail::move<T>(m, 1.0, x, u, run, f);
          x += m.coordinates();
          u += m.speeds();
        }
      }
      f.A = body.to_turned ? product<T>(run.A, transposed<T>(body.to.axes)) : run.A;
      run.go(scaled<T>(product<T, 1>(f.A, body.to.origin), -1.0));
      f.r = run.r;
      f.v = run.v;
      f.w = run.w;
      set_pair(run.a, run.alpha, f.bias);
      f.arm = difference<T>(f.r, p.r);
      detail::finish_columns<T>(f);
      write(body, f, q, v);
    }
  }

  /// out = T u, or T u + b with `bias`: whole from narrow, where the parts of roots stand already.
  void expand_rates(TreeState& s, VecX const& u, bool bias, VecX& out) const {
    Sequence<Vec6>& twist = s.twists;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      TreeBody const& body = bodies[i];
      TreeFrame const& f = s.frames[i];
      if (!body.carried()) {
        twist[i] = twist_of(body, f, out);
        continue;
      }
      Vec6& t = twist[i];
      for (int j = 0; j < 6; ++j) t[j] = bias ? f.bias[j] : T(0.0);
      if (body.parent >= 0) add_carried(twist[std::size_t(body.parent)], f.arm, t);
      for (int k = 0; k < f.speeds; ++k) add_column(f, k, u[body.vn + k], t);
      put_twist(body, f, t, out);
    }
  }

  /// The u with T u next to x (whole): exact where x keeps to the joints. Parts of roots are left to the caller. With
  /// `bias`, of x − b.
  void reduce_rates(TreeState& s, VecX const& x, bool bias, VecX& u) const {
    for (std::size_t i = 0; i < bodies.size(); ++i) s.twists[i] = twist_of(bodies[i], s.frames[i], x);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      TreeBody const& body = bodies[i];
      if (!body.carried()) continue;
      TreeFrame const& f = s.frames[i];
      auto carried = detail::zeros<Vec6>();
      if (body.parent >= 0) add_carried(s.twists[std::size_t(body.parent)], f.arm, carried);
      Vec6 t, st;
      for (int j = 0; j < 6; ++j) t[j] = s.twists[i][j] - (bias ? f.bias[j] : T(0.0)) - carried[j];
      for (int k = 0; k < f.speeds; ++k) st[k] = along_column(f, k, t);
      for (int k = 0; k < f.speeds; ++k) {
        double sum = 0.0;
        for (int j = 0; j < f.speeds; ++j) sum += f.inverse(k, j) * st[j];
        u[body.vn + k] = sum;
      }
    }
  }

  /// out = Tᵀ r: narrow from whole. Parts of roots: in r, where the caller reads them. Generalised forces and wrenches
  /// change in the same way as speeds and twists, for A is orthogonal.
  void reduce_forces(TreeState& s, VecX& r, VecX& out) const {
    for (std::size_t i = 0; i < bodies.size(); ++i) s.held[i] = twist_of(bodies[i], s.frames[i], r);
    for (std::size_t i = bodies.size(); i-- > 0;) {
      TreeBody const& body = bodies[i];
      TreeFrame const& f = s.frames[i];
      Vec6 const& w = s.held[i];
      if (!body.carried()) {
        put_twist(body, f, w, r);
        continue;
      }
      for (int k = 0; k < f.speeds; ++k) out[body.vn + k] = along_column(f, k, w);
      if (body.parent >= 0) add_back(w, f.arm, s.held[std::size_t(body.parent)]);
    }
  }

  /// A whole r with Tᵀ r = `given` (narrow); parts of roots stand already.
  void expand_forces(TreeState& s, VecX const& given, VecX& r) const {
    for (std::size_t i = 0; i < bodies.size(); ++i)
      s.held[i] = bodies[i].carried() ? detail::zeros<Vec6>() : twist_of(bodies[i], s.frames[i], r);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      TreeBody const& body = bodies[i];
      if (!body.carried()) continue;
      TreeFrame const& f = s.frames[i];
      auto w = detail::zeros<Vec6>(), carried = w;
      for (int k = 0; k < f.speeds; ++k) {
        double sum = 0.0;
        for (int j = 0; j < f.speeds; ++j) sum += f.inverse(k, j) * given[body.vn + j];
        add_column(f, k, sum, w);
      }
      for (int j = 0; j < 6; ++j) s.held[i][j] += w[j];
      if (body.parent < 0) continue;
      add_back(w, f.arm, carried);
      for (int j = 0; j < 6; ++j) s.held[std::size_t(body.parent)][j] -= carried[j];
    }
    for (std::size_t i = 0; i < bodies.size(); ++i) put_twist(bodies[i], s.frames[i], s.held[i], r);
  }

  /// Joint coordinates from whole ones.
  void read_coordinates(VecX const& q, VecX const& v, TreeState& s, VecX& qn) const {
    for (std::size_t i = 0; i < bodies.size(); ++i) read(bodies[i], q, v, s.frames[i]);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      TreeBody const& body = bodies[i];
      if (!body.carried()) continue;
      TreeFrame const& f = s.frames[i];
      TreeFrame const& p = body.parent < 0 ? ground_ : s.frames[std::size_t(body.parent)];
      Vec3 ra = point(p, body.from.origin), rb = point(f, body.to.origin);
      Mat3 a = product<T>(p.A, body.from.axes), b = product<T>(f.A, body.to.axes);
      double angle = f.angle - p.angle - body.angle;
      if (body.backwards) {
        std::swap(ra, rb);
        std::swap(a, b);
        angle = -angle;
      }
      Vec3 const d = transposed_product<T, 3, 1>(a, difference<T>(rb, ra));
      Mat3 turned = transposed_product<T>(a, b);
      double* x = qn.data() + body.qn;
      for (int k = 0; k < body.motions.count; ++k) {
        JointMotion const& m = body.motions.list[std::size_t(k)];
        switch (m.kind) {
          case JointMotion::Kind::slide:
            *x = d[m.axis];
            break;
          case JointMotion::Kind::turn:
            *x = body.layout == RigidLayout::plane
                     ? angle * a(2, m.axis)
                     : detail::first_turn<T>(m.axis, turned, k + 1 < body.motions.count, body.motions, k);
            turned = product<T>(detail::turn_about<T>(m.axis, -*x), turned);
            break;
          case JointMotion::Kind::screw: {  // the slide counts the turns
            double const rest = detail::first_turn<T>(m.axis, turned, false, body.motions, k),
                         full = 2.0 * std::numbers::pi;
            *x = rest + full * std::round((d[m.axis] / m.pitch - rest) / full);
            break;
          }
          case JointMotion::Kind::ball: {
            Quaternion<T> const p4 = quaternion_of(turned);
            for (int j = 0; j < 4; ++j) x[j] = p4[j];
          }
        }
        x += m.coordinates();
      }
    }
  }

  /// out = q ⊞ δ of the joint coordinates.
  void plus(VecX const& q, VecX const& delta, VecX& out) const {
    for_each_motion([&](JointMotion const& m, Index qn, Index vn) {
      if (m.kind != JointMotion::Kind::ball) {
        out[qn] = q[qn] + delta[vn];
        return;
      }
      Quaternion<T> const turned =
          quaternion_plus<T>({q[qn], q[qn + 1], q[qn + 2], q[qn + 3]}, {delta[vn], delta[vn + 1], delta[vn + 2]});
      for (int i = 0; i < 4; ++i) out[qn + i] = turned[i];
    });
  }
  /// The rate of δ in q ⊞ δ.
  void local_rate(VecX const& delta, VecX const& v, VecX& out) const {
    for_each_motion([&](JointMotion const& m, Index, Index vn) {
      if (m.kind != JointMotion::Kind::ball) {
        out[vn] = v[vn];
        return;
      }
      Vec3 const rate = product<T, 1>(right_jacobian_inverse<T>({delta[vn], delta[vn + 1], delta[vn + 2]}),
                                      Vec3(v[vn], v[vn + 1], v[vn + 2]));
      for (int i = 0; i < 3; ++i) out[vn + i] = rate[i];
    });
  }

  /// q˙ of the joint coordinates; that of a ball is ½ q ∘ (0, Ω).
  void coordinate_rates(VecX const& q, VecX const& v, VecX& rate) const {
    for_each_motion([&](JointMotion const& m, Index qn, Index vn) {
      if (m.kind != JointMotion::Kind::ball) {
        rate[qn] = v[vn];
        return;
      }
      Quaternion<T> const moved =
          quaternion_product<T>({q[qn], q[qn + 1], q[qn + 2], q[qn + 3]}, {0.0, v[vn], v[vn + 1], v[vn + 2]});
      for (int i = 0; i < 4; ++i) rate[qn + i] = 0.5 * moved[i];
    });
  }

  TreeState state() const {
    return {Sequence<TreeFrame>(bodies.size()), Sequence<Vec6>(bodies.size()), Sequence<Vec6>(bodies.size())};
  }

  /// [v; ω] of a whole vector of speeds or accelerations in world axes.
  static Vec6 twist_of(TreeBody const& body, TreeFrame const& f, VecX const& x) {
    auto t = detail::zeros<Vec6>();
    if (body.layout == RigidLayout::plane) {
      t[0] = x[body.v0];
      t[1] = x[body.v0 + 1];
      t[5] = x[body.v0 + 2];
    } else {
      set_pair(triple(x, body.v0), product<T, 1>(f.A, triple(x, body.v0 + 3)), t);
    }
    return t;
  }
  static void put_twist(TreeBody const& body, TreeFrame const& f, Vec6 const& t, VecX& x) {
    bool const plane = body.layout == RigidLayout::plane;
    for (int i = 0; i < 3; ++i) x[body.v0 + i] = t[plane && i == 2 ? 5 : i];
    if (plane) return;
    Vec3 const spin = transposed_product<T, 3, 1>(f.A, Vec3(t[3], t[4], t[5]));
    for (int i = 0; i < 3; ++i) x[body.v0 + 3 + i] = spin[i];
  }
  /// t += the rigid motion of the parent at a body `arm` away.
  static void add_carried(Vec6 const& parent, Vec3 const& arm, Vec6& t) {
    Vec3 const rate = cross<T>({parent[3], parent[4], parent[5]}, arm);
    for (int i = 0; i < 6; ++i) t[i] += parent[i];
    for (int i = 0; i < 3; ++i) t[i] += rate[i];
  }
  /// parent += a wrench of the body, `arm` away.
  static void add_back(Vec6 const& w, Vec3 const& arm, Vec6& parent) {
    Vec3 const moment = cross<T>(arm, {w[0], w[1], w[2]});
    for (int i = 0; i < 6; ++i) parent[i] += w[i];
    for (int i = 0; i < 3; ++i) parent[3 + i] += moment[i];
  }

 private:
  static Vec3 triple(VecX const& x, Index first) { return {x[first], x[first + 1], x[first + 2]}; }
  static void set_pair(Vec3 const& a, Vec3 const& b, Vec6& out) {
    for (int i = 0; i < 3; ++i) {
      out[i] = a[i];
      out[3 + i] = b[i];
    }
  }
  static Vec3 point(TreeFrame const& f, Vec3 const& u) {
    Vec3 r = product<T, 1>(f.A, u);
    for (int i = 0; i < 3; ++i) r[i] += f.r[i];
    return r;
  }
  static void add_column(TreeFrame const& f, int k, double factor, Vec6& t) {
    for (int i = 0; i < 6; ++i) t[i] += f.s(i, k) * factor;
  }
  static double along_column(TreeFrame const& f, int k, Vec6 const& t) {
    double sum = 0.0;
    for (int i = 0; i < 6; ++i) sum += f.s(i, k) * t[i];
    return sum;
  }

  static void read(TreeBody const& body, VecX const& q, VecX const& v, TreeFrame& f) {
    if (body.layout == RigidLayout::plane) {
      f.r = {q[body.q0], q[body.q0 + 1], 0.0};
      f.angle = q[body.q0 + 2];
      f.A = detail::turn_about<T>(2, f.angle);
    } else {
      f.r = triple(q, body.q0);
      f.A = rotation_matrix<T>({q[body.q0 + 3], q[body.q0 + 4], q[body.q0 + 5], q[body.q0 + 6]});
    }
    Vec6 const t = twist_of(body, f, v);
    f.v = {t[0], t[1], t[2]};
    f.w = {t[3], t[4], t[5]};
  }
  static void write(TreeBody const& body, TreeFrame const& f, VecX& q, VecX& v) {
    bool const plane = body.layout == RigidLayout::plane;
    for (int i = 0; i < 3; ++i) q[body.q0 + i] = plane && i == 2 ? f.angle : f.r[i];
    if (!plane) {
      Quaternion<T> const turned = quaternion_of(f.A);
      for (int i = 0; i < 4; ++i) q[body.q0 + 3 + i] = turned[i];
    }
    Vec6 t;
    set_pair(f.v, f.w, t);
    put_twist(body, f, t, v);
  }

  template <class F>
  void for_each_motion(F&& f) const {
    for (TreeBody const& body : bodies) {
      Index q = body.qn, v = body.vn;
      for (JointMotion const& m : body.motions) {
        f(m, q, v);
        q += m.coordinates();
        v += m.speeds();
      }
    }
  }

  TreeFrame ground_ = {};
};

using JointTree = JointTreeOf<>;

}  // namespace polybody
