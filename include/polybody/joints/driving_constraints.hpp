#pragma once
/// \file
/// Driving constraints: relative motions as functions of time.
/// Theory: Eqs. 4.27, 4.28.

#include <polybody/joints/angle.hpp>
#include <polybody/joints/constraint_functions.hpp>
#include <polybody/joints/joint_axis.hpp>
#include <polybody/math/time_functions.hpp>

namespace polybody {

/// Driving constraint: b is rotated relative to a by ψ(t) about the common third axis. Use it together with a
/// Revolute. 1 constraint equation
///   g = θ − ψ, θ = atan2(a₂·b₁, a₁·b₁)      [Haug 1989, §3.5]
/// g is wrapped to [−π, π], so that full turns need not be counted. If b₁ is in the plane of a₁, a₂ (as with the
/// Revolute), ġ = a₃·(ω_b − ω_a) − ψ̇ exactly.
template <class Law>
struct PrescribedAngle {
  static_assert(detail::require_time_function<Law>());
  static constexpr char const* name = "PrescribedAngle";
  static constexpr int rows = 1;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr World world = World::both;
  static constexpr double period = 2.0 * std::numbers::pi;  ///< period of the prescribed angle [rad]

  Law law;             ///< angle [rad], rate and acceleration as functions of time [s]
  TurnAxis axis = {};  ///< (3) unit vector, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(axis, "PrescribedAngle: the axis");
  }
  void check(std::string const& what) const { check_driving_function(law, what + ": the time function"); }
  std::vector<double> breakpoints() const { return breakpoints_of(law); }

  template <StateScalar T>
  ConstraintTerms<1, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double t) const {
    Motion const psi = law(t);
    ConstraintTerms<1, T> terms = polybody::constraint_functions::angle(polybody::constraint_functions::turned(a, b));
    terms.g[0] = polybody::constraint_functions::wrapped(terms.g[0] - psi.value);
    terms.rate[0] = T(-psi.rate);
    return terms;
  }
  template <StateScalar T>
  Vec<T, 1> gamma(Frame<T> const& a, Frame<T> const& b, double t) const {
    return Vec<T, 1>(polybody::constraint_functions::turn_gamma(polybody::constraint_functions::turned(a, b), a, b) -
                     Motion(law(t)).acceleration);
  }
  template <class = void>  // compiled only if used
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b,
                                      Vec<double, 1> const& lambda) const {
    auto k = detail::zeros<Mat<double, 12, 12>>();
    polybody::constraint_functions::turn_gradient(a, b, lambda[0], k);
    return k;
  }
};

/// Driving constraint a₃·(ω_b − ω_a) = ω(t) for the relative angular velocity [rad/s], such as the run-up of a sprocket
/// [thesis §4.5]. The constraint equation prescribes the angle ∫ω dt from t = 0, so that the angle does not drift. Use
/// it together with a Revolute.
///     PrescribedRate<SmoothRamp>{.law = {{.target = 25.0, .duration = 7.0, .start = 1.0}}, .axis = …}
template <HasIntegral Law>
using PrescribedRate = PrescribedAngle<IntegralOf<Law>>;

/// Linear actuator between two points, in the plane and in space. 1 constraint equation
///   g = |r_b − r_a| − L − x(t)      [Haug 1989, §3.5, there squared].
template <class Law>
struct PrescribedDistance {
  static_assert(detail::require_time_function<Law>());
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
    return EquationList<FixedDistance<&PrescribedDistance::length>>::wrench_gradient(*this, a, b, lambda);
  }
};

/// Driving constraint: the point of b has the position s(t) relative to the point of a along the axis fixed in a. Use
/// it together with a joint that permits this translation. 1 constraint equation
///   g = a₃·(r_b − r_a) − s      [Haug 1989, §3.5].
/// In a planar model, the axis is a vector in the plane.
template <class Law>
struct PrescribedTranslation {
  static_assert(detail::require_time_function<Law>());
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
