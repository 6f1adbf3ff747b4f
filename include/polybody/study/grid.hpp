#pragma once
/// \file
/// Points of a study on grids and from lists, and the elementary functions that compute them.

#include <charconv>
#include <cmath>
#include <numbers>

#include <polybody/math/compiler.hpp>
#include <polybody/study/points.hpp>

namespace polybody::detail {

// Elementary functions with bitwise identical results on every machine, for the points of studies. The functions of
// C libraries differ in the last bit. In contrast, +, −, ×, ÷, √ and fma are rounded identically everywhere (IEEE
// 754; not under -ffast-math). The source writes each sum with a product as an fma, so the result does not depend on
// the compiler.

/// Logarithm ln x of a positive x = m·2ᵏ with √½ ≤ m < √2: ln x = k ln 2 + ln m with ln m = 2 artanh((m − 1)/(m + 1)).
template <class = void>  // compiled where it is used
double portable_log(double x) {
  int k = 0;
  double m = std::frexp(x, &k);
  if (m < 0.5 * std::numbers::sqrt2) m *= 2.0, --k;
  double const s = (m - 1.0) / (m + 1.0), square = s * s;  // s² < 0.0295
  double sum = 1.0 / 23.0;
  for (int n = 21; n > 0; n -= 2) sum = std::fma(sum, square, 1.0 / n);
  return std::fma(double(k), std::numbers::ln2, 2.0 * s * sum);
}

/// Exponential eˣ = 2ᵏ eʳ with an integer k, |r| ≤ ½ ln 2 and the power series of eʳ.
template <class = void>
double portable_exp(double x) {
  double const k = std::nearbyint(x / std::numbers::ln2);
  if (k > 1100.0) return HUGE_VAL;
  if (k < -1100.0) return 0.0;
  constexpr double rest_of_ln2 = 2.3190468138462996e-17;  // ln 2 − std::numbers::ln2
  double const r = std::fma(-k, rest_of_ln2, std::fma(-k, std::numbers::ln2, x));
  double sum = 1.0;
  for (int n = 16; n > 0; --n) sum = std::fma(sum, r / n, 1.0);
  return std::ldexp(sum, static_cast<int>(k));
}

/// Distribution function Φ(x) of a standard normal variable for x ≤ 0: ½ + φ Σ x²ᵏ⁺¹/(1·3·…·(2k+1)), or φ/(|x| + 1/(|x|
/// + 2/(|x| + …))) in the tail [Abramowitz & Stegun 1964, 26.2.11, 26.2.14]. φ is the `density` of the normal
/// distribution at x.
template <class = void>
double normal_share(double x, double density) {
  if (x > -3.0) {
    double const square = x * x;
    double term = x, sum = x;
    for (int n = 3; n < 99; n += 2) {
      sum = std::fma(term, square / n, sum);
      term *= square / n;
    }
    return std::fma(density, sum, 0.5);
  }
  double fraction = -x;
  for (int n = 150; n > 0; --n) fraction = n / fraction - x;
  return density / fraction;
}

/// Quantile of the standard normal distribution: x with Φ(x) = u, 0 < u < 1. Newton's method solves ln Φ(x) = ln u. The
/// function ln Φ is concave, so iterates that start left of the root remain left of the root. The initial value is left
/// of the root because Φ(−t) ≤ ½ exp(−t²/2).
template <class = void>
double normal_quantile(double u) {
  if (u > 0.5) return -normal_quantile(1.0 - u);
  if (u == 0.5) return 0.0;
  double const log_u = portable_log(u);
  double x = -std::sqrt(-2.0 * portable_log(2.0 * u));
  for (int i = 0; i < 60; ++i) {
    double const density = portable_exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
    double const share = normal_share(x, density);
    double const next = std::fma(log_u - portable_log(share), share / density, x);
    if (!(next > x)) break;
    x = next;
  }
  return x;
}

/// Number with twelve significant digits closest to x: 10⁷ and 0.3 instead of 9999999.999999998 and
/// 0.30000000000000004.
template <class = void>
double of_twelve_digits(double x) {
  char digits[40];
  char const* const end = std::to_chars(digits, digits + sizeof digits, x, std::chars_format::scientific, 11).ptr;
  std::from_chars(digits, end, x);
  return x;
}

}  // namespace polybody::detail

