#pragma once
#include <polybody/joints/rows.hpp>

namespace polybody {

/// Pin that slides: b turns about and slides along the axis fixed in a, 4 rows
///   g = [a₁·d; a₂·d; a₁·b₃; a₂·b₃],  d = r_b − r_a      [Haug 1989, §9.4].
struct Cylindrical {
  static constexpr char const* name = "Cylindrical";
  static constexpr int rows = 4;
  static constexpr Observes needs = Observes::frame;
  static constexpr Observes needs_of_second = Observes::axis;
  static constexpr World world = World::space;
  static constexpr Freedoms free = {false, false, true, false, false, true};

  Vec3 axis = Vec3::UnitZ();  ///< (3) unit vector of the slide and the turn, world axes at the reference configuration

  Mat3 triad() const { return polybody::rows::triad_about(axis, "Cylindrical: the axis"); }

  template <StateScalar T>
  Gap<4, T> gap(Frame<T> const& a, Frame<T> const& b, double) const {
    Gap<4, T> gap;
    polybody::rows::on_axis(a, b, gap, 0);
    polybody::rows::same_direction(a, b, gap, 2);
    return gap;
  }
  template <StateScalar T>
  Vec<T, 4> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    Vec<T, 4> gamma;
    gamma << polybody::rows::on_axis_gamma(a, b), polybody::rows::same_direction_gamma(a, b);
    return gamma;
  }
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b,
                                      Vec<double, 4> const& lambda) const {
    Mat<double, 12, 12> k = Mat<double, 12, 12>::Zero();
    polybody::rows::on_axis_gradient(a, b, lambda.head<2>(), k);
    polybody::rows::same_direction_gradient(a, b, lambda.tail<2>(), k);
    return k;
  }
};

static_assert(JointGeometry<Cylindrical>);

}  // namespace polybody
