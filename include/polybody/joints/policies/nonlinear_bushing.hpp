#pragma once
/// \file
/// Nonlinear bushing: joint policy with a force law for each component of the relative motion, and common force laws.

#include <tuple>

#include <polybody/joints/policies/policy.hpp>
#include <polybody/joints/relative_coordinates.hpp>
#include <polybody/math/monotone_table.hpp>

namespace polybody {

/// Force as a function of one coordinate x and its rate: `law(x, ẋ)` for double and dual numbers, such as a generic
/// lambda. Optional members are `potential(x)`, whose derivative is the force at rest, and `check(what)`.
template <class L>
concept ForceLaw = requires(L const law, Dual<1> const x) {
  { law(0.0, 0.0) } -> std::convertible_to<double>;
  { law(x, x) } -> std::convertible_to<Dual<1>>;
};

/// Linear force law k x + c ẋ.
struct LinearLaw {
  Required<double> stiffness;  ///< k [N/m], [N m/rad]
  Required<double> damping;    ///< c [N s/m], [N m s/rad]

  /// \throws InvalidInput unless k ≥ 0 and c ≥ 0.
  void check(std::string const& what) const {
    require_not_negative(stiffness, what, ": the stiffness");
    require_not_negative(damping, what, ": the damping");
  }
  /// The force k x + c ẋ [N], or the moment [N m], at x [m] or [rad] and its `rate` ẋ.
  template <StateScalar T>
  T operator()(T const& x, T const& rate) const {
    return x * stiffness.value + rate * damping.value;
  }
  /// Stored energy [J] at x [m] or [rad].
  double potential(double x) const { return 0.5 * stiffness * x * x; }
};

/// Force law f(x) + c ẋ with f from a table.
struct TabulatedLaw {
  MonotoneTable force;       ///< f [N] or [N m] over [m] or [rad]
  Required<double> damping;  ///< c [N s/m], [N m s/rad]

  /// \throws InvalidInput unless c ≥ 0.
  void check(std::string const& what) const { require_not_negative(damping, what, ": the damping"); }
  /// The force f(x) + c ẋ [N], or the moment [N m], at x [m] or [rad] and its `rate` ẋ.
  template <StateScalar T>
  T operator()(T const& x, T const& rate) const {
    return force(x) + rate * damping.value;
  }
  /// Stored energy [J] at x [m] or [rad].
  double potential(double x) const { return force.integral(x); }
};

/// Bushing with a force law for each component, translations along the joint's axes first, then rotations: force
/// λᵢ = fᵢ(xᵢ, ẋᵢ). The xᵢ are the six `RelativeCoordinates`. The free directions of the geometry stay free, and their
/// laws have no effect. Derivatives are computed by dual numbers. `energy` does not count the work of laws without
/// `potential`.
///   NonlinearBushing const rubber{TabulatedLaw{…}, LinearLaw{…}, [](auto x, auto rate) { return …; }, …};
///   using Pin = Joint<Revolute, decltype(rubber)>;
template <ForceLaw... Laws>
  requires(sizeof...(Laws) == 6)
struct NonlinearBushing {
  static constexpr char const* name = "NonlinearBushing";
  /// Constraint function: the six `RelativeCoordinates`, zero in the free directions of G.
  template <JointGeometry G>
  using Measured = ConstrainedCoordinates<G>;

  std::tuple<Laws...> laws;  ///< (6) translations along the joint's axes, then rotations

  /// Bushing of six laws: translations along the joint's axes, then rotations.
  NonlinearBushing(Laws const&... six) : laws(six...) {}

  /// Checks the laws that have a check; `what` is the joint's name.
  void check(std::string const& what) const {
    for_each([&](int i, auto const& law) {
      std::string const component = what + ": component " + std::to_string(i + 1) + " of the bushing";
      if constexpr (requires { law.check(component); }) law.check(component);
    });
  }

  /// Forces and moments f (6) [N], [N m] at displacements x (6) [m], [rad] and their `rate` ẋ.
  template <int m, StateScalar T>
    requires(m == 6)
  Vec<T, m> multiplier(Vec<T, m> const& x, Vec<T, m> const& rate) const {
    Vec<T, m> lambda;
    for_each([&](int i, auto const& law) { lambda[i] = law(x[i], rate[i]); });
    return lambda;
  }
  /// Derivative ck ∂f/∂x + cd ∂f/∂ẋ (6×6) with given ck, cd, where ẋ is `rate`.
  template <int m, class D = Dual<1>>
    requires(m == 6)
  Eigen::DiagonalMatrix<double, m> slope(double ck, double cd, Vec<double, m> const& x,
                                         Vec<double, m> const& rate) const {
    Eigen::DiagonalMatrix<double, m> slope;
    for_each([&](int i, auto const& law) {
      D const f = law(D(x[i], typename D::Partials(ck)), D(rate[i], typename D::Partials(cd)));
      slope.diagonal()[i] = f.d[0];
    });
    return slope;
  }
  /// Stored energy [J] at x (6), the sum over the laws that have a potential.
  template <int m>
    requires(m == 6)
  double potential(Vec<double, m> const& x) const {
    double sum = 0.0;
    for_each([&](int i, auto const& law) {
      if constexpr (requires { law.potential(0.0); }) sum += law.potential(x[i]);
    });
    return sum;
  }

 private:
  template <class F>
  void for_each(F&& f) const {
    [&]<std::size_t... i>(std::index_sequence<i...>) {
      (f(int(i), std::get<i>(laws)), ...);
    }(std::make_index_sequence<6>{});
  }
};

}  // namespace polybody
