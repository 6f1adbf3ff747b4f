#pragma once
#include <polybody/forces/force_states.hpp>

namespace polybody {

/// Spring and damper in series along the line between two markers: tension N = k (l − l₀ − z) with the elongation z
/// of the damper, z˙ = N/c. At constant length the tension relaxes as e^{−kt/c} [Maxwell 1867].
struct MaxwellElement {
  static constexpr int markers = 2, states = 1;  ///< two markers; one state, the elongation z of the damper [m]
  static constexpr bool is_load = false;
  static constexpr MarkerKind needs = MarkerKind::point;

  Required<double> stiffness;    ///< k [N/m]
  Required<double> damping;      ///< c [N s/m]
  Required<double> free_length;  ///< l₀ [m]

  void check(std::string const& name) const {
    require_positive(stiffness, name, ": the spring stiffness");
    require_positive(damping, name, ": the damping");
    require_not_negative(free_length, name, ": the free length");
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
