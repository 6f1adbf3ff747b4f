#pragma once
/// \file
/// Forces along one relative coordinate of two markers: an angle, a translation or a distance. A scalar law computes
/// the force from the coordinate x, its rate, first-order states and time.
/// Theory: Eqs. 9.1 to 9.9.

#include <algorithm>
#include <limits>
#include <numbers>

#include <polybody/forces/force_element.hpp>
#include <polybody/joints/angle.hpp>
#include <polybody/joints/joint_coordinate.hpp>
#include <polybody/math/secant.hpp>

namespace polybody {

/// Names of the units of a coordinate x and of its force, for messages.
struct ScalarUnits {
  char const* x;          ///< unit of x: "m" or "rad"
  char const* rate;       ///< unit of ẋ
  char const* force;      ///< unit of the force: "N" or "N m"
  char const* stiffness;  ///< force per x
  char const* damping;    ///< force per ẋ
  double largest;         ///< bound of |x|: π for an angle without full turns, infinite otherwise [rad], [m]

  /// \throws InvalidInput unless `x` is finite and positive; `unit` is its unit. `what` and `part` name the object and
  /// the parameter.
  static void require_positive(double x, char const* unit, std::string_view what, std::string_view part) {
    if (!(x > 0.0) || !std::isfinite(x))
      throw InvalidInput("value.not_positive", {ErrorObject{what}, part, " must be positive and finite, but is ",
                                                ErrorValue{x}, " ", unit, "."});
  }
  /// \throws InvalidInput unless `x` is finite and not negative; `unit` is its unit.
  static void require_not_negative(double x, char const* unit, std::string_view what, std::string_view part) {
    if (!(x >= 0.0) || !std::isfinite(x))
      throw InvalidInput("value.negative", {ErrorObject{what}, part, " must be zero or positive, and finite, but is ",
                                            ErrorValue{x}, " ", unit, "."});
  }
  /// \throws InvalidInput unless `x` is finite; `unit` is its unit.
  static void require_finite(double x, char const* unit, std::string_view what, std::string_view part) {
    if (!std::isfinite(x))
      throw InvalidInput("value.not_finite",
                         {ErrorObject{what}, part, " must be finite, but is ", ErrorValue{x}, " ", unit, "."});
  }
};

/// Scalar law without states: force Q on marker b in the direction of growing x. Optional members are
/// `potential(x, t)`, `is_lossless()`, `breakpoints()` and the constant `is_load`.
template <class L>
concept StatelessScalarLaw = states_of<L>() == 0 && requires(L const law, double x, double t) {
  { law.template force<double>(x, x, t) } -> std::convertible_to<double>;
};
/// Scalar law with first-order states z and their rates ż. Optional members are those of a law without states, with
/// `potential(x, z, t)`, and `dissipation(x, rate, z, t)`, the power −(Q₀ ẋ + V̇) with the force Q₀ at zero rate, and
/// `initial_states()`.
template <class L>
concept ScalarLawWithStates =
    states_of<L>() > 0 && requires(L const law, double x, std::array<double, states_of<L>()> const z, double t) {
      { law.template force<double>(x, x, z, t) } -> std::convertible_to<double>;
      { law.template rates<double>(x, x, z, t) } -> std::same_as<std::array<double, states_of<L>()>>;
    };
/// Force law of one coordinate. `check(name, units)` throws InvalidInput for invalid parameters.
template <class L>
concept ScalarLaw = (StatelessScalarLaw<L> || ScalarLawWithStates<L>) &&
                    requires(L const law, std::string const name, ScalarUnits const units) { law.check(name, units); };

/// Scalar law without states that has a potential for the scalar T.
template <class L, class T>
concept HasScalarPotential = StatelessScalarLaw<L> && requires(L const law, T const x, double t) {
  { law.potential(x, t) } -> std::convertible_to<T>;
};
/// Scalar law with states that has a potential V(x, z, t) and the power −(Q₀ ẋ + V̇).
template <class L>
concept HasScalarStatePotential =
    ScalarLawWithStates<L> && requires(L const law, double x, std::array<double, states_of<L>()> const z, double t) {
      { law.potential(x, z, t) } -> std::convertible_to<double>;
      { law.dissipation(x, x, z, t) } -> std::convertible_to<double>;
    };

namespace detail {

/// The larger of x and zero.
template <StateScalar T>
T positive_part(T const& x) {
  return value_of(x) > 0.0 ? x : T(0.0);
}
/// The larger of x and zero at both ends of a step, with the secant slope between them.
template <int N>
Secant<N> positive_part(Secant<N> const& x) {
  double const a = std::max(x.a, 0.0), b = std::max(x.b, 0.0);
  double const slope = x.a == x.b ? double(x.a > 0.0) : (b - a) / (x.b - x.a);
  return {a, b, x.d * slope};
}

inline constexpr double endless = std::numeric_limits<double>::infinity();

/// Rotation of b about the third axis of a: in (−π, π], or with its full turns.
template <bool full_turns>
struct RotationBetween {
  static constexpr MarkerKind needs = MarkerKind::frame, needs_of_second = MarkerKind::frame;
  static constexpr JointMotion::Kind motion = JointMotion::Kind::turn;
  static constexpr ScalarUnits units = {"rad",     "rad/s",     "N m",
                                        "N m/rad", "N m s/rad", full_turns ? endless : std::numbers::pi};
  static constexpr bool counts_turns = full_turns;
  template <StateScalar T>
  static ConstraintTerms<1, T> terms(Frame<T> const& a, Frame<T> const& b) {
    return constraint_functions::angle(constraint_functions::turned(a, b));
  }
};
using AngleBetween = RotationBetween<false>;
using TurnsBetween = RotationBetween<true>;
/// Translation of b along the third axis of a.
struct TranslationBetween {
  static constexpr MarkerKind needs = MarkerKind::frame, needs_of_second = MarkerKind::point;
  static constexpr JointMotion::Kind motion = JointMotion::Kind::slide;
  static constexpr ScalarUnits units = {"m", "m/s", "N", "N/m", "N s/m", endless};
  static constexpr bool counts_turns = false;
  template <StateScalar T>
  static ConstraintTerms<1, T> terms(Frame<T> const& a, Frame<T> const& b) {
    ConstraintTerms<1, T> out;
    constraint_functions::no_slide(axis_of(a, 2), a, b, out, 0);
    return out;
  }
};
/// Distance of the points of a and b.
struct DistanceBetween {
  static constexpr MarkerKind needs = MarkerKind::point, needs_of_second = MarkerKind::point;
  static constexpr ScalarUnits units = TranslationBetween::units;
  static constexpr bool counts_turns = false;
  template <StateScalar T>
  static ConstraintTerms<1, T> terms(Frame<T> const& a, Frame<T> const& b) {
    ConstraintTerms<1, T> out;
    constraint_functions::distance(a, b, 0.0, out);
    return out;
  }
};

/// The constant `is_load` of a scalar law; false without this member.
template <class L>
constexpr bool is_load_of() {
  if constexpr (requires { L::is_load; })
    return L::is_load;
  else
    return false;
}

}  // namespace detail

/// Force element of two markers a and b that acts along the coordinate C by the scalar law L. With ẋ = Ga Va + Gb Vb,
/// the wrenches are Gaᵀ Q and Gbᵀ Q. `OnAngle`, `OnTurns`, `OnTranslation` and `OnDistance` are the coordinates.
template <class C, ScalarLaw L>
struct ScalarForce {
  using Coordinate = C;                                            ///< relative coordinate of the markers
  static constexpr int markers = 2;                                ///< marker a, marker b
  static constexpr int states = states_of<L>() + C::counts_turns;  ///< the angle of `OnTurns`, then those of the law
  static constexpr bool is_load = detail::is_load_of<L>();
  static constexpr MarkerKind needs = C::needs;
  static constexpr MarkerKind needs_of_second = C::needs_of_second;
  using States = std::array<double, std::size_t(states)>;  ///< first-order states

