#pragma once
/// \file
/// Conversion of a small number into a compile-time constant, so that loops of this length are unrolled.

#include <type_traits>

#include <polybody/math/compiler.hpp>

namespace polybody {

/// Calls f with the compile-time constant n for 1 ≤ n ≤ 6, and with the constant 0 for any other n.
template <class F>
auto with_constant(int n, F&& f) {
  switch (n) {
    case 1:
      return f(std::integral_constant<int, 1>{});
    case 2:
      return f(std::integral_constant<int, 2>{});
    case 3:
      return f(std::integral_constant<int, 3>{});
    case 4:
      return f(std::integral_constant<int, 4>{});
    case 5:
      return f(std::integral_constant<int, 5>{});
    case 6:
      return f(std::integral_constant<int, 6>{});
    default:
      return f(std::integral_constant<int, 0>{});
  }
}

}  // namespace polybody
