#pragma once
#include <polybody/joints/joint_axis.hpp>
#include <polybody/math/time_functions.hpp>

namespace polybody {

/// Driving constraint: the point of b has the position s(t) relative to the point of a along the axis fixed in a. Use
/// it together with a joint that permits this translation. 1 constraint equation
///   g = a₃·(r_b − r_a) − s      [Haug 1989, §3.5].
/// World::both: in the plane, the axis is a vector in the plane.
template <class Law>
struct PrescribedTranslation {
  static_assert(TimeFunction<Law>,
                "The law must be a function of time that returns a Motion. Write a lambda as "
                "[](double t) -> Motion { return {value, rate, acceleration}; }.");
  static constexpr char const* name = "PrescribedTranslation";
  static constexpr int rows = 1;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr MarkerKind needs_of_second = MarkerKind::point;
  static constexpr World world = World::both;

  Law law;              ///< translation s [m], rate and acceleration as functions of time [s]
  JointAxis axis = {};  ///< (3) unit vector, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(axis, "PrescribedTranslation: the axis");
  }
  void check(std::string const& what) const { check_driving_function(law, what + ": the time function"); }
  std::vector<double> breakpoints() const { return breakpoints_of(law); }

  template <StateScalar T>
  ConstraintTerms<1, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double t) const {
    Motion const s = law(t);
    ConstraintTerms<1, T> terms;
    polybody::constraint_functions::no_slide(axis_of(a, 2), a, b, terms, 0);
    terms.g[0] -= s.value;
    terms.rate[0] = T(-s.rate);
    return terms;
  }
  template <StateScalar T>
  Vec<T, 1> gamma(Frame<T> const& a, Frame<T> const& b, double t) const {
    return Vec<T, 1>(polybody::constraint_functions::no_slide_gamma(axis_of(a, 2), a, b) - Motion(law(t)).acceleration);
  }
  template <class = void>  // compiled only if used
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b,
                                      Vec<double, 1> const& lambda) const {
    return EquationList<NoTranslation<2>>::wrench_gradient(*this, a, b, lambda);
  }
};

}  // namespace polybody
