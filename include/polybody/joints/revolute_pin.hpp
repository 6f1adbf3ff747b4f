#pragma once
#include <polybody/joints/joint_axis.hpp>

namespace polybody {

/// Two points have the distance L that the member `length` of the geometry contains [m]: d·d − L² = 0.
template <auto length>
struct SquaredDistance {
  static constexpr int rows = 1;
  static constexpr bool opposite_ends = false;
  static constexpr MarkerKind needs = MarkerKind::point, needs_of_second = MarkerKind::point;
  [[gnu::always_inline]] static void write(auto const& geometry, auto const& a, auto const& b, auto& terms, int row) {
    auto const d = (b.r - a.r).eval();
    terms.g[row] = d.dot(d) - double(geometry.*length) * (geometry.*length);
    for (int i = 0; i < 3; ++i) {
      terms.Ga(row, i) = d[i] * -2.0;
      terms.Gb(row, i) = d[i] * 2.0;
    }
  }
  static void gamma(auto const&, auto const& a, auto const& b, auto* out) {
    auto const rate = (b.v - a.v).eval();
    *out = rate.dot(rate) * 2.0;
  }
  static void add_gradient(auto const&, Frame<double> const&, Frame<double> const&, double const* lambda,
                           WrenchGradient& k) {
    for (int i = 0; i < 3; ++i) {
      k(i, i) += 2.0 * *lambda;
      k(i, i + 6) -= 2.0 * *lambda;
      k(i + 6, i) -= 2.0 * *lambda;
      k(i + 6, i + 6) += 2.0 * *lambda;
    }
  }
};

/// Revolute joint of thesis Eq. 3.8, between two points of the joint axis at a distance L. 5 constraint equations
///   g = [a₁·b₃; a₂·b₃; a₁·d; a₂·d; d·d − k_θ],  d = r_b − r_a,  k_θ = L².
/// The last equation constrains d along the axis. For L = 0 its Jacobian is zero (rank 4), so that L must be positive.
/// The motions are those of a Revolute [thesis §3.5.1]; the force along the axis is 2 L λ₅.
struct RevolutePin {
  static constexpr char const* name = "RevolutePin";
  static constexpr World world = World::space;

  Required<double> distance;  ///< L [m]
  JointAxis axis = {};        ///< (3) unit vector of the joint axis, world axes at the reference configuration
  using Equations = EquationList<Perpendicular<0, 2>, Perpendicular<1, 2>, NoTranslation<0>, NoTranslation<1>,
                                 SquaredDistance<&RevolutePin::distance>>;

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(axis, "RevolutePin: the axis");
  }
  void check(std::string const& what) const {
    if (!(distance > 0.0) || !std::isfinite(distance))
      throw InvalidInput(
          "revolute_pin.distance",
          {ErrorObject{what}, ": the distance of its points along the axis must be positive and finite, but is ",
           ErrorValue{distance}, " m. For coincident points use Revolute."});
  }
};

}  // namespace polybody
