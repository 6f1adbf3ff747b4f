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

  Law law;

  void check(std::string const&) const {}

  template <StateScalar T>
  std::array<Wrench<T>, N> wrenches(std::array<Frame<T>, N> const& frames, double t) const {
    return law(frames, t);
  }
};

template <int N, class Law>
UserForce<N, Law> user_force(Law law) {
  return {std::move(law)};
}

}  // namespace polybody
