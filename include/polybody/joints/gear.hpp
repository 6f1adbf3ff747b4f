#pragma once
#include <numeric>

#include <polybody/joints/angle.hpp>
#include <polybody/joints/joint_axis.hpp>

namespace polybody {

/// Spur gears on parallel axes, in the plane and in space. 1 constraint equation
///   g = (N_a ψ_a + N_b ψ_b)/N_b.
/// ψ_a and ψ_b are the angles of the line of centres d = r_b − r_a in the axes of a and of b [Haug 1989, §3.4]. The
/// line of centres rotates with the carrier of the wheels, so that the same equation applies to wheels on the ground
/// and to planet wheels. Numbers of teeth are integers, so that full turns need no count: g is wrapped to [−π/n_b,
/// π/n_b] with n_b = N_b/gcd(N_a, N_b). Other joints keep the axes parallel and the distance of the centres constant.
struct Gear {
  static constexpr char const* name = "Gear";
  static constexpr int rows = 1;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr World world = World::both;

  static constexpr int most_teeth = 1'000'000;  ///< largest magnitude of a number of teeth

  Required<int> teeth_a;   ///< number of teeth N_a
  Required<int> teeth_b;   ///< number of teeth N_b; negative for an internal (ring) gear
  TurnAxis axis = {};      ///< (3) unit vector of the axes of both wheels, world axes at the reference configuration
  JointAxis centres = {};  ///< (3) unit vector from centre a to centre b, perpendicular to `axis`; axes as for `axis`

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    require_unit(axis.required("Gear: the axis"), "Gear: the axis");
    require_unit(centres.required("Gear: the line of centres"), "Gear: the line of centres");
    return polybody::constraint_functions::triad_of(centres, axis, "Gear");
  }
  void check(std::string const& what) const {
    if (teeth_a == 0 || teeth_b == 0 || (teeth_a < 0 && teeth_b < 0))
      throw InvalidInput(
          "gear.teeth",
          {ErrorObject{what},
           ": both wheels need a number of teeth, and at most one of them can be a ring gear (a negative number)."});
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
  static ConstraintTerms<2, T> bearing(Frame<T> const& one, Frame<T> const& other) {
    ConstraintTerms<2, T> xy;
    polybody::constraint_functions::on_axis(one, other, xy, 0);
    return xy;
  }
  template <StateScalar T>
  static T bearing_gamma(Frame<T> const& one, Frame<T> const& other) {
    return polybody::constraint_functions::angle_gamma(
        bearing(one, other), polybody::constraint_functions::on_axis_gamma(one, other), one, other);
  }
  template <class = void>  // compiled only if used
  static void bearing_gradient(Frame<double> const& one, Frame<double> const& other, double lambda,
                               Mat<double, 12, 12>& k) {
    Vec2 const each = polybody::constraint_functions::angle_gradient(bearing(one, other), lambda, k);
    polybody::constraint_functions::on_axis_gradient(one, other, each, k);
  }
};

}  // namespace polybody
