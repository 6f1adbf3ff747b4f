#pragma once
/// \file
/// Lists of the types of a model, and their properties.

#include <cstddef>
#include <type_traits>

#include <polybody/math/compiler.hpp>

namespace polybody {

/// List of types.
template <class... Ts>
struct TypeList {
  static constexpr std::size_t size = sizeof...(Ts);  ///< number of types
};

/// Number of occurrences of T in Ts.
template <class T, class... Ts>
inline constexpr std::size_t count_of = (std::size_t(std::is_same_v<T, Ts>) + ... + 0);

/// T occurs in Ts exactly once.
template <class T, class... Ts>
concept OneOf = count_of<T, Ts...> == 1;

namespace detail {
template <template <class...> class List, class Kept, class... Rest>
struct Gathered;
template <template <class...> class List, class... Kept>
struct Gathered<List, TypeList<Kept...>> {
  using Type = List<Kept...>;
};
template <template <class...> class List, class... Kept, class T, class... Rest>
struct Gathered<List, TypeList<Kept...>, T, Rest...>
    : Gathered<List, std::conditional_t<(std::is_same_v<T, Kept> || ...), TypeList<Kept...>, TypeList<Kept..., T>>,
               Rest...> {};
}  // namespace detail

/// `List<Ts…>` without duplicate types: `EachOnce<Bodies, Rigid<>, Link>` if `Link` may also be `Rigid<>`.
template <template <class...> class List, class... Ts>
using EachOnce = typename detail::Gathered<List, TypeList<>, Ts...>::Type;

/// Every type occurs in Ts only once.
template <class... Ts>
concept Distinct = ((count_of<Ts, Ts...> == 1) && ...);

}  // namespace polybody
