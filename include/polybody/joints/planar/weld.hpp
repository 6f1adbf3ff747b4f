#pragma once
#include <polybody/joints/rows.hpp>

namespace polybody::planar {

/// Rigid connection in the plane: points together, no relative turn, 3 rows g = [r_b − r_a; a₂·b₁].
struct Weld {
  static constexpr char const* name = "planar::Weld";
  static constexpr int rows = 3;
  static constexpr Observes needs = Observes::frame;
  static constexpr World world = World::plane;
  static constexpr Freedoms free = {};

  Mat3 triad() const { return Mat3::Identity(); }

  template <StateScalar T>
  Gap<3, T> gap(Frame<T> const& a, Frame<T> const& b, double) const {
    Gap<3, T> gap;
    gap.g.template head<2>() = (b.r - a.r).template head<2>();
    gap.Ga(0, 0) = gap.Ga(1, 1) = T(-1.0);
    gap.Gb(0, 0) = gap.Gb(1, 1) = T(1.0);
    polybody::rows::perpendicular<3, T>(a.A.col(1), b.A.col(0), gap, 2);
    return gap;
  }
  template <StateScalar T>
  Vec<T, 3> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    Vec<T, 3> gamma = Vec<T, 3>::Zero();
    gamma[2] = polybody::rows::perpendicular_gamma<T>(a.A.col(1), b.A.col(0), a, b);
    return gamma;
  }
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b,
                                      Vec<double, 3> const& lambda) const {
    Mat<double, 12, 12> k = Mat<double, 12, 12>::Zero();
    polybody::rows::perpendicular_gradient(a.A.col(1), b.A.col(0), lambda[2], k);
    return k;
  }
};

static_assert(JointGeometry<Weld>);

}  // namespace polybody::planar
