#pragma once
#include <polybody/joints/constraint_functions.hpp>

namespace polybody::planar {

/// Prismatic joint in the plane: b slides along the direction fixed in a without rotation. 2 constraint equations
///   g = [a₂·d; a₂·b₁],  d = r_b − r_a, a₁ the direction.
struct Prismatic {
  static constexpr char const* name = "planar::Prismatic";
  static constexpr int rows = 2;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr World world = World::plane;
  static constexpr FreeDirections free = {true};

  Vec3 axis = Vec3::UnitX();  ///< (3) unit vector in the plane, world axes at the reference configuration

  /// \throws InvalidInput unless the direction is a unit vector in the plane.
  template <class = void>  // compiled only if used
  Mat3 triad() const {
    require_unit(axis, "planar::Prismatic: the axis");
    if (std::abs(axis.z()) > 1e-12)
      throw InvalidInput("joint.axis_out_of_plane",
                         {ErrorObject{"planar::Prismatic"},
                          ": the axis must lie in the plane, z = 0, but has z = ", ErrorValue{axis.z()}, "."});
    return polybody::constraint_functions::columns(axis, {-axis[1], axis[0], 0.0}, {0.0, 0.0, 1.0});
  }

  template <StateScalar T>
  ConstraintTerms<2, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    ConstraintTerms<2, T> terms;
    polybody::constraint_functions::no_slide(axis_of(a, 1), a, b, terms, 0);
    polybody::constraint_functions::perpendicular(axis_of(a, 1), axis_of(b, 0), terms, 1);
    return terms;
  }
  template <StateScalar T>
  Vec<T, 2> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    return {polybody::constraint_functions::no_slide_gamma(axis_of(a, 1), a, b),
            polybody::constraint_functions::perpendicular_gamma(axis_of(a, 1), axis_of(b, 0), a, b)};
  }
  template <class = void>  // compiled only if used
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b,
                                      Vec<double, 2> const& lambda) const {
    auto k = detail::zeros<Mat<double, 12, 12>>();
    polybody::constraint_functions::no_slide_gradient(axis_of(a, 1), a, b, lambda[0], k);
    polybody::constraint_functions::perpendicular_gradient(axis_of(a, 1), axis_of(b, 0), lambda[1], k);
    return k;
  }
};

}  // namespace polybody::planar
