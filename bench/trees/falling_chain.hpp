#pragma once
// Data of the chain of bench/trees.cpp, links on pins that fall from a horizontal start, and the measurement of times.
// In C++17 and without any library.
#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <utility>

namespace falling_chain {

constexpr double length = 0.1, mass = 1.0, weight = 9.81;   // [m], [kg], [m/s²]
constexpr std::array<double, 3> moments{1e-4, 1e-3, 1e-3};  // about the centre of mass [kg m²]

/// Angles and rates of a bent chain in motion, so that no number is zero.
inline double angle(int i) { return 0.3 * std::sin(1.0 * i); }
inline double rate(int i) { return 0.5 * std::cos(2.0 * i); }

/// Centre of mass of the last link [m].
using Tip = std::array<double, 2>;
inline double apart(Tip const& a, Tip const& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

/// Result of one second of motion at one tolerance: processor time [s] and position of the tip.
struct Second {
  double seconds = 0.0;
  Tip tip = {};
};
/// Result of a call for the accelerations of the bent chain: processor time [s] and acceleration of the last joint
/// [rad/s²].
struct Call {
  double seconds = 0.0, last = 0.0;
};

/// Processor time of this program [s].
inline double now() { return double(std::clock()) / CLOCKS_PER_SEC; }
/// Processor time of one pass in the fastest of `rounds` rounds [s].
template <class F>
double fastest(int rounds, int passes, F&& pass) {
  double best = 1e300;
  for (int i = 0; i < rounds; ++i) {
    double const start = now();
    for (int k = 0; k < passes; ++k) pass();
    best = std::min(best, (now() - start) / passes);
  }
  return best;
}

}  // namespace falling_chain
