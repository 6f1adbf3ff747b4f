#pragma once
#include <polybody/forces/force_element.hpp>

namespace polybody {

/// A user's force: a generic lambda over N frames and time that returns N wrenches,
///   auto f = user_force<1>([](auto const& frames, double t) { … return std::array{w}; });
/// where the scalar of the frames may be double or a dual number: `Wrench<T>` with the T of the frames.
/// Its tangent comes from dual numbers. `decltype(f)` goes into the model's `Forces<…>`.
template <int N, class Law>
struct UserForce {
  static constexpr int markers = N;
  static constexpr bool is_load = true;
  static constexpr Observes needs = Observes::point;

  Law law;  ///< the lambda

  void check(std::string const&) const {}

  template <StateScalar T>
  std::array<Wrench<T>, N> wrenches(std::array<Frame<T>, N> const& frames, double t) const {
    return law(frames, t);
  }
};

/// A force of N markers from a lambda `law`: law(frames, t) gives their wrenches.
template <int N, class Law>
UserForce<N, Law> user_force(Law law) {
  return {std::move(law)};
}

/// A user's force with S first-order states, by two generic lambdas over frames, states and time,
///   auto f = user_force<2, 1>([](auto const& frames, auto const& z, double t) { … return std::array{w_a, w_b}; },
///                             [](auto const& frames, auto const& z, double t) { … return std::array{rate}; });
/// where the states have the scalar of the frames.
template <int N, int S, class Law, class Rates>
struct UserForceWithStates {
  static constexpr int markers = N;
  static constexpr int states = S;
  static constexpr bool is_load = true;
  static constexpr Observes needs = Observes::point;

  Law law;          ///< the lambda of the wrenches
  Rates rates_law;  ///< the lambda of the rates

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

/// A force of N markers with S first-order states from two lambdas: law(frames, z, t) gives wrenches, rates(frames, z,
/// t) ż.
template <int N, int S, class Law, class Rates>
UserForceWithStates<N, S, Law, Rates> user_force(Law law, Rates rates) {
  return {std::move(law), std::move(rates)};
}

}  // namespace polybody
