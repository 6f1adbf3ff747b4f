#pragma once
/// \file
/// Bodies that are others at other times.

#include <concepts>

namespace polybody {

/// A body whose mass and forces change with time: at_time(t) is the body that it is then. Its coordinates and points
/// stay what they are. It is asked in every evaluation, and copied.
template <class B>
concept ChangesWithTime = requires(B const b, double t) {
  { b.at_time(t) } -> std::same_as<B>;
};

/// The body at time t [s]: itself, but for one that changes.
template <class B>
decltype(auto) at_time(B const& body, [[maybe_unused]] double t) {
  if constexpr (ChangesWithTime<B>)
    return body.at_time(t);
  else
    return (body);
}

}  // namespace polybody
