#pragma once
/// \file
/// Parameters of a model with respect to which a run is differentiated, and difference formulas for them.
/// Theory: Eq. 8.17.

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <polybody/math/errors.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// Number from which the factory of the user makes a model: a length, a stiffness, a mass, an initial velocity.
struct Parameter {
  std::string name;    ///< name with unit
  double value = 0.0;  ///< value at which derivatives are computed, in the unit given in `name`
  double scale = 0.0;  ///< change that alters results by about their own size, in the unit of `value`; 0: |value|
  /// Names of the bodies, joints and forces that depend on the parameter. If the list is empty, all equations may
  /// depend on the parameter. For example, the length of a rod affects the rod and the joint at its end. Parameters
  /// that affect no common equation are differenced together, with four evaluations of the equations for all of them.
  std::vector<std::string> affects = {};

  /// The scale, or |value| if the scale is zero.
  double size() const { return scale > 0.0 ? scale : std::abs(value); }
  /// Distance e between the points of the differences of the equations (`FourPoints`). The run itself is not
  /// differenced.
  double distance() const { return 4e-4 * size(); }
};

/// \throws InvalidInput unless all parameters have different, nonempty names, finite values, and finite scales that are
/// not negative. A parameter with the value zero also needs a positive scale.
template <class = void>  // compiled where it is used
void check(std::vector<Parameter> const& parameters) {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    Parameter const& p = parameters[i];
    for (std::size_t j = 0; j < i; ++j)
      if (p.name == parameters[j].name)
        throw InvalidInput("parameter.name",
                           {"Duplicate parameter name \"", ErrorObject{p.name}, "\". Use another name."});
    if (p.name.empty())
      throw InvalidInput("parameter.name", {"Parameter ", ErrorValue{i}, ", counted from 0, has no name. Set `name`."});
    if (!std::isfinite(p.value) || !std::isfinite(p.scale) || p.scale < 0.0)
      throw InvalidInput("parameter.value",
                         {"Parameter \"", ErrorObject{p.name},
                          "\": the value must be finite, and the scale finite and not negative, but they are ",
                          ErrorValue{p.value}, " and ", p.scale, "."});
    if (!(p.distance() > 0.0))
      throw InvalidInput("parameter.scale",
                         {"Parameter \"", ErrorObject{p.name},
                          "\" is zero and has no scale. Set `scale` to a change that alters results by about their "
                          "own size."});
  }
}

/// Difference formula f′(0) = [8 (f(e) − f(−e)) − (f(2e) − f(−2e))]/12e with the error e⁴ f⁽⁵⁾/30 [Abramowitz & Stegun
/// 1964, 25.3.21], for numbers and vectors f, as the sum Σ weights f(places e)/e. In this order of the points, the sum
/// for a constant f is exactly zero.
struct FourPoints {
  /// Positions of the points, in multiples of e.
  static constexpr std::array<double, 4> places{-1.0, 1.0, -2.0, 2.0};
  /// Weights of the values at the points; to be divided by e.
  static constexpr std::array<double, 4> weights{-8.0 / 12.0, 8.0 / 12.0, 1.0 / 12.0, -1.0 / 12.0};
};

}  // namespace polybody
