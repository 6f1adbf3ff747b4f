#pragma once
#include <polybody/joints/constraint_functions.hpp>

namespace polybody {

/// Massless rod with a spherical joint at each end, in the plane and in space. 1 constraint equation
///   g = |r_b − r_a| − L      [Haug 1989, §9.4, there squared].
/// Without the square, g is a length, λ is the tension of the rod [N], and a Penalty is a linear spring for any
/// elongation. The direction of the rod is undefined if the points coincide.
struct Distance {
  static constexpr char const* name = "Distance";
  static constexpr World world = World::both;

  Required<double> length;  ///< L [m]
  using Equations = EquationList<FixedDistance<&Distance::length>>;

  Mat3 triad() const { return identity(); }
  void check(std::string const& what) const {
    if (!(length > 0.0) || !std::isfinite(length))
      throw InvalidInput("distance.length",
                         {ErrorObject{what}, ": the length must be positive and finite, but is ", ErrorValue{length},
                          " m. For coincident points use Spherical or, in the plane, planar::Revolute."});
  }
};

}  // namespace polybody
