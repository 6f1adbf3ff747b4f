#pragma once
#include <polybody/joints/joint_axis.hpp>

namespace polybody {

/// Revolute joint of thesis Eq. 3.8, between two points of the joint axis at a distance L. 5 constraint equations
///   g = [a₁·b₃; a₂·b₃; a₁·d; a₂·d; d·d − k_θ],  d = r_b − r_a,  k_θ = L².
/// The last equation constrains d along the axis. For L = 0 its Jacobian is zero (rank 4), so that L must be positive.
/// The motions are those of a Revolute [thesis §3.5.1]; the force along the axis is 2 L λ₅.
struct RevolutePin {
  static constexpr char const* name = "RevolutePin";
  static constexpr int rows = 5;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr MarkerKind needs_of_second = MarkerKind::axis;
  static constexpr World world = World::space;

  Required<double> distance;  ///< L [m]
  JointAxis axis = {};        ///< (3) unit vector of the joint axis, world axes at the reference configuration

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

  template <StateScalar T>
  ConstraintTerms<5, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    ConstraintTerms<5, T> terms;
    polybody::constraint_functions::same_direction(a, b, terms, 0);
    polybody::constraint_functions::on_axis(a, b, terms, 2);
    Vec<T, 3> const d = b.r - a.r;
    terms.g[4] = d.dot(d) - double(distance) * distance;
    for (int i = 0; i < 3; ++i) {
      terms.Ga(4, i) = d[i] * -2.0;
      terms.Gb(4, i) = d[i] * 2.0;
    }
    return terms;
  }
  template <StateScalar T>
  Vec<T, 5> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    Vec<T, 2> const parallel = polybody::constraint_functions::same_direction_gamma(a, b),
                    on_axis = polybody::constraint_functions::on_axis_gamma(a, b);
    Vec<T, 3> const rate = b.v - a.v;
    return {parallel[0], parallel[1], on_axis[0], on_axis[1], T(rate.dot(rate) * 2.0)};
  }
  template <class = void>  // compiled only if used
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b,
                                      Vec<double, 5> const& lambda) const {
    auto k = detail::zeros<Mat<double, 12, 12>>();
    polybody::constraint_functions::same_direction_gradient(a, b, {lambda[0], lambda[1]}, k);
    polybody::constraint_functions::on_axis_gradient(a, b, {lambda[2], lambda[3]}, k);
    for (int i = 0; i < 3; ++i) {
      k(i, i) += 2.0 * lambda[4];
      k(i, i + 6) -= 2.0 * lambda[4];
      k(i + 6, i) -= 2.0 * lambda[4];
      k(i + 6, i + 6) += 2.0 * lambda[4];
    }
    return k;
  }
};

}  // namespace polybody