namespace polybody {

/// Equidistant values: `count` values from `first` to `last`. The intermediate values are rounded to twelve significant
/// digits.
/// \throws InvalidInput for fewer than two values, or if `first` or `last` is not finite.
template <class = void>  // compiled where it is used
std::vector<double> linear(double first, double last, std::size_t count) {
  if (count < 2 || !std::isfinite(first) || !std::isfinite(last))
    throw InvalidInput("points.range", {"study: linear(", first, ", ", last, ", ", ErrorValue{count},
                                        ") needs finite first and last values, and at least two values."});
  std::vector<double> values(count, first);
  for (std::size_t k = 1; k + 1 < count; ++k)
    values[k] = detail::of_twelve_digits(std::fma(double(k) / double(count - 1), last - first, first));
  values.back() = last;
  return values;
}

/// Values with equal ratios (a geometric sequence): `count` values from `first` to `last`.
/// \throws InvalidInput if `first` or `last` is not positive, and like `linear`.
template <class = void>
std::vector<double> logarithmic(double first, double last, std::size_t count) {
  if (!(first > 0.0 && last > 0.0))
    throw InvalidInput("points.range", {"study: logarithmic(", ErrorValue{first}, ", ", last, ", ", count,
                                        ") needs positive first and last values."});
  std::vector<double> values = linear(first, last, count);  // checks the arguments; first and last value are kept
  double const from = detail::portable_log(first), to = detail::portable_log(last);
  for (std::size_t k = 1; k + 1 < count; ++k)
    values[k] =
        detail::of_twelve_digits(detail::portable_exp(std::fma(double(k) / double(count - 1), to - from, from)));
  return values;
}

/// Points of one parameter with this `name`, `unit` and `values`: axis("step", "s", {1e-3, 1e-4}).
template <class = void>
Points axis(std::string name, std::string unit, std::vector<double> values) {
  return {{{.name = std::move(name), .unit = std::move(unit)}}, std::move(values), "grid"};
}

/// Points of one parameter with named `choices`: formulations("integrator", {"Radau", "HHT"}). See `Point::with`.
template <class = void>
Points formulations(std::string name, std::vector<std::string> choices) {
  std::vector<double> values(choices.size());
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = double(k);
  return {{{.name = std::move(name), .choices = std::move(choices)}}, std::move(values), "grid"};
}

/// Points from a list of `rows`; each row has a value for each column.
template <class = void>
Points list(std::vector<Column> columns, std::vector<std::vector<double>> const& rows) {
  std::vector<double> values;
  for (std::vector<double> const& row : rows) {
    if (row.size() != columns.size())
      throw InvalidInput("points.size", {"study: a point of the list has ", ErrorValue{row.size()},
                                         " values, but the points have ", columns.size(), " columns."});
    values.insert(values.end(), row.begin(), row.end());
  }
  return {std::move(columns), std::move(values), "list"};
}

/// Grid of a single set of points: returns this set.
template <class = void>
Points grid(Points const& points) {
  return points;
}
/// Product of two sets of points: every point of the first with every point of the second. The second varies faster.
template <class = void>
Points grid(Points const& first, Points const& second) {
  std::vector<Column> columns = first.columns();
  columns.insert(columns.end(), second.columns().begin(), second.columns().end());
  std::vector<double> values;
  for (std::size_t i = 0; i < first.size(); ++i)
    for (std::size_t j = 0; j < second.size(); ++j) {
      for (std::size_t k = 0; k < first.columns().size(); ++k) values.push_back(first.at(i, k));
      for (std::size_t k = 0; k < second.columns().size(); ++k) values.push_back(second.at(j, k));
    }
  std::string const one = first.origin(), other = second.origin();
  return {std::move(columns), std::move(values), one == other ? one : one + " x " + other};
}
/// Product of several sets of points, `first`, `second` and `others`. Axes, formulations, lists and samples may be
/// combined: grid(axis(…), formulations(…), latin_hypercube(…)).
template <class... Others>
Points grid(Points const& first, Points const& second, Others const&... others) {
  return grid(grid(first, second), others...);
}

}  // namespace polybody
