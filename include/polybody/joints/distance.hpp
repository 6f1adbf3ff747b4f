#pragma once
#include <polybody/joints/constraint_functions.hpp>

namespace polybody {

/// Massless rod with a spherical joint at each end, in the plane and in space. 1 constraint equation
///   g = |r_b − r_a| − L      [Haug 1989, §9.4, there squared].
/// Without the square, g is a length, λ is the tension of the rod [N], and a Penalty is a linear spring for any
/// elongation. The direction of the rod is undefined if the points coincide.
struct Distance {
  static constexpr char const* name = "Distance";
  static constexpr int rows = 1;
  static constexpr MarkerKind needs = MarkerKind::point;
  static constexpr World world = World::both;

  Required<double> length;  ///< L [m]

  Mat3 triad() const { return identity(); }
  void check(std::string const& what) const {
    if (!(length > 0.0) || !std::isfinite(length))
      throw InvalidInput("distance.length",
                         {ErrorObject{what}, ": the length must be positive and finite, but is ", ErrorValue{length},
                          " m. For coincident points use Spherical or, in the plane, planar::Revolute."});
  }

  template <StateScalar T>
  ConstraintTerms<1, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    ConstraintTerms<1, T> terms;
    polybody::constraint_functions::distance(a, b, length, terms);
    return terms;
  }
  template <StateScalar T>
  Vec<T, 1> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    return Vec<T, 1>(polybody::constraint_functions::distance_gamma(a, b));
  }
  template <class = void>  // compiled only if used
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b,
                                      Vec<double, 1> const& lambda) const {
    auto k = detail::zeros<Mat<double, 12, 12>>();
    polybody::constraint_functions::distance_gradient(a, b, lambda[0], k);
    return k;
  }
};

}  // namespace polybody