  L law;  ///< force law

  void check(std::string const& name) const { law.check(name, C::units); }
  /// True if the law stores all work that is done on it.
  bool is_lossless() const
    requires requires(L const& l) { l.is_lossless(); }
  {
    return law.is_lossless();
  }
  /// Initial states: zero for the angle of `OnTurns`, then those of the law.
  States initial_states() const {
    States z{};
    if constexpr (requires { law.initial_states(); }) {
      auto const own = law.initial_states();
      std::copy(own.begin(), own.end(), z.begin() + C::counts_turns);
    }
    return z;
  }

  template <StateScalar T>
  std::array<Wrench<T>, 2> wrenches(std::array<Frame<T>, 2> const& f, double t) const
    requires(states == 0)
  {
    return wrenches<T>(f, std::array<T, 0>{}, t);
  }
  template <StateScalar T>
  std::array<Wrench<T>, 2> wrenches(std::array<Frame<T>, 2> const& f, std::array<T, std::size_t(states)> const& z,
                                    double t) const {
    ConstraintTerms<1, T> const c = C::terms(f[0], f[1]);
    T const x = with_turns(c.g[0], z), rate = rate_of(c, f);
    T q;
    if constexpr (states_of<L>() == 0)
      q = law.template force<T>(x, rate, t);
    else
      q = law.template force<T>(x, rate, of_law(z), t);
    std::array<Wrench<T>, 2> w;
    for (int i = 0; i < 3; ++i) {
      w[0].f[i] = c.Ga(0, i) * q;
      w[0].m[i] = c.Ga(0, 3 + i) * q;
      w[1].f[i] = c.Gb(0, i) * q;
      w[1].m[i] = c.Gb(0, 3 + i) * q;
    }
    return w;
  }
  template <StateScalar T>
  std::array<T, std::size_t(states)> rates(std::array<Frame<T>, 2> const& f,
                                           std::array<T, std::size_t(states)> const& z, double t) const
    requires(states > 0)
  {
    ConstraintTerms<1, T> const c = C::terms(f[0], f[1]);
    T const rate = rate_of(c, f);
    std::array<T, std::size_t(states)> out;
    if constexpr (C::counts_turns) out[0] = rate;
    if constexpr (states_of<L>() > 0) {
      auto const own = law.template rates<T>(with_turns(c.g[0], z), rate, of_law(z), t);
      std::copy(own.begin(), own.end(), out.begin() + C::counts_turns);
    }
    return out;
  }

