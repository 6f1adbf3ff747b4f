#pragma once
/// \file
/// Driving constraint for a relative angle, in the plane and in space.

#include <polybody/joints/angle.hpp>
#include <polybody/joints/joint_axis.hpp>
#include <polybody/math/time_functions.hpp>

namespace polybody {

/// Driving constraint: b is rotated relative to a by ψ(t) about the common third axis. Use it together with a
/// Revolute. 1 constraint equation
///   g = θ − ψ, θ = atan2(a₂·b₁, a₁·b₁)      [Haug 1989, §3.5]
/// wrapped to [−π, π], so that full turns need no count. If b₁ is in the plane of a₁, a₂ (as with the Revolute), ġ =
/// a₃·(ω_b − ω_a) − ψ̇ exactly.
template <class Law>
struct PrescribedAngle {
  static_assert(TimeFunction<Law>,
                "The law must be a function of time that returns a Motion. Write a lambda as "
                "[](double t) -> Motion { return {value, rate, acceleration}; }.");
  static constexpr char const* name = "PrescribedAngle";
  static constexpr int rows = 1;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr World world = World::both;
  static constexpr double period = 2.0 * std::numbers::pi;  ///< jumps of the angle by this period are permitted [rad]

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

}  // namespace polybody
