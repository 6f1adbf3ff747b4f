#pragma once
#include <polybody/joints/joint_axis.hpp>

namespace polybody {

/// Pin in space: two points stay together and the axis stays parallel, 5 rows
///   g = [r_b − r_a; a₁·b₃; a₂·b₃]   [thesis §3.5.1, the special case of the spherical joint].
/// The second marker may be a cable's, which knows its tangent only, when the pin is along the tangent: a clamp.
struct Revolute {
  static constexpr char const* name = "Revolute";
  static constexpr int rows = 5;
  static constexpr Observes needs = Observes::frame;
  static constexpr Observes needs_of_second = Observes::axis;
  static constexpr World world = World::space;
  static constexpr bool opposite_ends = true;
  static constexpr Freedoms free = {false, false, false, false, false, true};

  JointAxis axis = {};  ///< (3) unit vector of the pin, world axes at the reference configuration

  template <class = void>  // compiled where it is used
  Mat3 triad() const {
    return polybody::rows::triad_about(axis, "Revolute: the axis");
  }

  template <StateScalar T>
  Gap<5, T> gap(Frame<T> const& a, Frame<T> const& b, double) const {
    Gap<5, T> gap;
    polybody::rows::coincident(a, b, gap);
    polybody::rows::perpendicular(axis_of(a, 0), axis_of(b, 2), gap, 3);
    polybody::rows::perpendicular(axis_of(a, 1), axis_of(b, 2), gap, 4);
    return gap;
  }
  template <StateScalar T>
  Vec<T, 5> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    Vec<T, 5> gamma = detail::zeros<Vec<T, 5>>();
    gamma[3] = polybody::rows::perpendicular_gamma(axis_of(a, 0), axis_of(b, 2), a, b);
    gamma[4] = polybody::rows::perpendicular_gamma(axis_of(a, 1), axis_of(b, 2), a, b);
    return gamma;
  }
  template <class = void>  // compiled where it is used
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b,
                                      Vec<double, 5> const& lambda) const {
    auto k = detail::zeros<Mat<double, 12, 12>>();
    polybody::rows::perpendicular_gradient(axis_of(a, 0), axis_of(b, 2), lambda[3], k);
    polybody::rows::perpendicular_gradient(axis_of(a, 1), axis_of(b, 2), lambda[4], k);
    return k;
  }
};

}  // namespace polybody
