#pragma once
#include <polybody/joints/angle.hpp>
#include <polybody/joints/joint_axis.hpp>

namespace polybody {

/// Pinion b on the rack a, in the plane and in space: a coupled translation and rotation. 1 constraint equation
///   g = a₁·d − R θ,  d = r_b − r_a      [Haug 1989, §3.4].
/// θ is the rotation of b about a₃; it is zero at the reference configuration if a₁·d is zero. The translation
/// determines the number of full turns. Other joints constrain the pinion's height over the rack and its axis. With a
/// rack on the ground, the pinion is a wheel that rolls.
struct RackAndPinion {
  static constexpr char const* name = "RackAndPinion";
  static constexpr int rows = 1;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr World world = World::both;

  Required<double> radius;   ///< pitch radius R [m]; for R > 0 the rack is on the side of axis × direction
  TurnAxis axis = {};        ///< (3) unit vector of the pinion's axis, world axes at the reference configuration
  JointAxis direction = {};  ///< (3) unit vector along the rack, perpendicular to `axis`

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    require_unit(axis.required("RackAndPinion: the axis"), "RackAndPinion: the axis");
    require_unit(direction.required("RackAndPinion: the direction"), "RackAndPinion: the direction");
    return polybody::constraint_functions::triad_of(direction, axis, "RackAndPinion");
  }
  void check(std::string const& what) const {
    if (!std::isfinite(radius) || radius == 0.0)
      throw InvalidInput(
          "rack_and_pinion.radius",
          {ErrorObject{what}, ": the radius must be finite and not zero, but is ", ErrorValue{radius}, " m."});
  }

  template <StateScalar T>
  ConstraintTerms<1, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    ConstraintTerms<1, T> terms;
    polybody::constraint_functions::slide_and_turn(axis_of(a, 0), radius, a, b, terms, 0);
    return terms;
  }
  template <StateScalar T>
  Vec<T, 1> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    return Vec<T, 1>(polybody::constraint_functions::slide_and_turn_gamma(axis_of(a, 0), radius, a, b));
  }
  template <class = void>  // compiled only if used
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b,
                                      Vec<double, 1> const& lambda) const {
    auto k = detail::zeros<Mat<double, 12, 12>>();
    polybody::constraint_functions::slide_and_turn_gradient(axis_of(a, 0), radius, a, b, lambda[0], k);
    return k;
  }
};

}  // namespace polybody
