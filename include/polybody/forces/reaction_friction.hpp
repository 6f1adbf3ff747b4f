#pragma once
/// \file
/// Friction in a joint that is proportional to the joint's reaction force: bearings and guides.
/// Theory: Eqs. 9.29, 9.38, 9.43.

#include <memory>

#include <polybody/forces/bristle.hpp>
#include <polybody/forces/reaction_force.hpp>
#include <polybody/forces/scalar_force.hpp>
#include <polybody/joints/joint.hpp>

namespace polybody {

namespace detail {
/// Rate ġ (m) of the constraint function or coordinate with these terms.
template <StateScalar T, int m>
Vec<T, m> rate_of(ConstraintTerms<m, T> const& terms, std::array<Frame<T>, 2> const& f) {
  Vec<T, 6> const a = twist(f[0]), b = twist(f[1]);
  Vec<T, m> rate = terms.rate;
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < 6; ++j) rate[i] += terms.Ga(i, j) * a[j] + terms.Gb(i, j) * b[j];
  return rate;
}
/// Wrench Gᵀ q of the force q along a coordinate with the Jacobian G.
template <StateScalar T>
Wrench<T> wrench_along(Mat<T, 1, 6> const& jacobian, T const& q) {
  Wrench<T> w;
  for (int i = 0; i < 3; ++i) {
    w.f[i] = jacobian(0, i) * q;
    w.m[i] = jacobian(0, 3 + i) * q;
  }
  return w;
}
}  // namespace detail

/// Type of a joint between two frames.
template <class J>
concept FrictionJoint = requires {
  typename J::PolicyType;
  { J::rows } -> std::convertible_to<int>;
};

/// Regularised friction: limit · v/√(v² + v_0²) at the relative rate v. It creeps.
struct SlidingResistance {
  static constexpr int states = 0;
  Required<double> slip_speed;  ///< v_0 [rad/s] or [m/s]

  void check(std::string const& name, ScalarUnits const& units) const {
    ScalarUnits::require_positive(slip_speed, units.rate, name, ": the slip speed of the friction");
  }
  /// Friction at the rate v and the `limit` [N] or [N m].
  template <StateScalar T>
  T force(T const& v, std::array<T, 0> const&, T const& limit) const {
    using std::sqrt;
    return v * limit / sqrt(T(v * v + slip_speed * slip_speed));
  }
};

/// Friction by a bristle with the deflection z, which sticks without creep: R = σ₀ z + σ₁ v, bounded by ± limit, and
/// ż = (R − σ₀ z)/σ₁. Compare `BristleFriction`.
struct StickingResistance {
  static constexpr int states = 1;
  Required<double> stiffness;  ///< σ₀ [N m/rad] or [N/m]
  Required<double> damping;    ///< σ₁ [N m s/rad] or [N s/m]

  void check(std::string const& name, ScalarUnits const& units) const {
    ScalarUnits::require_positive(stiffness, units.stiffness, name, ": the bristle stiffness of the friction");
    ScalarUnits::require_positive(damping, units.damping, name, ": the bristle damping of the friction");
  }
  /// Friction R at the rate v, the deflection z and the `limit` [N] or [N m].
  template <StateScalar T>
  T force(T const& v, std::array<T, 1> const& z, T const& limit) const {
    T const trial = z[0] * stiffness.value + v * damping.value;
    return trial * detail::held_share<T>(T(trial * trial), limit);
  }
  /// Rate of z at the rate v, with the bound `limit` of the force.
  template <StateScalar T>
  std::array<T, 1> rates(T const& v, std::array<T, 1> const& z, T const& limit) const {
    return {(force<T>(v, z, limit) - z[0] * stiffness.value) * (1.0 / damping)};
  }
};

