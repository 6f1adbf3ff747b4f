#pragma once
// User-defined joint geometry: the requirements of the concept `polybody::JointGeometry`, with constraint functions
// of the library.
#include <polybody/polybody.hpp>

namespace own {

using namespace polybody;

/// A bead on a parabolic wire that is fixed in a: with sᵢ = aᵢ·(r_b − r_a), 2 constraint functions
///   g = [s₂; s₃ − s₁²/4f],  γ = [γ₂; γ₃ − s₁/2f γ₁ − ṡ₁²/2f],  γᵢ that of sᵢ.
struct PointOnParabola {
  static constexpr char const* name = "PointOnParabola";
  static constexpr int rows = 2;
  static constexpr MarkerKind needs = MarkerKind::frame;            ///< requirement on marker a, which carries the wire
  static constexpr MarkerKind needs_of_second = MarkerKind::point;  ///< requirement on marker b
  static constexpr World world = World::space;

  Required<double> focal_length;  ///< f [m]
  Vec3 along = Vec3::UnitX();     ///< (3) unit tangent at the vertex, world axes at the reference configuration
  Vec3 axis = Vec3::UnitZ();      ///< (3) unit vector of the parabola's axis, perpendicular to it

  /// Called by `connect` with the joint's name.
  void check(std::string const& what) const { require_positive(focal_length, what + ": the focal length"); }
  Mat3 triad() const {
    require_unit(along, "PointOnParabola: the tangent");
    require_unit(axis, "PointOnParabola: the axis");
    if (std::abs(along.dot(axis)) > 1e-9) throw InvalidInput("PointOnParabola: the tangent must be across the axis.");
    Mat3 triad;
    triad << along, axis.cross(along), axis;
    return triad;
  }

  template <StateScalar T>
  ConstraintTerms<2, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    ConstraintTerms<3, T> const s = slides(a, b);
    T const slope = s.g[0] / (2.0 * focal_length);
    ConstraintTerms<2, T> gap;
    gap.g[0] = s.g[1];
    gap.g[1] = s.g[2] - 0.5 * s.g[0] * slope;
    for (int i = 0; i < 6; ++i) {
      gap.Ga(0, i) = s.Ga(1, i);
      gap.Gb(0, i) = s.Gb(1, i);
      gap.Ga(1, i) = s.Ga(2, i) - slope * s.Ga(0, i);
      gap.Gb(1, i) = s.Gb(2, i) - slope * s.Gb(0, i);
    }
    return gap;
  }
  template <StateScalar T>
  Vec<T, 2> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    ConstraintTerms<3, T> const s = slides(a, b);
    T const rate = Vec<T, 6>(s.Ga.row(0)).dot(twist(a)) + Vec<T, 6>(s.Gb.row(0)).dot(twist(b));
    auto const gamma_of = [&](int i) { return polybody::constraint_functions::no_slide_gamma(axis_of(a, i), a, b); };
    T const two_f(2.0 * focal_length);
    return {gamma_of(1), gamma_of(2) - s.g[0] / two_f * gamma_of(0) - rate * rate / two_f};
  }

 private:
  /// sᵢ with their maps.
  template <StateScalar T>
  static ConstraintTerms<3, T> slides(Frame<T> const& a, Frame<T> const& b) {
    ConstraintTerms<3, T> s;
    for (int i = 0; i < 3; ++i) polybody::constraint_functions::no_slide(axis_of(a, i), a, b, s, i);
    return s;
  }
};

static_assert(JointGeometry<PointOnParabola>);

}  // namespace own
