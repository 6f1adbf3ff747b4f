#pragma once
/// \file
/// Rigid body on a revolute joint: the most frequent case of `JointTree`, without a loop over the motions of a joint.

#include <polybody/math/quaternion.hpp>
#include <polybody/system/tree_body.hpp>

namespace polybody {

/// Fills in `body.turn` if the joint permits a single rotation only. The signs of the quaternions of body and parent
/// remain those of `reference`, the full coordinates of the reference state. \param parent index of the first
/// coordinate of the parent; −1: the ground
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

/// Computes the frame f of a body on a joint with a single rotation from the frame p of the parent. \param x, u angle
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

}  // namespace polybody
