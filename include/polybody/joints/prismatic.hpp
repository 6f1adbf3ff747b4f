#pragma once
#include <polybody/joints/joint_axis.hpp>

namespace polybody {

/// Prismatic joint in space: b slides along the axis fixed in a without rotation. 5 constraint equations
///   g = [a₁·d; a₂·d; a₁·b₂; a₂·b₃; a₃·b₁],  d = r_b − r_a.
struct Prismatic {
  static constexpr char const* name = "Prismatic";
  static constexpr int rows = 5;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr World world = World::space;
  static constexpr FreeDirections free = {false, false, true};

  JointAxis axis = {};  ///< (3) unit vector of the translation, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(axis, "Prismatic: the axis");
  }

  template <StateScalar T>
  ConstraintTerms<5, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    ConstraintTerms<5, T> terms;
    polybody::constraint_functions::no_slide(axis_of(a, 0), a, b, terms, 0);
    polybody::constraint_functions::no_slide(axis_of(a, 1), a, b, terms, 1);
    polybody::constraint_functions::parallel(a, b, terms, 2);
    return terms;
  }
  template <StateScalar T>
  Vec<T, 5> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    Vec<T, 2> const on_axis = polybody::constraint_functions::on_axis_gamma(a, b);
    Vec<T, 3> const parallel = polybody::constraint_functions::parallel_gamma(a, b);
    return {on_axis[0], on_axis[1], parallel[0], parallel[1], parallel[2]};
  }
  template <class = void>  // compiled only if used
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b,
                                      Vec<double, 5> const& lambda) const {
    auto k = detail::zeros<Mat<double, 12, 12>>();
    polybody::constraint_functions::no_slide_gradient(axis_of(a, 0), a, b, lambda[0], k);
    polybody::constraint_functions::no_slide_gradient(axis_of(a, 1), a, b, lambda[1], k);
    polybody::constraint_functions::parallel_gradient(a, b, {lambda[2], lambda[3], lambda[4]}, k);
    return k;
  }
};

}  // namespace polybody
