#pragma once
/// \file
/// A body on a pin: the common case of `JointTree`.

#include <polybody/system/tree_body.hpp>

namespace polybody::detail {

/// A body on a joint of one turn, whole: the common case without a walk through motions. \param x, u the angle and its
/// rate, against the motion where frame b is the parent's
template <class T>
void carry_by_turn(TreeBody const& body, TreeFrameOf<T> const& p, double x, double u, TreeFrameOf<T>& f) {
  int const axis = body.motions.list[0].axis;
  double const sign = body.backwards ? -1.0 : 1.0;
  RunnerOf<T> run{p.r, p.v, {0, 0, 0}, p.A, p.w, {0, 0, 0}};
  run.go(product<T, 1>(p.A, body.from.origin));
  if (body.from_turned) run.A = product<T>(p.A, body.from.axes);
  Vec<T, 3> const n(sign * run.A(0, axis), sign * run.A(1, axis), sign * run.A(2, axis));
  run.turn(scaled<T>(n, u));
  turn_columns<T>(axis, sign * x, run.A);
  f.A = body.to_turned ? product<T>(run.A, transposed<T>(body.to.axes)) : run.A;
  f.angle = p.angle + body.angle + n[2] * x;
  Vec<T, 3> const to_centre = scaled<T>(product<T, 1>(f.A, body.to.origin), -1.0);
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
  f.speeds = 1;
  f.inverse(0, 0) = 1.0 / size;
}

}  // namespace polybody::detail
