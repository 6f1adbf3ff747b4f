#pragma once
/// \file
/// Units of finite element models: conversion to SI units, and guesses of the units of a file.

#include <polybody/bodies/fe/fe_matrix.hpp>

namespace polybody {

/// Nodes, mass matrix and stiffness of a finite element model.
struct FeModel {
  FeNodes nodes;       ///< labels and positions
  FeMatrix mass;       ///< consistent or lumped mass matrix
  FeMatrix stiffness;  ///< stiffness without fixed displacements
};

/// Units of the files of a finite element model, in SI units. The unit of the stiffness is force/length.
struct FeUnits {
  double length;  ///< unit of length of the nodes [m]
  double mass;    ///< unit of the mass matrix [kg]
  double force;   ///< unit of force of the stiffness [N]
  /// Factor of the stiffness to N/m.
  double stiffness() const { return force / length; }
};

inline constexpr FeUnits si_units{1.0, 1.0, 1.0};              ///< metre, kilogram, newton
inline constexpr FeUnits mm_tonne_newton{1e-3, 1e3, 1.0};      ///< millimetre, tonne, newton
inline constexpr FeUnits mm_kilogram_kilonewton{1e-3, 1, 1e3};  ///< millimetre, kilogram, kilonewton (time in ms)
/// Inch, pound-force s²/inch (12 slugs), pound-force.
inline constexpr FeUnits inch_pound_force{0.0254, 175.126835246476, 4.4482216152605};

/// Model in SI units from a model in the `units` of its files.
/// \throws InvalidInput for a unit that is not positive and finite.
template <class = void>  // compiled only if used
FeModel in_si(FeModel model, FeUnits const& units) {
  for (double const unit : {units.length, units.mass, units.force})
    if (!(unit > 0.0) || !std::isfinite(unit))
      throw InvalidInput("fe.unit", {ErrorObject{"FeUnits"}, ": a unit must be positive and finite, but one is ",
                                     ErrorValue{unit}, "."});
  for (Vec3& r : model.nodes.positions) r *= units.length;
  model.mass.entries *= units.mass;
  model.stiffness.entries *= units.stiffness();
  return model;
}

namespace detail {

/// Units that a file may have: factors of nodes, mass matrix and stiffness to SI units.
struct UnitGuess {
  char const* name;
  double length, mass, stiffness;
};

/// Guess with which waves travel at 1 to 13 km/s and the mass is `given` [kg] to 20 %, for a model with the wave speed
/// `speed` and the mass `mass` in the units of its files; null if there is none.
inline UnitGuess const* unit_guess(double speed, double mass, double given) {
  static constexpr UnitGuess guesses[] = {
      {"the nodes in metres, the masses in kilograms, the stiffness in N/m", 1.0, 1.0, 1.0},
      {"the nodes in millimetres, the masses in tonnes, the stiffness in N/mm", 1e-3, 1e3, 1e3},
      {"the nodes in millimetres, the masses in kilograms, the stiffness in kN/mm", 1e-3, 1.0, 1e6},
      {"the nodes in millimetres, the masses in kilograms, the stiffness in N/m", 1e-3, 1.0, 1.0},
      {"the nodes in metres, the masses in kilograms, the stiffness in N/mm", 1.0, 1.0, 1e3},
      {"the nodes in millimetres, the masses in kilograms, the stiffness in N/mm", 1e-3, 1.0, 1e3},
      {"the nodes in metres, the masses in tonnes, the stiffness in N/mm", 1.0, 1e3, 1e3},
      {"the nodes in metres, the masses in tonnes, the stiffness in N/m", 1.0, 1e3, 1.0},
      {"the nodes in millimetres, the masses in grams, the stiffness in N/mm", 1e-3, 1e-3, 1e3},
      {"the nodes in inches, the masses in lbf s²/in, the stiffness in lbf/in", 0.0254, 175.126835, 175.126835},
  };
  for (UnitGuess const& g : guesses) {
    double const c = speed * g.length * std::sqrt(g.stiffness / g.mass), m = mass * g.mass;
    if (c >= 1e3 && c <= 1.3e4 && std::abs(m - given) <= 0.2 * given) return &g;
  }
  return nullptr;
}

/// Sentence about the units of a model that fit the given mass, or an empty text.
template <class = void>
std::string unit_sentence(double speed, double mass, double given) {
  UnitGuess const* const guess = unit_guess(speed, mass, given);
  if (!guess || (guess->length == 1.0 && guess->mass == 1.0 && guess->stiffness == 1.0)) return {};
  double const wave = speed * guess->length * std::sqrt(guess->stiffness / guess->mass);
  return sentence_of({" With ", guess->name, ", waves travel at ", number(wave, 3), " m/s and the mass is ",
                      number(mass * guess->mass, 6),
                      " kg: if the files have these units, convert the model by in_si with FeUnits{.length = ",
                      guess->length, ", .mass = ", guess->mass, ", .force = ", guess->stiffness * guess->length,
                      "}."});
}

}  // namespace detail
}  // namespace polybody
