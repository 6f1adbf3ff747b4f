#pragma once
/// \file Names of the parameters of scalar laws in error messages.

#include <polybody/parts.hpp>

#include "support/parameters.hpp"

namespace polybody {

template <class C, class L>
inline constexpr auto words_of<ScalarForce<C, L>> = words("law");
template <>
inline constexpr auto words_of<LinearSpring> = words("stiffness", "damping", "free coordinate");
template <>
inline constexpr auto words_of<TwoSlopeSpring> =
    words("stiffness above", "stiffness below", "damping rising", "damping falling", "free coordinate");
template <>
inline constexpr auto words_of<TableSpring> = words("table", "damping");
template <>
inline constexpr auto words_of<TableDamper> = words("table");
template <class F>
inline constexpr auto words_of<FunctionSpring<F>> = words("function");
template <>
inline constexpr auto words_of<Rope> = words("stiffness", "damping", "length");
template <class Law>
inline constexpr auto words_of<Winch<Law>> = words("axial stiffness", "damping", "length", "reeled");
template <>
inline constexpr auto words_of<Limit> = words("lower limit", "upper limit", "stiffness", "damping", "onset");
template <>
inline constexpr auto words_of<Backlash> = words("play|limit", "centre|limit", "stiffness", "damping", "onset");
template <>
inline constexpr auto words_of<BumpStop> = words("lower limit", "upper limit", "stiffness", "exponent", "damping");
template <>
inline constexpr auto words_of<LimitImpact> =
    words("lower limit|a limit of an angle", "upper limit|a limit of an angle", "restitution");

}  // namespace polybody
