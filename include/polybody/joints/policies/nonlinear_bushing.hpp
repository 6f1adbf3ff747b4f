#pragma once
#include <tuple>

#include <polybody/joints/policies/policy.hpp>
#include <polybody/joints/relative_coordinates.hpp>
#include <polybody/math/monotone_table.hpp>

namespace polybody {

/// A force as a function of one coordinate x and its rate: `law(x, ẋ)` in double and in dual numbers; a generic lambda
/// will do. It may have `potential(x)`, whose slope it is at rest, and `check(what)`.
template <class L>
concept ForceLaw = requires(L const law, Dual<1> const x) {
  { law(0.0, 0.0) } -> std::convertible_to<double>;
  { law(x, x) } -> std::convertible_to<Dual<1>>;
};

/// k x + c ẋ.
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
  /// The energy stored at x [m] or [rad] [J].
  double potential(double x) const { return 0.5 * stiffness * x * x; }
};

/// f(x) + c ẋ, f from a table.
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
  /// The energy stored at x [m] or [rad] [J].
  double potential(double x) const { return force.integral(x); }
};

/// A bushing with a law for each component, in the order slides along the joint's axes, then turns: λᵢ = fᵢ(xᵢ, ẋᵢ), x
/// the six `RelativeCoordinates`. What the geometry leaves free stays free, and its law has no effect. Slopes come from
/// dual numbers. Laws without `potential` do work that `energy` does not count.
///   NonlinearBushing const rubber{TabulatedLaw{…}, LinearLaw{…}, [](auto x, auto rate) { return …; }, …};
///   using Pin = Joint<Revolute, decltype(rubber)>;
template <ForceLaw... Laws>
  requires(sizeof...(Laws) == 6)
struct NonlinearBushing {
  static constexpr char const* name = "NonlinearBushing";
  /// What is measured in place of G's rows: the six `RelativeCoordinates`, zero where G leaves them free.
  template <JointGeometry G>
  using Measured = ConstrainedCoordinates<G>;

  std::tuple<Laws...> laws;  ///< (6) slides along the joint's axes, then turns

  /// From six laws: slides along the joint's axes, then turns.
  NonlinearBushing(Laws const&... six) : laws(six...) {}

  /// Checks the laws that have a check; `what` is the joint's name.
  void check(std::string const& what) const {
    for_each([&](int i, auto const& law) {
      std::string const component = what + ": component " + std::to_string(i + 1) + " of the bushing";
      if constexpr (requires { law.check(component); }) law.check(component);
    });
  }

  /// The forces and moments f (6) [N], [N m] at displacements x (6) [m], [rad] and their `rate` ẋ.
  template <int m, StateScalar T>
    requires(m == 6)
  Vec<T, m> multiplier(Vec<T, m> const& x, Vec<T, m> const& rate) const {
    Vec<T, m> lambda;
    for_each([&](int i, auto const& law) { lambda[i] = law(x[i], rate[i]); });
    return lambda;
  }
  /// ck ∂f/∂x + cd ∂f/∂ẋ (6×6), ẋ being `rate`: the derivative along (ck, cd).
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
  /// The energy at x (6) of the laws that have a potential [J].
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
