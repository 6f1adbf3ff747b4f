#pragma once
// User-defined force element: the requirements of the concept `polybody::ForceElement`, and a potential.
#include <polybody/polybody.hpp>

namespace own {

using namespace polybody;

/// Two atoms that attract and repel each other: U = 4ε ((σ/r)¹² − (σ/r)⁶), with its minimum at r = 2^⅙ σ
/// [Lennard-Jones 1924].
struct LennardJones {
  static constexpr int markers = 2;
  static constexpr MarkerKind needs = MarkerKind::point;
  static constexpr bool is_load = false;  ///< not scaled by the load factor of `equilibrium`

  Required<double> depth;     ///< ε [J]
  Required<double> diameter;  ///< σ [m]

  /// Called by `apply` with the force's name.
  void check(std::string const& name) const {
    require_positive(depth, name + ": the depth of the well");
    require_positive(diameter, name + ": the diameter");
  }
  /// f_a = U′ d/r = −f_b with d = r_b − r_a; written for any scalar, so that the tangent follows from dual numbers.
  template <StateScalar T>
  std::array<Wrench<T>, 2> wrenches(std::array<Frame<T>, 2> const& frames, double) const {
    Vec<T, 3> const d = frames[1].r - frames[0].r;
    T const r2 = d.dot(d), x = diameter * diameter / r2, x3 = x * x * x;
    T const pull = 24.0 * depth * (x3 - 2.0 * x3 * x3) / r2;
    std::array<Wrench<T>, 2> w;
    w[0].f = d * pull;
    w[1].f = -w[0].f;
    return w;
  }
  /// Optional: with it `energy` includes the force, and the law suite compares both.
  template <StateScalar T>
  T potential(std::array<Frame<T>, 2> const& frames, double) const {
    Vec<T, 3> const d = frames[1].r - frames[0].r;
    T const x = diameter * diameter / d.dot(d), x3 = x * x * x;
    return 4.0 * depth * (x3 * x3 - x3);
  }
};

static_assert(ForceElement<LennardJones> && HasPotential<LennardJones>);

}  // namespace own
