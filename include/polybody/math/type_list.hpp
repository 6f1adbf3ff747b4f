#pragma once
/// \file
/// Type lists of a model and questions about them.

#include <cstddef>
#include <type_traits>

namespace polybody {

template <class... Ts>
struct TypeList {
  static constexpr std::size_t size = sizeof...(Ts);
};

/// How often T stands among Ts.
template <class T, class... Ts>
inline constexpr std::size_t count_of = (std::size_t(std::is_same_v<T, Ts>) + ... + 0);

/// T stands among Ts exactly once.
template <class T, class... Ts>
concept OneOf = count_of<T, Ts...> == 1;

/// Every type of Ts stands once.
template <class... Ts>
concept Distinct = ((count_of<Ts, Ts...> == 1) && ...);

}  // namespace polybody
