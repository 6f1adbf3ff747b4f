#pragma once
/// \file
/// Units of the coordinates and generalised velocities of a body.

#include <concepts>

#include <polybody/math/types.hpp>

namespace polybody {

/// Body that declares the units of its coordinates. A body whose generalised velocities are not the rates of the
/// coordinates also declares their units (`velocity_unit`). The headings of state tables contain the units
/// (io/state_table.hpp).
template <class B>
concept HasCoordinateUnits = requires(B const b, Index i) {
  { b.coordinate_unit(i) } -> std::convertible_to<char const*>;
};

/// Functions that return the units of the coordinates of a body with erased type.
struct CoordinateUnits {
  /// Unit of coordinate i, such as "m"; null if the body declares no units.
  char const* (*of_coordinate)(void const* body, Index i) = nullptr;
  /// Unit of generalised velocity i, such as "rad/s"; null if the generalised velocities are the rates of the
  /// coordinates.
  char const* (*of_velocity)(void const* body, Index i) = nullptr;
};

/// Unit functions for a body of type B.
template <class B>
constexpr CoordinateUnits units_of() {
  CoordinateUnits units;
  if constexpr (HasCoordinateUnits<B>)
    units.of_coordinate = [](void const* body, Index i) -> char const* {
      return static_cast<B const*>(body)->coordinate_unit(i);
    };
  if constexpr (requires(B const b) { b.velocity_unit(Index()); })
    units.of_velocity = [](void const* body, Index i) -> char const* {
      return static_cast<B const*>(body)->velocity_unit(i);
    };
  return units;
}

}  // namespace polybody
