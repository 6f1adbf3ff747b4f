#pragma once
#include <polybody/forces/force_element.hpp>

namespace polybody {

/// Spring, damper and preload along an axis that is fixed in the first body. With the distance s of marker b from
/// marker a along the axis, the force on b along the axis is −(k s + c ṡ + P); the opposite force acts on a. The
/// element is used for bodies that slide in a guide, such as the tensioner of a track.
struct AxialSpring {
  static constexpr int markers = 2;
  static constexpr bool is_load = false;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr MarkerKind needs_of_second = MarkerKind::point;

  Required<double> stiffness;  ///< k [N/m]
  double damping = 0.0;        ///< c [N s/m]
  double preload = 0.0;        ///< P, force at s = 0 [N]
  Vec3 axis = Vec3::UnitX();   ///< (3) unit vector in the axes of marker a

  template <class = void>  // compiled where it is used
  void check(std::string const& name) const {
    require_not_negative(stiffness, name, ": the spring stiffness");
    require_not_negative(damping, name, ": the damping");
    require_finite(preload, name, ": the preload");
    require_unit(axis, name, ": the axis");
  }

  bool is_lossless() const { return damping == 0.0; }  ///< true without damping

  /// Wrenches, with d = r_b − r_a and the axis e: s = e·d, ṡ = e·(ḋ − ω_a × d). Both forces act at r_b. The moment on
  /// a is therefore d × f_a.
  template <StateScalar T>
  std::array<Wrench<T>, 2> wrenches(std::array<Frame<T>, 2> const& f, double) const {
    Vec<T, 3> const e = direction(f[0]), d = f[1].r - f[0].r, turning = f[0].w.cross(d);
    Vec<T, 3> const v = f[1].v - f[0].v, seen = v - turning;
    T const s = e.dot(d), rate = e.dot(seen);
    T const push = s * stiffness.value + rate * damping + preload;
    std::array<Wrench<T>, 2> w;
    Vec<T, 3> const force(e[0] * push, e[1] * push, e[2] * push);
    w[0].f = force;
    w[0].m = d.cross(force);
    w[1].f = -force;
    return w;
  }
  template <StateScalar T>
  T potential(std::array<Frame<T>, 2> const& f, double) const {
    Vec<T, 3> const d = f[1].r - f[0].r;
    T const s = direction(f[0]).dot(d);
    return s * (s * (0.5 * stiffness) + preload);
  }

 private:
  template <StateScalar T>
  Vec<T, 3> direction(Frame<T> const& f) const {
    Vec<T, 3> e;
    for (int i = 0; i < 3; ++i) e[i] = f.A(i, 0) * axis[0] + f.A(i, 1) * axis[1] + f.A(i, 2) * axis[2];
    return e;
  }
};

}  // namespace polybody
