#pragma once
/// \file
/// Force elements that are defined by lambdas of the user, with or without first-order states.

#include <polybody/forces/force_element.hpp>

namespace polybody {

/// Force defined by the user: a generic lambda of N frames and time that returns N wrenches,
///   auto f = user_force<1>([](auto const& frames, double t) { … return std::array{w}; });
/// The scalar T of the frames is double or a dual number; the wrenches are `Wrench<T>`. Dual numbers provide the
/// tangent. The type `decltype(f)` must be in the model's `Forces<…>`.
template <int N, class Law>
struct UserForce {
  static constexpr int markers = N;
  static constexpr bool is_load = true;
  static constexpr MarkerKind needs = MarkerKind::point;

  Law law;  ///< lambda of the wrenches

  void check(std::string const&) const {}

  template <StateScalar T>
  std::array<Wrench<T>, N> wrenches(std::array<Frame<T>, N> const& frames, double t) const {
    return law(frames, t);
  }
};

/// Lambda of N frames and time that returns N wrenches, for frames and wrenches of the scalar T.
template <class Law, int N, class T>
concept WrenchLaw = requires(Law const law, std::array<Frame<T>, N> const frames, double t) {
  { law(frames, t) } -> std::convertible_to<std::array<Wrench<T>, N>>;
};

/// Creates a force on N markers from a lambda `law`: law(frames, t) returns their wrenches.
template <int N, class Law>
UserForce<N, Law> user_force(Law law) {
  static_assert(
      WrenchLaw<Law, N, double>,
      "The lambda of user_force<N> must accept (frames, t) and return std::array<Wrench<T>, N>, one wrench for "
      "each of the N markers.");
  static_assert(!WrenchLaw<Law, N, double> || WrenchLaw<Law, N, Dual<6 * N>>,
                "The lambda of user_force must return wrenches of the scalar T of its frames, because dual numbers "
                "provide the tangent. Replace Wrench<double> by Wrench<T>, T = "
                "std::decay_t<decltype(frames[0].r[0])>.");
  return {std::move(law)};
}

/// Force defined by the user with S first-order states, by two generic lambdas of frames, states and time,
///   auto f = user_force<2, 1>([](auto const& frames, auto const& z, double t) { … return std::array{w_a, w_b}; },
///                             [](auto const& frames, auto const& z, double t) { … return std::array{rate}; });
/// The states have the scalar type of the frames.
template <int N, int S, class Law, class Rates>
struct UserForceWithStates {
  static constexpr int markers = N;
  static constexpr int states = S;
  static constexpr bool is_load = true;
  static constexpr MarkerKind needs = MarkerKind::point;

  Law law;          ///< lambda of the wrenches
  Rates rates_law;  ///< lambda of the rates

  void check(std::string const&) const {}

  template <StateScalar T>
  std::array<Wrench<T>, N> wrenches(std::array<Frame<T>, N> const& frames, std::array<T, S> const& z, double t) const {
    return law(frames, z, t);
  }
  template <StateScalar T>
  std::array<T, S> rates(std::array<Frame<T>, N> const& frames, std::array<T, S> const& z, double t) const {
    return rates_law(frames, z, t);
  }
};

/// Creates a force on N markers with S first-order states from two lambdas: law(frames, z, t) returns the wrenches,
/// rates(frames, z, t) returns ż.
template <int N, int S, class Law, class Rates>
UserForceWithStates<N, S, Law, Rates> user_force(Law law, Rates rates) {
  return {std::move(law), std::move(rates)};
}

}  // namespace polybody
