#pragma once
// Data and measured functions of the chain of bench/trees.cpp, links on pins that fall from a horizontal start. In
// C++17 and without any library.
#include <array>
#include <cmath>
#include <functional>

namespace falling_chain {

constexpr double length = 0.1, mass = 1.0, weight = 9.81;   // [m], [kg], [m/s²]
constexpr std::array<double, 3> moments{1e-4, 1e-3, 1e-3};  // about the centre of mass [kg m²]

/// Angles and rates of a bent chain in motion, so that no number is zero.
inline double angle(int i) { return 0.3 * std::sin(1.0 * i); }
inline double rate(int i) { return 0.5 * std::cos(2.0 * i); }

/// Centre of mass of the last link [m].
using Tip = std::array<double, 2>;

/// Evaluates the accelerations of the bent chain; returns that of the last joint [rad/s²].
using Call = std::function<double()>;
/// One second of motion with a relative tolerance; returns the position of the tip.
using Second = std::function<Tip(double tolerance)>;

}  // namespace falling_chain
