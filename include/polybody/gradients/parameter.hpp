#pragma once
/// \file
/// Numbers of a model with respect to which a run is differentiated, and differences along them.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <polybody/math/errors.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// A number that a user's factory makes a model of: a length, a stiffness, a mass, an initial speed.
struct Parameter {
  std::string name;    ///< with its unit
  double value = 0.0;  ///< at which derivatives are taken, in the unit that its name tells
  double scale = 0.0;  ///< over which the model changes as a whole, in that unit; zero: as much as `value`
  /// Names of the bodies, joints and forces whose equations it changes; where none are named, all of them may change. A
  /// length changes those of its body and of the joints at its end. Parameters that touch nothing in common are
  /// differenced together, in four evaluations of the equations for all of them.
  std::vector<std::string> affects = {};

  /// The scale, or where there is none the amount of the value.
  double size() const { return scale > 0.0 ? scale : std::abs(value); }
  /// The distance of the differences by which the equations, never the run, are differentiated.
  double distance() const { return 4e-4 * size(); }
};

/// \throws InvalidInput unless parameters have names, all different, finite values and a scale where they are zero.
template <class = void>  // compiled where it is used
void check(std::vector<Parameter> const& parameters) {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    Parameter const& p = parameters[i];
    for (std::size_t j = 0; j < i; ++j)
      if (p.name == parameters[j].name)
        throw InvalidInput("parameter.name", {"Duplicate parameter name \"", ErrorObject{p.name}, "\"."});
    if (p.name.empty()) throw InvalidInput("parameter.name", {"Parameter ", ErrorValue{i}, " has no name."});
    if (!std::isfinite(p.value) || !std::isfinite(p.scale) || p.scale < 0.0)
      throw InvalidInput("parameter.value",
                         {"Parameter \"", ErrorObject{p.name},
                          "\": the value must be finite, and the scale finite and not negative, but they are ",
                          ErrorValue{p.value}, " and ", p.scale, "."});
    if (!(p.distance() > 0.0))
      throw InvalidInput("parameter.scale",
                         {"Parameter \"", ErrorObject{p.name},
                          "\" is zero and has no scale. Give the size over which the model changes with it."});
  }
}

/// f′(0) = [8 (f(e) − f(−e)) − (f(2e) − f(−2e))]/12e, of vectors, error e⁴ f⁽⁵⁾/30 [Abramowitz & Stegun 1964,
/// 25.3.21]: Σ weights f(places e)/e. In this order what does not change adds up to zero exactly.
struct FourPoints {
  /// Places of the points, in distances e.
  static constexpr std::array<double, 4> places{-1.0, 1.0, -2.0, 2.0};
  /// Weights of the values there, over e.
  static constexpr std::array<double, 4> weights{-8.0 / 12.0, 8.0 / 12.0, 1.0 / 12.0, -1.0 / 12.0};
};

}  // namespace polybody
