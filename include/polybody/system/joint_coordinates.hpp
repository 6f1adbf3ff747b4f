#pragma once
/// \file
/// Joint coordinates of a `JointTree`: computation from full coordinates, increments (⊞) and rates. A carried body has
/// the coordinates of its joint's motions, followed by those of its deformation.

#include <polybody/system/joint_tree.hpp>

namespace polybody {
namespace detail {

/// Calls f(motion, q, v) for each joint motion with the reduced indices of its first coordinate and velocity.
template <class T, class F>
void for_each_motion(JointTreeOf<T> const& tree, F&& f) {
  for (TreeBody const& body : tree.bodies) {
    Index q = body.qn, v = body.vn;
    for (JointMotion const& m : body.motions) {
      f(m, q, v);
      q += m.coordinates();
      v += m.velocities();
    }
  }
}
/// Calls f(q, v) for each deformation of the carried bodies with the reduced indices of its coordinate and velocity.
template <class T, class F>
void for_each_deformation(JointTreeOf<T> const& tree, F&& f) {
  for (TreeBody const& body : tree.bodies)
    for (Index k = 0; k < body.deformations && body.carried(); ++k)
      f(body.qn + body.motions.coordinates() + k, body.vn + body.motions.velocities() + k);
}

/// Positions (3) and axes (3×3) of frames a and b of a joint in world axes; in the plane also the angle of b relative
/// to a [rad].
template <class T>
struct JointFrames {
  Vec<T, 3> ra, rb;
  Mat<T, 3, 3> a, b;
  T angle;
};
template <class T>
JointFrames<T> joint_frames(JointTreeOf<T> const& tree, TreeBody const& body, VecXOf<T> const& q, VecXOf<T> const& v,
                            TreeStateOf<T>& s, std::size_t i) {
  TreeFrameOf<T> const &f = s.frames[i], &p = tree.parent_of(body, s);
  auto const point = [](TreeFrameOf<T> const& at, Vec<T, 3> const& u) {
    Vec<T, 3> r = product<T, 1>(at.A, u);
    for (int k = 0; k < 3; ++k) r[k] += at.r[k];
    return r;
  };
  JointFrames<T> j{point(p, body.from.origin), point(f, body.to.origin), product<T>(p.A, body.from.axes),
                   product<T>(f.A, body.to.axes), f.angle - p.angle - body.angle};
  auto const bent = [&](Index e, Vec<T, 3>& r, Mat<T, 3, 3>& axes) {
    FloatingEndOf<T> const& end = tree.ends[std::size_t(e)];
    MarkerKinematics<T> const m = place_end<T>(end, q.data() + end.q0, v.data() + end.v0, s);
    r = m.frame.r;
    axes = m.frame.A;
    return end.layout == RigidLayout::plane ? bent_by<T>(end, axes, q[end.q0 + 2]) : T(0.0);
  };
  if (body.from_end >= 0) j.angle -= bent(body.from_end, j.ra, j.a);
  if (body.to_end >= 0) j.angle += bent(body.to_end, j.rb, j.b);
  if (body.backwards) {
    std::swap(j.ra, j.rb);
    std::swap(j.a, j.b);
    j.angle = -j.angle;
  }
  return j;
}

}  // namespace detail

/// Computes the joint coordinates qn from the full coordinates q. \param v full velocities
template <class T>
void read_coordinates(JointTreeOf<T> const& tree, VecXOf<T> const& q, VecXOf<T> const& v, TreeStateOf<T>& s,
                      VecXOf<T>& qn) {
  for (std::size_t i = 0; i < tree.bodies.size(); ++i) detail::read_frame<T>(tree.bodies[i], q, v, s.frames[i]);
  for (std::size_t i = 0; i < tree.bodies.size(); ++i) {
    TreeBody const& body = tree.bodies[i];
    if (!body.carried()) continue;
    detail::JointFrames<T> const j = detail::joint_frames<T>(tree, body, q, v, s, i);
    Vec<T, 3> const d = transposed_product<T, 3, 1>(j.a, difference<T>(j.rb, j.ra));
    Mat<T, 3, 3> turned = transposed_product<T>(j.a, j.b);
    T* x = qn.data() + body.qn;
    for (int k = 0; k < body.motions.count; ++k) {
      JointMotion const& m = body.motions.list[std::size_t(k)];
      switch (m.kind) {
        case JointMotion::Kind::slide:
          *x = d[m.axis];
          break;
        case JointMotion::Kind::turn:
          *x = body.layout == RigidLayout::plane
                   ? j.angle * j.a(2, m.axis)
                   : detail::first_turn<T>(m.axis, turned, k + 1 < body.motions.count, body.motions, k);
          turned = product<T>(detail::turn_about<T>(m.axis, -*x), turned);
          break;
        case JointMotion::Kind::screw: {  // the translation determines the number of full turns
          double const rest = detail::first_turn<T>(m.axis, turned, false, body.motions, k),
                       full = 2.0 * std::numbers::pi;
          *x = rest + full * std::round((d[m.axis] / m.pitch - rest) / full);
          break;
        }
        case JointMotion::Kind::ball: {
          Quaternion<T> const p4 = quaternion_of(turned);
          for (int l = 0; l < 4; ++l) x[l] = p4[l];
        }
      }
      x += m.coordinates();
    }
  }
}

/// out = q ⊞ δ for the joint coordinates.
template <class T>
void plus(JointTreeOf<T> const& tree, VecXOf<T> const& q, VecXOf<T> const& delta, VecXOf<T>& out) {
  detail::for_each_deformation(tree, [&](Index qn, Index vn) { out[qn] = q[qn] + delta[vn]; });
  detail::for_each_motion(tree, [&](JointMotion const& m, Index qn, Index vn) {
    if (m.kind != JointMotion::Kind::ball) {
      out[qn] = q[qn] + delta[vn];
      return;
    }
    set_quaternion_plus<T>(q.data() + qn, delta.data() + vn, out.data() + qn);
  });
}
/// out = rate of δ in q ⊞ δ, while the joint coordinates move with velocities v.
template <class T>
void local_rate(JointTreeOf<T> const& tree, VecXOf<T> const& delta, VecXOf<T> const& v, VecXOf<T>& out) {
  detail::for_each_deformation(tree, [&](Index, Index vn) { out[vn] = v[vn]; });
  detail::for_each_motion(tree, [&](JointMotion const& m, Index, Index vn) {
    if (m.kind != JointMotion::Kind::ball) {
      out[vn] = v[vn];
      return;
    }
    Vec<T, 3> const rate = product<T, 1>(right_jacobian_inverse<T>({delta[vn], delta[vn + 1], delta[vn + 2]}),
                                         Vec<T, 3>(v[vn], v[vn + 1], v[vn + 2]));
    for (int i = 0; i < 3; ++i) out[vn + i] = rate[i];
  });
}

/// `rate` = q˙ of the joint coordinates; for a spherical motion ½ q ∘ (0, Ω).
template <class T>
void coordinate_rates(JointTreeOf<T> const& tree, VecXOf<T> const& q, VecXOf<T> const& v, VecXOf<T>& rate) {
  detail::for_each_deformation(tree, [&](Index qn, Index vn) { rate[qn] = v[vn]; });
  detail::for_each_motion(tree, [&](JointMotion const& m, Index qn, Index vn) {
    if (m.kind != JointMotion::Kind::ball) {
      rate[qn] = v[vn];
      return;
    }
    Quaternion<T> const moved =
        quaternion_product<T>({q[qn], q[qn + 1], q[qn + 2], q[qn + 3]}, {0.0, v[vn], v[vn + 1], v[vn + 2]});
    for (int i = 0; i < 4; ++i) rate[qn + i] = 0.5 * moved[i];
  });
}

}  // namespace polybody
