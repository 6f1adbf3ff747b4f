#pragma once
/// \file
/// Rigid bodies that carry one another through joint coordinates [thesis Eq. 3.4–3.5; Shabana 2020, §3]: a body's pose
/// is its parent's followed by the joint's motions, and with D the arm from the parent's centre of mass to its own,
///   ω = ω_p + S_ω u,   ṙ = ṙ_p + ω_p × D + S_r u,
///   ω˙ = ω˙_p + S_ω u̇ + b_ω,   r̈ = r̈_p + ω˙_p × D + S_r u̇ + b_r,
/// all in world axes; b is what is left for u̇ = 0 and a parent without accelerations. Whole vectors hold every body,
/// narrow ones the joints. Everything is one walk from the roots to the tips or back.

#include <numbers>

#include <polybody/math/quaternion.hpp>
#include <polybody/system/tree_body.hpp>

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
      detail::RunnerOf<T> run{p.r, p.v, Vec3::Zero(), p.A, p.w, Vec3::Zero()};
      run.go(p.A * body.from.origin);
      run.A = p.A * body.from.axes;
      f.angle = p.angle + body.angle;
      f.speeds = 0;
      double const* x = qn.data() + body.qn;
      double const* u = vn.data() + body.vn;
      if (body.backwards) {
        x += body.motions.coordinates();
        u += body.motions.speeds();
        for (int k = body.motions.count; k-- > 0;) {
          JointMotion const& m = body.motions.list[std::size_t(k)];
          move(m, -1.0, x -= m.coordinates(), u -= m.speeds(), run, f);
        }
        reverse_columns(body, f);
      } else {
        for (JointMotion const& m : body.motions) {
          move(m, 1.0, x, u, run, f);
          x += m.coordinates();
          u += m.speeds();
        }
      }
      f.A = run.A * body.to.axes.transpose();
      run.go(-(f.A * body.to.origin));
      f.r = run.r;
      f.v = run.v;
      f.w = run.w;
      f.bias << run.a, run.alpha;
      f.arm = f.r - p.r;
      finish_columns(f);
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
      t = bias ? f.bias : Vec6(Vec6::Zero());
      if (body.parent >= 0) add_carried(twist[std::size_t(body.parent)], f.arm, t);
      for (int k = 0; k < f.speeds; ++k) t += f.s.col(k) * u[body.vn + k];
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
      Vec6 t = s.twists[i];
      if (bias) t -= f.bias;
      if (body.parent >= 0) {
        Vec6 carried = Vec6::Zero();
        add_carried(s.twists[std::size_t(body.parent)], f.arm, carried);
        t -= carried;
      }
      Vec6 const st = f.s.transpose() * t;
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
      for (int k = 0; k < f.speeds; ++k) out[body.vn + k] = f.s.col(k).dot(w);
      if (body.parent >= 0) add_back(w, f.arm, s.held[std::size_t(body.parent)]);
    }
  }

  /// A whole r with Tᵀ r = `given` (narrow); parts of roots stand already.
  void expand_forces(TreeState& s, VecX const& given, VecX& r) const {
    for (std::size_t i = 0; i < bodies.size(); ++i)
      s.held[i] = bodies[i].carried() ? Vec6(Vec6::Zero()) : twist_of(bodies[i], s.frames[i], r);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      TreeBody const& body = bodies[i];
      if (!body.carried()) continue;
      TreeFrame const& f = s.frames[i];
      Vec6 w = Vec6::Zero();
      for (int k = 0; k < f.speeds; ++k) {
        double sum = 0.0;
        for (int j = 0; j < f.speeds; ++j) sum += f.inverse(k, j) * given[body.vn + j];
        w += f.s.col(k) * sum;
      }
      s.held[i] += w;
      if (body.parent < 0) continue;
      Vec6 carried = Vec6::Zero();
      add_back(w, f.arm, carried);
      s.held[std::size_t(body.parent)] -= carried;
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
      Vec3 ra = p.r + p.A * body.from.origin, rb = f.r + f.A * body.to.origin;
      Mat3 a = p.A * body.from.axes, b = f.A * body.to.axes;
      double angle = f.angle - p.angle - body.angle;
      if (body.backwards) {
        std::swap(ra, rb);
        std::swap(a, b);
        angle = -angle;
      }
      Vec3 const d = a.transpose() * (rb - ra);
      Mat3 turned = a.transpose() * b;
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
            turned = detail::turn_about<T>(m.axis, -*x) * turned;
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
      if (m.kind == JointMotion::Kind::ball)
        out.template segment<4>(qn) = quaternion_plus<T>(q.template segment<4>(qn), delta.template segment<3>(vn));
      else
        out[qn] = q[qn] + delta[vn];
    });
  }
  /// The rate of δ in q ⊞ δ.
  void local_rate(VecX const& delta, VecX const& v, VecX& out) const {
    for_each_motion([&](JointMotion const& m, Index, Index vn) {
      if (m.kind == JointMotion::Kind::ball)
        out.template segment<3>(vn) =
            right_jacobian_inverse<T>(delta.template segment<3>(vn)) * v.template segment<3>(vn);
      else
        out[vn] = v[vn];
    });
  }

  /// q˙ of the joint coordinates.
  template <class D = Dual<1>>  // compiled where it is used
  void coordinate_rates(VecX const& q, VecX const& v, VecX& rate) const {
    for_each_motion([&](JointMotion const& m, Index qn, Index vn) {
      if (m.kind != JointMotion::Kind::ball) {
        rate[qn] = v[vn];
        return;
      }
      Quaternion<D> p;
      Vec<D, 3> turn;
      for (int i = 0; i < 4; ++i) p[i] = D(q[qn + i]);
      for (int i = 0; i < 3; ++i) {
        turn[i] = D(0.0);
        turn[i].d[0] = v[vn + i];
      }
      Quaternion<D> const moved = quaternion_plus<D>(p, turn);
      for (int i = 0; i < 4; ++i) rate[qn + i] = moved[i].d[0];
    });
  }

  TreeState state() const {
    return {Sequence<TreeFrame>(bodies.size()), Sequence<Vec6>(bodies.size()), Sequence<Vec6>(bodies.size())};
  }

  /// [v; ω] of a whole vector of speeds or accelerations in world axes.
  static Vec6 twist_of(TreeBody const& body, TreeFrame const& f, VecX const& x) {
    Vec6 t = Vec6::Zero();
    if (body.layout == RigidLayout::plane) {
      t[0] = x[body.v0];
      t[1] = x[body.v0 + 1];
      t[5] = x[body.v0 + 2];
    } else {
      t.template head<3>() = x.template segment<3>(body.v0);
      t.template tail<3>() = f.A * x.template segment<3>(body.v0 + 3);
    }
    return t;
  }
  static void put_twist(TreeBody const& body, TreeFrame const& f, Vec6 const& t, VecX& x) {
    if (body.layout == RigidLayout::plane) {
      x.template segment<3>(body.v0) << t[0], t[1], t[5];
    } else {
      x.template segment<3>(body.v0) = t.template head<3>();
      x.template segment<3>(body.v0 + 3) = f.A.transpose() * t.template tail<3>();
    }
  }
  /// t += the rigid motion of the parent at a body `arm` away.
  static void add_carried(Vec6 const& parent, Vec3 const& arm, Vec6& t) {
    Vec3 const w = parent.template tail<3>();
    t.template head<3>() += parent.template head<3>() + w.cross(arm);
    t.template tail<3>() += w;
  }
  /// parent += a wrench of the body, `arm` away.
  static void add_back(Vec6 const& w, Vec3 const& arm, Vec6& parent) {
    Vec3 const f = w.template head<3>();
    parent.template head<3>() += f;
    parent.template tail<3>() += w.template tail<3>() + arm.cross(f);
  }

 private:
  static void read(TreeBody const& body, VecX const& q, VecX const& v, TreeFrame& f) {
    if (body.layout == RigidLayout::plane) {
      f.r << q[body.q0], q[body.q0 + 1], 0.0;
      f.angle = q[body.q0 + 2];
      f.A = detail::turn_about<T>(2, f.angle);
    } else {
      f.r = q.template segment<3>(body.q0);
      f.A = rotation_matrix<T>(q.template segment<4>(body.q0 + 3));
    }
    Vec6 const t = twist_of(body, f, v);
    f.v = t.template head<3>();
    f.w = t.template tail<3>();
  }
  static void write(TreeBody const& body, TreeFrame const& f, VecX& q, VecX& v) {
    if (body.layout == RigidLayout::plane) {
      q.template segment<3>(body.q0) << f.r[0], f.r[1], f.angle;
    } else {
      q.template segment<3>(body.q0) = f.r;
      q.template segment<4>(body.q0 + 3) = quaternion_of(f.A);
    }
    Vec6 t;
    t << f.v, f.w;
    put_twist(body, f, t, v);
  }

  /// One motion; its columns as [moment arm's origin; axis] until `finish_columns` knows where the body's centre comes
  /// to lie.
  static void move(JointMotion const& m, double sign, double const* x, double const* u, detail::RunnerOf<T>& run,
                   TreeFrame& f) {
    Vec3 const n = sign * run.A.col(m.axis);
    auto const column = [&](Vec3 const& slide, Vec3 const& turn) {
      f.s.col(f.speeds) << slide + run.r.cross(turn), turn;  // at the world's origin
      ++f.speeds;
    };
    switch (m.kind) {
      case JointMotion::Kind::slide:
        column(n, Vec3::Zero());
        run.slide(n, x[0], u[0]);
        break;
      case JointMotion::Kind::turn:
      case JointMotion::Kind::screw:
        column(m.pitch * n, n);
        if (m.kind == JointMotion::Kind::screw) run.slide(n, m.pitch * x[0], m.pitch * u[0]);
        run.turn(u[0] * n);
        run.A = run.A * detail::turn_about<T>(m.axis, sign * x[0]);
        f.angle += n[2] * x[0];  // in the plane the axis is the normal, this way or that
        break;
      case JointMotion::Kind::ball: {
        Mat3 const turned = rotation_matrix<T>(Quaternion<T>(x[0], x[1], x[2], x[3]));
        Mat3 const b = sign > 0.0 ? Mat3(run.A * turned) : run.A;  // the axes of frame b
        for (int k = 0; k < 3; ++k) column(Vec3::Zero(), sign * b.col(k));
        run.turn(sign * (b.col(0) * u[0] + b.col(1) * u[1] + b.col(2) * u[2]));
        run.A = sign > 0.0 ? b : Mat3(run.A * turned.transpose());
      }
    }
  }
  /// JointMotions were gone through from the last: columns into the order of the coordinates.
  static void reverse_columns(TreeBody const& body, TreeFrame& f) {
    Mat6 const back = f.s;
    int to = 0, end = f.speeds;
    for (JointMotion const& m : body.motions) {
      end -= m.speeds();
      for (int k = 0; k < m.speeds(); ++k) f.s.col(to++) = back.col(end + k);
    }
  }
  /// From the world's origin to the centre of mass; and (SᵀS)⁻¹.
  static void finish_columns(TreeFrame& f) {
    for (int k = 0; k < f.speeds; ++k) {
      Vec3 const turn = f.s.col(k).template tail<3>();
      f.s.col(k).template head<3>() += turn.cross(f.r);
    }
    for (int i = 0; i < f.speeds; ++i)
      for (int j = 0; j < f.speeds; ++j) f.inverse(i, j) = f.s.col(i).dot(f.s.col(j));
    invert_leading(f.inverse, f.speeds);
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
