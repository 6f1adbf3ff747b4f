#pragma once
/// \file
/// Springs and dampers between two markers: along the line between them, along the axes of a marker, and Maxwell
/// elements.
/// Theory: Eqs. 3.8 to 3.12.

#include <polybody/forces/force_element.hpp>
#include <polybody/forces/force_states.hpp>

namespace polybody {

/// Spring and damper along the line between two markers: tension N = k (l − l₀) + c l̇.
struct SpringDamper {
  static constexpr int markers = 2;
  static constexpr bool is_load = false;
  static constexpr MarkerKind needs = MarkerKind::point;

  Required<double> stiffness;    ///< k [N/m]
  double damping = 0.0;          ///< c [N s/m]
  Required<double> free_length;  ///< l₀ [m]

  void check(std::string const& name) const {
    require_not_negative(stiffness, name, ": the spring stiffness", "N/m");
    require_not_negative(damping, name, ": the damping", "N s/m");
    require_not_negative(free_length, name, ": the free length", "m");
  }

  bool is_lossless() const { return damping == 0.0; }  ///< true without damping

  /// Wrenches f_a = N d/l, f_b = −f_a with d = r_b − r_a, l = |d|. If l₀ = 0 and c = 0, the force is smooth at l = 0;
  /// otherwise its direction is undefined at l = 0.
  template <StateScalar T>
  std::array<Wrench<T>, 2> wrenches(std::array<Frame<T>, 2> const& frames, double) const {
    using std::sqrt;
    Vec<T, 3> const d = frames[1].r - frames[0].r, rate = frames[1].v - frames[0].v;
    T pull = T(stiffness.value);
    if (free_length != 0.0 || damping != 0.0) {
      T const l = sqrt(d.dot(d));
      T const tension = (l - T(free_length.value)) * stiffness.value + d.dot(rate) / l * damping;
      pull = tension / l;
    }
    std::array<Wrench<T>, 2> w;
    Vec<T, 3> const f(d[0] * pull, d[1] * pull, d[2] * pull);
    w[0].f = f;
    w[1].f = -f;
    return w;
  }

  template <StateScalar T>
  T potential(std::array<Frame<T>, 2> const& frames, double) const {
    using std::sqrt;
    Vec<T, 3> const d = frames[1].r - frames[0].r;
    T const l2 = d.dot(d);
    if (free_length == 0.0) return l2 * (0.5 * stiffness);
    T const x = sqrt(l2) - T(free_length.value);
    return x * x * (0.5 * stiffness);
  }
};

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
  double preload = 0.0;        ///< P [N]: at s = 0 the force on b is −P along the axis
  Vec3 axis = Vec3::UnitX();   ///< (3) unit vector in the axes of marker a

  template <class = void>  // compiled where it is used
  void check(std::string const& name) const {
    require_not_negative(stiffness, name, ": the spring stiffness", "N/m");
    require_not_negative(damping, name, ": the damping", "N s/m");
    require_finite(preload, name, ": the preload", "N");
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

/// Spring and damper in series along the line between two markers: tension N = k (l − l₀ − z) with the elongation z of
/// the damper, ż = N/c. At constant length the tension relaxes as e^{−kt/c} [Maxwell 1867].
struct MaxwellElement {
  static constexpr int markers = 2, states = 1;  ///< two markers; one state, the elongation z of the damper [m]
  static constexpr bool is_load = false;
  static constexpr MarkerKind needs = MarkerKind::point;

  Required<double> stiffness;    ///< k [N/m]
  Required<double> damping;      ///< c [N s/m]
  Required<double> free_length;  ///< l₀ [m]

  void check(std::string const& name) const {
    require_positive(stiffness, name, ": the spring stiffness", "N/m");
    require_positive(damping, name, ": the damping", "N s/m");
    require_not_negative(free_length, name, ": the free length", "m");
  }

  /// Wrenches f_a = N d/l with d = r_b − r_a, l = |d|. The direction is undefined at l = 0.
  template <StateScalar T>
  std::array<Wrench<T>, 2> wrenches(std::array<Frame<T>, 2> const& frames, std::array<T, 1> const& z, double) const {
    Vec<T, 3> const d = frames[1].r - frames[0].r;
    T const l = length(d), pull = tension(l, z[0]) / l;
    std::array<Wrench<T>, 2> w;
    for (int i = 0; i < 3; ++i) {
      w[0].f[i] = d[i] * pull;
      w[1].f[i] = -w[0].f[i];
    }
    return w;
  }
  template <StateScalar T>
  std::array<T, 1> rates(std::array<Frame<T>, 2> const& frames, std::array<T, 1> const& z, double) const {
    Vec<T, 3> const d = frames[1].r - frames[0].r;
    return {tension(length(d), z[0]) / damping.value};
  }
  /// Energy of the spring, ½ k (l − l₀ − z)² [J].
  double potential(std::array<Frame<double>, 2> const& frames, std::array<double, 1> const& z, double) const {
    double const pull = tension(length<double>(frames[1].r - frames[0].r), z[0]);
    return 0.5 * pull * pull / stiffness;
  }
  /// Power lost in the damper, N²/c [W].
  double dissipation(std::array<Frame<double>, 2> const& frames, std::array<double, 1> const& z, double) const {
    double const pull = tension(length<double>(frames[1].r - frames[0].r), z[0]);
    return pull * pull / damping;
  }

 private:
  template <StateScalar T>
  static T length(Vec<T, 3> const& d) {
    using std::sqrt;
    return sqrt(d.dot(d));
  }
  template <StateScalar T>
  T tension(T const& l, T const& z) const {
    return (l - z - free_length.value) * stiffness.value;
  }
};

}  // namespace polybody
