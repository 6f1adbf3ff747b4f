#pragma once
#include <polybody/joints/constraint_functions.hpp>
#include <polybody/math/time_functions.hpp>

namespace polybody {

/// Linear actuator between two points, in the plane and in space. 1 constraint equation
///   g = |r_b − r_a| − L − x(t)      [Haug 1989, §3.5, there squared].
template <class Law>
struct PrescribedDistance {
  static_assert(TimeFunction<Law>,
                "The law must be a function of time that returns a Motion. Write a lambda as "
                "[](double t) -> Motion { return {value, rate, acceleration}; }.");
  static constexpr char const* name = "PrescribedDistance";
  static constexpr int rows = 1;
  static constexpr MarkerKind needs = MarkerKind::point;
  static constexpr World world = World::both;

  Law law;                  ///< stroke x [m], rate and acceleration as functions of time [s]
  Required<double> length;  ///< L, the distance at x = 0 [m]; L + x must stay positive

  Mat3 triad() const { return identity(); }
  void check(std::string const& what) const {
    require_positive(length, what, ": the length");
    check_driving_function(law, what + ": the time function");
  }
  std::vector<double> breakpoints() const { return breakpoints_of(law); }

  template <StateScalar T>
  ConstraintTerms<1, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double t) const {
    Motion const x = law(t);
    ConstraintTerms<1, T> terms;
    polybody::constraint_functions::distance(a, b, length + x.value, terms);
    terms.rate[0] = T(-x.rate);
    return terms;
  }
  template <StateScalar T>
  Vec<T, 1> gamma(Frame<T> const& a, Frame<T> const& b, double t) const {
    return Vec<T, 1>(polybody::constraint_functions::distance_gamma(a, b) - Motion(law(t)).acceleration);
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
