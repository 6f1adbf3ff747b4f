#pragma once
/// \file
/// Bodies with properties that are functions of time.

#include <concepts>

#include <polybody/math/compiler.hpp>

namespace polybody {

/// Body whose mass and forces change with time. `at_time(t)` returns the body at time t, with the same coordinates and
/// points. Every evaluation calls `at_time` and copies the result.
template <class B>
concept TimeVaryingBody = requires(B const b, double t) {
  { b.at_time(t) } -> std::same_as<B>;
};

/// Returns the body at time t [s]: `body.at_time(t)` for a `TimeVaryingBody`, otherwise `body` itself.
template <class B>
decltype(auto) at_time(B const& body, [[maybe_unused]] double t) {
  if constexpr (TimeVaryingBody<B>)
    return body.at_time(t);
  else
    return (body);
}

}  // namespace polybody
