#pragma once
#include <polybody/joints/rows.hpp>

namespace polybody::planar {

/// Slider in the plane: b slides along the direction fixed in a and does not turn, 2 rows
///   g = [a₂·d; a₂·b₁],  d = r_b − r_a, a₁ the direction.
struct Prismatic {
  static constexpr char const* name = "planar::Prismatic";
  static constexpr int rows = 2;
  static constexpr Observes needs = Observes::frame;
  static constexpr World world = World::plane;
  static constexpr Freedoms free = {true};

  Vec3 axis = Vec3::UnitX();  ///< (3) unit vector in the plane, world axes at the reference configuration

  /// \throws InvalidInput unless the direction is a unit vector in the plane.
  Mat3 triad() const {
    require_unit(axis, "planar::Prismatic: the axis");
    if (std::abs(axis.z()) > 1e-12) throw InvalidInput("planar::Prismatic: the axis must lie in the plane, z = 0.");
    Mat3 e;
    e << axis, Vec3::UnitZ().cross(axis), Vec3::UnitZ();
    return e;
  }

  template <StateScalar T>
  Gap<2, T> gap(Frame<T> const& a, Frame<T> const& b, double) const {
    Gap<2, T> gap;
    polybody::rows::no_slide<2, T>(a.A.col(1), a, b, gap, 0);
    polybody::rows::perpendicular<2, T>(a.A.col(1), b.A.col(0), gap, 1);
    return gap;
  }
  template <StateScalar T>
  Vec<T, 2> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    return {polybody::rows::no_slide_gamma<T>(a.A.col(1), a, b),
            polybody::rows::perpendicular_gamma<T>(a.A.col(1), b.A.col(0), a, b)};
  }
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b,
                                      Vec<double, 2> const& lambda) const {
    Mat<double, 12, 12> k = Mat<double, 12, 12>::Zero();
    polybody::rows::no_slide_gradient(a.A.col(1), a, b, lambda[0], k);
    polybody::rows::perpendicular_gradient(a.A.col(1), b.A.col(0), lambda[1], k);
    return k;
  }
};

static_assert(JointGeometry<Prismatic>);

}  // namespace polybody::planar