  /// Potential energy of the law [J].
  template <StateScalar T>
  T potential(std::array<Frame<T>, 2> const& f, double t) const
    requires(states == 0 && HasScalarPotential<L, T>)
  {
    return law.potential(C::terms(f[0], f[1]).g[0], t);
  }
  /// Potential energy of the law at the states z [J].
  double potential(std::array<Frame<double>, 2> const& f, States const& z, double t) const
    requires(states > 0 && (HasScalarPotential<L, double> || HasScalarStatePotential<L>))
  {
    double const x = with_turns(C::terms(f[0], f[1]).g[0], z);
    if constexpr (states_of<L>() == 0)
      return law.potential(x, t);
    else
      return law.potential(x, of_law(z), t);
  }
  /// Power that the states of the law dissipate [W].
  double dissipation([[maybe_unused]] std::array<Frame<double>, 2> const& f, [[maybe_unused]] States const& z,
                     [[maybe_unused]] double t) const
    requires(states > 0 && (HasScalarPotential<L, double> || HasScalarStatePotential<L>))
  {
    if constexpr (states_of<L>() == 0) {
      return 0.0;
    } else {
      auto const c = C::terms(f[0], f[1]);
      return law.dissipation(with_turns(c.g[0], z), rate_of(c, f), of_law(z), t);
    }
  }

 private:
  /// x, with the number of full turns for which it is nearest to the state z₀ = ∫ẋ dt.
  template <StateScalar T>
  static T with_turns(T const& x, [[maybe_unused]] std::array<T, std::size_t(states)> const& z) {
    if constexpr (C::counts_turns) {
      double const turn = 2.0 * std::numbers::pi;
      return x + turn * std::nearbyint((value_of(z[0]) - value_of(x)) / turn);
    } else {
      return x;
    }
  }
  template <StateScalar T>
  static T rate_of(ConstraintTerms<1, T> const& c, std::array<Frame<T>, 2> const& f) {
    T rate(0.0);
    for (int i = 0; i < 3; ++i)
      rate += c.Ga(0, i) * f[0].v[i] + c.Gb(0, i) * f[1].v[i] + c.Ga(0, 3 + i) * f[0].w[i] + c.Gb(0, 3 + i) * f[1].w[i];
    return rate;
  }
  template <StateScalar T>
  static std::array<T, std::size_t(states_of<L>())> of_law(std::array<T, std::size_t(states)> const& z) {
    std::array<T, std::size_t(states_of<L>())> own;
    std::copy(z.begin() + C::counts_turns, z.end(), own.begin());
    return own;
  }
};

/// Moment by the law L of the angle of b relative to a about the third axis of a, in (−π, π] [rad].
template <ScalarLaw L>
using OnAngle = ScalarForce<detail::AngleBetween, L>;
/// Moment by the law L of the angle of b relative to a with its full turns [rad]. The first state is ∫θ̇ dt and selects
/// the number of turns, so the angle itself does not drift. Initially its magnitude is at most half a turn; add
/// multiples of 2π to the state for another number of turns.
template <ScalarLaw L>
using OnTurns = ScalarForce<detail::TurnsBetween, L>;
/// Force by the law L of the translation of b relative to a along the third axis of a [m].
template <ScalarLaw L>
using OnTranslation = ScalarForce<detail::TranslationBetween, L>;
/// Force by the law L of the distance of two points [m]. Its direction is undefined if the points coincide.
template <ScalarLaw L>
using OnDistance = ScalarForce<detail::DistanceBetween, L>;

/// Creates a force on an angle from `law`, whose type is deduced.
template <ScalarLaw L>
OnAngle<L> on_angle(L const& law) {
  return {law};
}
/// Creates a force on an angle with its full turns from `law`, whose type is deduced.
template <ScalarLaw L>
OnTurns<L> on_turns(L const& law) {
  return {law};
}
/// Creates a force on a translation from `law`, whose type is deduced.
template <ScalarLaw L>
OnTranslation<L> on_translation(L const& law) {
  return {law};
}
/// Creates a force on a distance from `law`, whose type is deduced.
template <ScalarLaw L>
OnDistance<L> on_distance(L const& law) {
  return {law};
}

}  // namespace polybody