/// Friction on the coordinate C of a joint of type J that follows the joint's reaction force F: the limit is μ r |F|
/// for a rotation, with the radius r of the bearing, and μ |F| for a translation. F is the force of the joint on its
/// second marker, without driving constraints and forces of other elements. The policy of J is `Constraint` or
/// compliant. With `Constraint`, F depends on the multipliers of the same instant, and the matrix of a step is
/// unsymmetric.
template <FrictionJoint J, class C, class Resistance>
struct ReactionFriction {
  using Coordinate = C;              ///< coordinate of the joint
  using FollowedJoint = J;           ///< type of the joint
  using P = typename J::PolicyType;  ///< policy of the joint
  static_assert(
      !EliminatingPolicy<P>,
      "Friction that follows the reaction of a joint needs the policy Constraint, or a compliant policy such as "
      "Penalty or Bushing. Joints with eliminated coordinates have no multipliers within a step.");
  static constexpr bool turns = C::motion == JointMotion::Kind::turn;      ///< true for an angle
  static constexpr int markers = 2, states = Resistance::states;           ///< two markers; states of the bristle
  static constexpr int multipliers = ConstrainingPolicy<P> ? J::rows : 0;  ///< number of multipliers λ
  static constexpr bool is_load = false;
  static constexpr MarkerKind needs = MarkerKind::frame;
  using States = std::array<double, std::size_t(states)>;                ///< deflection of the bristle, if there is one
  struct NoRadius {};                                                    ///< radius of a translation
  using Radius = std::conditional_t<turns, Required<double>, NoRadius>;  ///< radius of a rotation [m]

  Required<double> coefficient;         ///< μ [1]
  Radius radius = {};                   ///< r [m], for a rotation
  Resistance resistance;                ///< dependence on the rate
  std::shared_ptr<J const> joint = {};  ///< the joint; set by `Model::apply`
  int axis = 2;                         ///< axis of the coordinate in the axes of the joint; set by `Model::apply`

  void check(std::string const& name) const {
    require_not_negative(coefficient, name, ": the coefficient of friction");
    if constexpr (turns) ScalarUnits::require_not_negative(radius, "m", name, ": the radius of the bearing");
    resistance.check(name, C::units);
    if (!joint)
      throw InvalidInput("friction.no_joint",
                         {ErrorObject{name},
                          ": this friction follows the reaction of a joint. Apply it to the handle of "
                          "the joint instead of two markers."});
  }
  /// Sets the joint `followed`, and the index `axis_of_coordinate` of the axis of its coordinate.
  void follow(J const& followed, int axis_of_coordinate) {
    joint = std::make_shared<J const>(followed);
    axis = axis_of_coordinate;
  }

  template <StateScalar T>
  std::array<Wrench<T>, 2> wrenches(std::array<Frame<T>, 2> const& f, double t) const
    requires(states == 0)
  {
    return wrenches<T>(f, unloaded<T>(), {}, t);
  }
  template <StateScalar T>
  std::array<Wrench<T>, 2> wrenches(std::array<Frame<T>, 2> const& f, std::array<T, std::size_t(states)> const& z,
                                    double t) const
    requires(states > 0)
  {
    return wrenches<T>(f, unloaded<T>(), z, t);
  }
  /// Wrenches for the multipliers `lambda` of the joint, which a compliant joint ignores.
  template <StateScalar T>
  std::array<Wrench<T>, 2> wrenches(std::array<Frame<T>, 2> const& f, Vec<T, J::rows> const& lambda,
                                    std::array<T, std::size_t(states)> const& z, double t) const {
    ConstraintTerms<1, T> const c = C::terms(f[0], f[1]);
    T const q = -resistance.template force<T>(rate_of(c, f), z, limit<T>(f, lambda, t));
    return {detail::wrench_along<T>(c.Ga, q), detail::wrench_along<T>(c.Gb, q)};
  }
  template <StateScalar T>
  std::array<T, std::size_t(states)> rates(std::array<Frame<T>, 2> const& f,
                                           std::array<T, std::size_t(states)> const& z, double t) const
    requires(states > 0)
  {
    return rates<T>(f, unloaded<T>(), z, t);
  }
  /// Rates of the states for the multipliers `lambda` of the joint.
  template <StateScalar T>
  std::array<T, std::size_t(states)> rates(std::array<Frame<T>, 2> const& f, Vec<T, J::rows> const& lambda,
                                           std::array<T, std::size_t(states)> const& z, double t) const {
    return resistance.template rates<T>(rate_of(C::terms(f[0], f[1]), f), z, limit<T>(f, lambda, t));
  }

