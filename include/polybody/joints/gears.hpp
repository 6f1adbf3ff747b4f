#pragma once
/// \file
/// Geometries that couple two motions: gears, rack and pinion.
/// Theory: Eq. 4.26.

#include <numeric>

#include <polybody/joints/angle.hpp>
#include <polybody/joints/joint_axis.hpp>

namespace polybody {

/// Spur gears on parallel axes, in the plane and in space. 1 constraint equation
///   g = (N_a ψ_a + N_b ψ_b)/N_b.
/// ψ_a and ψ_b are the angles of the line of centres d = r_b − r_a in the axes of a and of b [Haug 1989, §3.4]. The
/// line of centres rotates with the carrier of the wheels, so that the same equation applies to wheels on the ground
/// and to planet wheels. Numbers of teeth are integers, so that full turns need not be counted: g is wrapped to
/// |g| ≤ π gcd(N_a, N_b)/|N_b|. Other joints must keep the axes parallel and the distance of the centres constant.
struct Gear {
  static constexpr char const* name = "Gear";
  static constexpr int rows = 1;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr World world = World::both;

  static constexpr int most_teeth = 1'000'000;  ///< largest magnitude of a number of teeth

  Required<int> teeth_a;  ///< number of teeth N_a; negative for an internal (ring) gear
  Required<int> teeth_b;  ///< number of teeth N_b; negative for an internal (ring) gear
  TurnAxis axis = {};     ///< (3) unit vector of the axes of both wheels, world axes at the reference configuration
  /// (3) unit vector from centre a to centre b, perpendicular to `axis`, world axes at the reference configuration
  JointAxis centres = {};

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    require_unit(axis.required("Gear: the axis"), "Gear: the axis");
    require_unit(centres.required("Gear: the line of centres"), "Gear: the line of centres");
    return polybody::constraint_functions::triad_of(centres, axis, "Gear");
  }
  void check(std::string const& what) const {
    if (teeth_a == 0 || teeth_b == 0 || (teeth_a < 0 && teeth_b < 0))
      throw InvalidInput("gear.teeth",
                         {ErrorObject{what}, ": the numbers of teeth are ", int(teeth_a), " and ", int(teeth_b),
                          ", but neither may be zero, and at most one may be negative (a ring gear)."});
    for (int const teeth : {int(teeth_a), int(teeth_b)})
      if (teeth < -most_teeth || teeth > most_teeth)
        throw InvalidInput("gear.teeth", {ErrorObject{what}, ": a wheel has at most ", most_teeth,
                                          " teeth, but the number is ", ErrorValue{teeth}, "."});
    if ((teeth_a < 0 || teeth_b < 0) && teeth_a + teeth_b >= 0)
      throw InvalidInput(
          "gear.teeth",
          {ErrorObject{what}, ": a ring gear must have more teeth than the wheel inside it, but the numbers are ",
           teeth_a, " and ", teeth_b, "."});
  }

  template <StateScalar T>
  ConstraintTerms<1, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    Ratio const n = ratio();
    ConstraintTerms<1, T> const of_a = polybody::constraint_functions::angle(bearing(a, b)),
                                of_b = polybody::constraint_functions::angle(bearing(b, a));
    ConstraintTerms<1, T> terms;
    T const turns = of_a.g[0] * n.a + of_b.g[0] * n.b;
    terms.g[0] = polybody::constraint_functions::wrapped(turns - std::numbers::pi * n.b) /
                 n.b;  // the line from b to a has the opposite direction
    for (int j = 0; j < 6; ++j) {
      terms.Ga(0, j) = of_a.Ga(0, j) * (n.a / n.b) + of_b.Gb(0, j);
      terms.Gb(0, j) = of_a.Gb(0, j) * (n.a / n.b) + of_b.Ga(0, j);
    }
    return terms;
  }
  template <StateScalar T>
  Vec<T, 1> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    Ratio const n = ratio();
    return Vec<T, 1>(bearing_gamma(a, b) * (n.a / n.b) + bearing_gamma(b, a));
  }
  template <class = void>  // compiled only if used
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b,
                                      Vec<double, 1> const& lambda) const {
    Ratio const n = ratio();
    Mat<double, 12, 12> k = detail::zeros<Mat<double, 12, 12>>(), back = k;
    bearing_gradient(a, b, lambda[0] * n.a / n.b, k);
    bearing_gradient(b, a, lambda[0], back);
    for (int i = 0; i < 12; ++i)
      for (int j = 0; j < 12; ++j) k(i, j) += back((i + 6) % 12, (j + 6) % 12);
    return k;
  }

 private:
  using Bearing = EquationList<NoTranslation<0>, NoTranslation<1>>;
  /// Numbers of teeth without their common factor.
  struct Ratio {
    double a, b;  ///< ratios N_a/gcd and N_b/gcd
  };
  Ratio ratio() const {
    int const common = std::gcd(int(teeth_a), int(teeth_b));
    return {double(int(teeth_a)) / common, double(int(teeth_b)) / common};
  }

  /// Components of the vector from the centre of `one` to the centre of `other` in the first two axes of `one`.
  template <StateScalar T>
  ConstraintTerms<2, T> bearing(Frame<T> const& one, Frame<T> const& other) const {
    return Bearing::constraint_function<T>(*this, one, other);
  }
  template <StateScalar T>
  T bearing_gamma(Frame<T> const& one, Frame<T> const& other) const {
    return polybody::constraint_functions::angle_gamma(bearing(one, other), Bearing::gamma<T>(*this, one, other), one,
                                                       other);
  }
  template <class = void>  // compiled only if used
  void bearing_gradient(Frame<double> const& one, Frame<double> const& other, double lambda,
                        Mat<double, 12, 12>& k) const {
    Vec2 const each = polybody::constraint_functions::angle_gradient(bearing(one, other), lambda, k);
    for (int i = 0; i < 2; ++i)
      polybody::constraint_functions::no_slide_gradient(axis_of(one, i), one, other, each[i], k);
  }
};

/// Pinion b on the rack a, in the plane and in space: a coupled translation and rotation. 1 constraint equation
///   g = a₁·d − R θ,  d = r_b − r_a      [Haug 1989, §3.4].
/// θ is the rotation of b about a₃. At the reference configuration θ is zero if a₁·d is zero. The translation
/// determines the number of full turns in θ. Other joints must constrain the pinion's height over the rack and the
/// direction of its axis. With a rack on the ground, the pinion is a wheel that rolls.
struct RackAndPinion {
  static constexpr char const* name = "RackAndPinion";
  static constexpr World world = World::both;

  Required<double> radius;   ///< pitch radius R [m]; for R > 0 the rack is on the side axis × direction of the pinion
  TurnAxis axis = {};        ///< (3) unit vector of the pinion's axis, world axes at the reference configuration
  JointAxis direction = {};  ///< (3) unit vector along the rack, perpendicular to `axis`
  using Equations = EquationList<TranslationPerRotation<0, &RackAndPinion::radius>>;

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
};

}  // namespace polybody
