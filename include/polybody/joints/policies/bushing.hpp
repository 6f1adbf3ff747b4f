#pragma once
/// \file
/// Linear bushing: policy that replaces a joint by a spring and damper with 6×6 matrices.
/// Nonlinear bushing: joint policy with a force law for each component of the relative motion, and common force laws.
/// Theory: Eqs. 5.8, 5.9.

#include <tuple>

#include <polybody/joints/policies/policy.hpp>
#include <polybody/joints/relative_coordinates.hpp>
#include <polybody/math/monotone_table.hpp>

namespace polybody {

namespace detail {
/// Requires a matrix k (6×6) that is finite, symmetric and positive semidefinite. \throws InvalidInput with the name
/// `what` otherwise. Symmetric elimination of k, with its diagonal scaled to one, must have no negative pivot, and a
/// zero pivot requires a zero column [Higham 2002, §10.3].
template <class = void>  // compiled only if used
void require_semidefinite(Mat<double, 6, 6> const& k, std::string const& what) {
  double l[6][6];
  auto const refuse = [&](std::string const& why) {
    throw InvalidInput(
        "bushing.matrix",
        {ErrorObject{what}, " must be finite, symmetric and positive semidefinite (6×6), but ", why, "."});
  };
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      auto const entry = [&] { return sentence_of({"its entry (", i + 1, ", ", j + 1, ") is ", k(i, j)}); };
      double const scale = std::sqrt(k(i, i) * k(j, j));
      if (!std::isfinite(k(i, j)) || (i == j && k(i, j) < 0.0)) refuse(entry());
      if (std::abs(k(i, j) - k(j, i)) > 1e-9 * scale)
        refuse(entry() + " and its transposed entry is " + number(k(j, i)));
      if (scale == 0.0 && k(i, j) != 0.0) refuse(entry() + " although a diagonal entry of its row or column is zero");
      l[i][j] = scale > 0.0 ? k(i, j) / scale : 0.0;
    }
  for (int i = 0; i < 6; ++i) {
    bool const lost = std::abs(l[i][i]) < 1e-10;
    for (int r = i; r < 6; ++r)
      if (l[i][i] <= -1e-10 || (lost && std::abs(l[r][i]) > 1e-5))
        refuse("the coupling of its row " + std::to_string(i + 1) + " with other rows is too strong");
    if (lost) continue;
    for (int r = i + 1; r < 6; ++r)
      for (int c = i + 1; c < 6; ++c) l[r][c] -= l[r][i] * l[i][c] / l[i][i];
  }
}
}  // namespace detail

/// Linear bushing [thesis Eq. 3.15]: λ = K x + C ẋ instead of constraint equations. x are the six `RelativeCoordinates`
/// of b relative to a in the joint's axes, fixed in a: translations [m], then rotations [rad], of any size. The free
/// directions of the geometry stay free: their rows and columns of K and C have no effect. For a stiffness in all
/// directions (a torsional spring in a revolute joint, within half a turn), use `RelativeCoordinates` as the geometry,
/// which has no free direction. The elastic force derives exactly from the potential ½ xᵀK x. The rate ẋ is the exact
/// derivative of x. In the thesis it is Aᵀṙ, without the term of Ȧ, the rotation of the axes.
struct Bushing {
  static constexpr char const* name = "Bushing";
  static constexpr bool linear = true;  ///< true: λ is linear in g and ġ
  /// Constraint function: the six `RelativeCoordinates`, zero in the free directions of G.
  template <JointGeometry G>
  using Measured = ConstrainedCoordinates<G>;
  using Matrix = Mat<double, 6, 6>;  ///< (6×6) in the joint's axes, translations before rotations

  Required<Matrix> stiffness;  ///< (6×6) K, blocks [N/m], [N/rad]; [N], [N m/rad]
  Required<Matrix> damping;    ///< (6×6) C, blocks [N s/m], [N s/rad]; [N s], [N m s/rad]

  /// Diagonal matrix with the values `along` the joint's axes, [N/m] or [N s/m], and `about` these axes, [N m/rad] or
  /// [N m s/rad].
  template <class = void>  // compiled only if used
  static Matrix diagonal(Vec3 const& along, Vec3 const& about) {
    auto k = detail::zeros<Matrix>();
    for (int i = 0; i < 3; ++i) {
      k(i, i) = along[i];
      k(i + 3, i + 3) = about[i];
    }
    return k;
  }

  /// \throws InvalidInput unless K and C are finite, symmetric and positive semidefinite; `what` is the joint's name.
  template <class = void>  // compiled only if used
  void check(std::string const& what) const {
    detail::require_semidefinite(stiffness.value, what + ": the bushing's stiffness");
    detail::require_semidefinite(damping.value, what + ": the bushing's damping");
  }

  /// λ = K x + C ẋ (6) [N], [N m] at displacements x (6) [m], [rad] and their `rate` ẋ.
  template <int m, StateScalar T>
    requires(m == 6)
  Vec<T, m> multiplier(Vec<T, m> const& x, Vec<T, m> const& rate) const {
    auto lambda = detail::zeros<Vec<T, m>>();
    for (int j = 0; j < m; ++j)
      for (int i = 0; i < m; ++i) lambda[i] += x[j] * stiffness.value(i, j) + rate[j] * damping.value(i, j);
    return lambda;
  }
  /// Tangent ck K + cd C (6×6).
  template <int m>
    requires(m == 6)
  Matrix slope(double ck, double cd, Vec<double, m> const&, Vec<double, m> const&) const {
    Matrix slope;
    for (int j = 0; j < m; ++j)
      for (int i = 0; i < m; ++i) slope(i, j) = ck * stiffness.value(i, j) + cd * damping.value(i, j);
    return slope;
  }
  bool is_lossless() const { return damping.value.isZero(0.0); }  ///< true without damping
  /// Potential ½ xᵀK x [J].
  template <int m>
    requires(m == 6)
  double potential(Vec<double, m> const& x) const {
    double sum = 0.0;
    for (int j = 0; j < m; ++j)
      for (int i = 0; i < m; ++i) sum += x[i] * stiffness.value(i, j) * x[j];
    return 0.5 * sum;
  }
};

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
