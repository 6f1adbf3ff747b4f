#pragma once
/// \file
/// Points of a study on grids and from lists.
///
/// Not in polybody.hpp: only studies need it.

#include <polybody/study/points.hpp>
#include <polybody/study/portable.hpp>

namespace polybody {

/// Equidistant values: `count` values from `first` to `last`. The intermediate values are rounded to twelve digits.
/// \throws InvalidInput for less than two values, and ends that are not finite.
template <class = void>  // compiled where it is used
std::vector<double> linear(double first, double last, std::size_t count) {
  if (count < 2 || !std::isfinite(first) || !std::isfinite(last))
    throw InvalidInput("points.range", {"study: linear(", first, ", ", last, ", ", ErrorValue{count},
                                        ") needs finite ends and at least two values."});
  std::vector<double> values(count, first);
  for (std::size_t k = 1; k + 1 < count; ++k)
    values[k] = detail::of_twelve_digits(std::fma(double(k) / double(count - 1), last - first, first));
  values.back() = last;
  return values;
}

/// Values with equal ratios (a geometric sequence): `count` values from `first` to `last`.
/// \throws InvalidInput for ends that are not positive.
template <class = void>
std::vector<double> logarithmic(double first, double last, std::size_t count) {
  if (!(first > 0.0 && last > 0.0))
    throw InvalidInput("points.range",
                       {"study: logarithmic(", ErrorValue{first}, ", ", last, ", ", count, ") needs positive ends."});
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
      throw InvalidInput("points.size", {"study: a point of the list has ", ErrorValue{row.size()}, " values for ",
                                         columns.size(), " columns."});
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
