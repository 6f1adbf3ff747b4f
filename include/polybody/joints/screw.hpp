#pragma once
#include <polybody/joints/angle.hpp>
#include <polybody/joints/joint_axis.hpp>
#include <polybody/joints/joint_motion.hpp>

namespace polybody {

/// Nut b on the thread of a: a cylindrical joint whose translation is p times its rotation. 5 constraint equations
///   g = [a₁·d; a₂·d; a₁·b₃; a₂·b₃; a₃·d − p θ],  d = r_b − r_a      [Haug 1989, §9.4].
/// θ is zero at the reference configuration if d is zero. The translation determines the number of full turns, which is
/// not limited.
struct Screw {
  static constexpr char const* name = "Screw";
  static constexpr int rows = 5;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr World world = World::space;

  Required<double> pitch;  ///< p, translation per radian [m/rad]: the lead over 2π; negative for a left-handed thread
  JointAxis axis = {};     ///< (3) unit vector, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(axis, "Screw: the axis");
  }
  JointMotions motions() const { return {.list = {JointMotion{JointMotion::Kind::screw, 2, pitch}}, .count = 1}; }
  void check(std::string const& what) const {
    if (!std::isfinite(pitch) || pitch == 0.0)
      throw InvalidInput("screw.pitch", {ErrorObject{what}, ": the pitch must be finite and not zero, but is ",
                                         ErrorValue{pitch}, " m. A screw without pitch is a Revolute."});
  }

  template <StateScalar T>
  ConstraintTerms<5, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    ConstraintTerms<5, T> terms;
    polybody::constraint_functions::on_axis(a, b, terms, 0);
    polybody::constraint_functions::same_direction(a, b, terms, 2);
    polybody::constraint_functions::slide_and_turn(axis_of(a, 2), pitch, a, b, terms, 4);
    return terms;
  }
  template <StateScalar T>
  Vec<T, 5> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    Vec<T, 2> const on_axis = polybody::constraint_functions::on_axis_gamma(a, b),
                    parallel = polybody::constraint_functions::same_direction_gamma(a, b);
    return {on_axis[0], on_axis[1], parallel[0], parallel[1],
            polybody::constraint_functions::slide_and_turn_gamma<T>(axis_of(a, 2), pitch, a, b)};
  }
  template <class = void>  // compiled only if used
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b,
                                      Vec<double, 5> const& lambda) const {
    auto k = detail::zeros<Mat<double, 12, 12>>();
    polybody::constraint_functions::on_axis_gradient(a, b, {lambda[0], lambda[1]}, k);
    polybody::constraint_functions::same_direction_gradient(a, b, {lambda[2], lambda[3]}, k);
    polybody::constraint_functions::slide_and_turn_gradient(axis_of(a, 2), pitch, a, b, lambda[4], k);
    return k;
  }
};

}  // namespace polybody