  /// Zero: regularised friction stores no energy [J].
  template <StateScalar T>
  T potential(std::array<Frame<T>, 2> const&, double) const
    requires(states == 0)
  {
    return T(0.0);
  }
  /// Energy of the bristle, ½ σ₀ z² [J].
  double potential(std::array<Frame<double>, 2> const&, States const& z, double) const
    requires(states > 0)
  {
    return 0.5 * resistance.stiffness * z[0] * z[0];
  }
  double dissipation(std::array<Frame<double>, 2> const& f, States const& z, double t) const
    requires(states > 0)
  {
    return dissipation(f, unloaded<double>(), z, t);
  }
  /// Power R₀ v − σ₀ z ż that slip dissipates, with R₀ = R at the velocity zero [W].
  double dissipation(std::array<Frame<double>, 2> const& f, Vec<double, J::rows> const& lambda, States const& z,
                     double t) const
    requires(states > 0)
  {
    auto at_rest = f;
    for (Frame<double>& x : at_rest) x.v = x.w = Vec3::Zero();
    double const held = resistance.template force<double>(0.0, z, limit<double>(at_rest, lambda, t));
    return held * rate_of(C::terms(f[0], f[1]), f) - resistance.stiffness * z[0] * rates<double>(f, lambda, z, t)[0];
  }

 private:
  template <StateScalar T>
  static Vec<T, J::rows> unloaded() {
    return detail::zeros<Vec<T, J::rows>>();
  }
  template <StateScalar T>
  static T rate_of(ConstraintTerms<1, T> const& c, std::array<Frame<T>, 2> const& f) {
    return detail::rate_of<T>(c, f)[0];
  }
  /// Limit μ r |F| or μ |F| of the friction.
  template <StateScalar T>
  T limit(std::array<Frame<T>, 2> const& f, Vec<T, J::rows> const& lambda, double t) const {
    using std::sqrt;
    auto of_joint = f;  // the third axis of f is the axis of the coordinate
    for (std::size_t k = 0; k < 2; ++k)
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) of_joint[k].A(i, j) = f[k].A(i, (j + 2 - axis) % 3);
    auto const terms = constraint_function<T>(joint->measure(), of_joint[0], of_joint[1], t);
    Vec<T, J::rows> l = lambda;
    if constexpr (!ConstrainingPolicy<P>)
      l = joint->policy.template multiplier<J::rows, T>(terms.g, detail::rate_of<T>(terms, of_joint));
    T square(0.0);
    for (int i = 0; i < 3; ++i) {
      T force(0.0);
      for (int k = 0; k < J::rows; ++k) force += terms.Gb(k, i) * l[k];
      square += force * force;
    }
    if (value_of(square) == 0.0) return T(0.0);
    T const load = sqrt(square) * coefficient.value;
    if constexpr (turns)
      return load * radius.value;
    else
      return load;
  }
};

/// Regularised friction moment in a bearing, a joint of type J, that follows the reaction of the joint.
template <FrictionJoint J>
using BearingFriction = ReactionFriction<J, detail::AngleBetween, SlidingResistance>;
/// Friction moment in a bearing that sticks without creep and follows the reaction of the joint.
template <FrictionJoint J>
using StickingBearingFriction = ReactionFriction<J, detail::AngleBetween, StickingResistance>;
/// Regularised friction force in a guide, a joint of type J with one translation, that follows the reaction of the
/// joint. Moments on the guide have no effect.
template <FrictionJoint J>
using GuideFriction = ReactionFriction<J, detail::TranslationBetween, SlidingResistance>;
/// Friction force in a guide that sticks without creep and follows the reaction of the joint.
template <FrictionJoint J>
using StickingGuideFriction = ReactionFriction<J, detail::TranslationBetween, StickingResistance>;

}  // namespace polybody
