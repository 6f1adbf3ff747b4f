#pragma once
#include <polybody/joints/joint_axis.hpp>

namespace polybody {

/// Blade or skate on b that glides on a without motion across the blade, in the plane and in space. 1 nonholonomic
/// equation
///   ġ = b₃·u,  u = ṙ_b − ṙ_a − ω_a × d,  d = r_b − r_a      [Neimark & Fufaev 1972, ch. I].
/// u is the velocity of the point of b relative to a. The blade can reach every position and direction, so that no
/// equation between coordinates exists.
struct KnifeEdge {
  static constexpr char const* name = "KnifeEdge";
  static constexpr int rows = 1;
  static constexpr int nonholonomic_equations = 1;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr World world = World::both;

  JointAxis across = {};  ///< (3) unit vector across the blade, world axes at the reference configuration; moves with b

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(across, "KnifeEdge: the direction across");
  }

  template <StateScalar T>
  ConstraintTerms<1, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    ConstraintTerms<1, T> terms;
    Vec<T, 3> const n = axis_of(b, 2), d = b.r - a.r, c = n.cross(d);
    for (int i = 0; i < 3; ++i) {
      terms.Ga(0, i) = -n[i];
      terms.Ga(0, 3 + i) = c[i];
      terms.Gb(0, i) = n[i];
    }
    return terms;
  }
  /// γ = (ω_b × b₃)·u − b₃·(ω_a × (ṙ_b − ṙ_a)).
  template <StateScalar T>
  Vec<T, 1> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    Vec<T, 3> const n = axis_of(b, 2), d = b.r - a.r, rate = b.v - a.v, wd = a.w.cross(d), u = rate - wd;
    return Vec<T, 1>(b.w.cross(n).dot(u) - n.dot(a.w.cross(rate)));
  }
};

}  // namespace polybody
