#pragma once
/// \file
/// What coordinates and speeds of a body are measured in.

#include <concepts>

#include <polybody/math/types.hpp>

namespace polybody {

/// A body may name the units of its coordinates, and those of its speeds where they are not the coordinates' rates:
/// tables of states have them in their heads (io/state_table.hpp).
template <class B>
concept NamesUnits = requires(B const b, Index i) {
  { b.coordinate_unit(i) } -> std::convertible_to<char const*>;
};

/// Asks a body whose type is forgotten.
struct CoordinateUnits {
  /// Unit of coordinate i, such as "m"; none of a body that does not name it.
  char const* (*of_coordinate)(void const* body, Index i) = nullptr;
  /// Unit of speed i, such as "rad/s"; none where speeds are the coordinates' rates.
  char const* (*of_speed)(void const* body, Index i) = nullptr;
};

/// Those of a body of type B.
template <class B>
constexpr CoordinateUnits units_of() {
  CoordinateUnits units;
  if constexpr (NamesUnits<B>)
    units.of_coordinate = [](void const* body, Index i) -> char const* {
      return static_cast<B const*>(body)->coordinate_unit(i);
    };
  if constexpr (requires(B const b) { b.speed_unit(Index()); })
    units.of_speed = [](void const* body, Index i) -> char const* {
      return static_cast<B const*>(body)->speed_unit(i);
    };
  return units;
}

}  // namespace polybody
