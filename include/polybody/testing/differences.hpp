#pragma once
/// \file
/// Derivatives by central differences of fourth order.
///
/// For tests; not included by polybody.hpp.

#include <polybody/math/compiler.hpp>

namespace polybody::laws {

/// Derivative f′(0) of a function of one number, with values in double or in Eigen vectors:
/// [8 (f(h) − f(−h)) − (f(2h) − f(−2h))]/12h, error h⁴ f⁽⁵⁾/30  [Abramowitz & Stegun 1964, 25.3.21].
template <class F>
auto slope_at_zero(F&& f, double h = 1e-3) {
  using Value = decltype(f(h));
  Value const near = f(h) - f(-h), far = f(2 * h) - f(-2 * h);
  return Value((near * 8.0 - far) / (12.0 * h));
}

}  // namespace polybody::laws
