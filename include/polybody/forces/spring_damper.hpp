#pragma once
#include <polybody/forces/force_element.hpp>

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
    require_not_negative(stiffness, name, ": the spring stiffness");
    require_not_negative(damping, name, ": the damping");
    require_not_negative(free_length, name, ": the free length");
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

}  // namespace polybody
