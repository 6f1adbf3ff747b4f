#pragma once
/// \file
/// Type lists of a model and questions about them.

#include <cstddef>
#include <type_traits>

namespace polybody {

/// A list of types.
template <class... Ts>
struct TypeList {
  static constexpr std::size_t size = sizeof...(Ts);  ///< how many types it lists
};

/// How often T stands among Ts.
template <class T, class... Ts>
inline constexpr std::size_t count_of = (std::size_t(std::is_same_v<T, Ts>) + ... + 0);

/// T stands among Ts exactly once.
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

/// `List<Ts…>` with each type once: `EachOnce<Bodies, Rigid<>, Link>` where a link may be a `Rigid<>` too.
template <template <class...> class List, class... Ts>
using EachOnce = typename detail::Gathered<List, TypeList<>, Ts...>::Type;

/// Every type of Ts stands once.
template <class... Ts>
concept Distinct = ((count_of<Ts, Ts...> == 1) && ...);

}  // namespace polybody
