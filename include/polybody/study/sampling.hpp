#pragma once
/// \file
/// Points by Monte Carlo and Latin hypercube sampling. Points of the same seed are bitwise identical on every machine.
/// The generator is std::mt19937_64, whose numbers are fixed by the standard. No distribution of the standard library
/// is used.

#include <cstdint>
#include <functional>
#include <random>

#include <polybody/study/grid.hpp>

namespace polybody {

/// Uncertain parameter, given by its distribution.
struct RandomAxis {
  Column column;                           ///< name and unit
  std::function<double(double)> quantile;  ///< value that is not exceeded with probability u, 0 < u < 1
};

/// Uniform distribution between `low` and `high` [unit].
/// \throws InvalidInput unless low < high, both finite.
template <class = void>  // compiled where it is used
RandomAxis uniform(std::string name, std::string unit, double low, double high) {
  if (!(low < high && std::isfinite(high - low)))
    throw InvalidInput("distribution.range",
                       {"study: the range of \"", ErrorObject{name},
                        "\" must be finite with the lower end first, but is ", ErrorValue{low}, " to ", high, "."});
  return {{.name = std::move(name), .unit = std::move(unit)}, [=](double u) { return std::fma(u, high - low, low); }};
}

/// Log-uniform distribution between `low` and `high` [unit]: the logarithm is uniformly distributed.
/// \throws InvalidInput unless 0 < low < high, both finite.
template <class = void>
RandomAxis log_uniform(std::string name, std::string unit, double low, double high) {
  if (!(low > 0.0 && low < high && std::isfinite(high)))
    throw InvalidInput("distribution.range", {"study: the logarithmic range of \"", ErrorObject{name},
                                              "\" must be positive and finite with the lower end first, but is ",
                                              ErrorValue{low}, " to ", high, "."});
  double const from = detail::portable_log(low), to = detail::portable_log(high);
  return {{.name = std::move(name), .unit = std::move(unit)},
          [=](double u) { return std::clamp(detail::portable_exp(std::fma(u, to - from, from)), low, high); }};
}

/// Normal distribution with this `mean` and standard `deviation` [unit], without bounds.
/// \throws InvalidInput unless the mean and the standard deviation are finite and the standard deviation is positive.
template <class = void>
RandomAxis normal(std::string name, std::string unit, double mean, double deviation) {
  if (!(deviation > 0.0 && std::isfinite(deviation) && std::isfinite(mean)))
    throw InvalidInput(
        "distribution.deviation",
        {"study: \"", ErrorObject{name}, "\" needs a finite mean and a positive, finite standard deviation, but has ",
         mean, " and ", ErrorValue{deviation}, "."});
  return {{.name = std::move(name), .unit = std::move(unit)},
          [=](double u) { return std::fma(detail::normal_quantile(u), deviation, mean); }};
}

namespace detail {

/// Random number from 2⁵² equidistant numbers in (0, 1).
template <class = void>
double unit_sample(std::mt19937_64& generator) {
  return (double(generator() >> 12) + 0.5) * 0x1p-52;
}

/// Random integer from 0 … n − 1, with equal probabilities. Draws that would favour some integers are repeated.
template <class = void>
std::size_t sample_below(std::mt19937_64& generator, std::uint64_t n) {
  std::uint64_t const usable = UINT64_MAX - (UINT64_MAX % n + 1) % n;
  std::uint64_t draw = generator();
  while (draw > usable) draw = generator();
  return static_cast<std::size_t>(draw % n);
}

/// Points from the quantiles of samples u (points × axes).
template <class = void>
Points sampled(std::vector<double> u, std::vector<RandomAxis> const& axes, std::string origin) {
  std::vector<Column> columns;
  for (RandomAxis const& axis : axes) columns.push_back(axis.column);
  for (std::size_t k = 0; k < u.size(); ++k) u[k] = axes[k % axes.size()].quantile(u[k]);
  return {std::move(columns), std::move(u), std::move(origin)};
}

}  // namespace detail

/// Monte Carlo sample of `count` independent points, with the random numbers of `seed`. A smaller sample with the
/// same seed and axes equals the first points of a larger one.
/// \throws InvalidInput for no point or no axis.
template <class = void>
Points monte_carlo(std::size_t count, std::uint64_t seed, std::vector<RandomAxis> const& axes) {
  std::mt19937_64 generator(seed);
  std::vector<double> u(count * axes.size());
  for (double& x : u) x = detail::unit_sample(generator);
  return detail::sampled(std::move(u), axes, "Monte Carlo, seed " + std::to_string(seed));
}

/// Latin hypercube sample of `count` points, with the random numbers of `seed`. Each axis has `count` strata of equal
/// probability, with one point at a random position in each stratum. Strata of different axes are paired at random.
/// [McKay, Beckman & Conover 1979]
/// \throws InvalidInput for no point, no axis, and more than 2²⁰ points.
template <class = void>
Points latin_hypercube(std::size_t count, std::uint64_t seed, std::vector<RandomAxis> const& axes) {
  if (count > 1u << 20)
    throw InvalidInput("points.size", {"study: a Latin hypercube has at most 1048576 points, but ", ErrorValue{count},
                                       " are requested."});
  std::mt19937_64 generator(seed);
  std::vector<double> u(count * axes.size());
  std::vector<std::size_t> strata(count);
  for (std::size_t j = 0; j < axes.size(); ++j) {
    for (std::size_t i = 0; i < count; ++i) strata[i] = i;
    for (std::size_t i = count; i > 1; --i) std::swap(strata[i - 1], strata[detail::sample_below(generator, i)]);
    for (std::size_t i = 0; i < count; ++i) {
      double const within = (double(generator() >> 34) + 0.5) * 0x1p-30;  // exact with the 20 bits of a stratum
      u[i * axes.size() + j] = (double(strata[i]) + within) / double(count);
    }
  }
  return detail::sampled(std::move(u), axes, "Latin hypercube, seed " + std::to_string(seed));
}

}  // namespace polybody
