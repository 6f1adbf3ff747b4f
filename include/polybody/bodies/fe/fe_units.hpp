#pragma once
/// \file
/// Units of finite element models: conversion to SI units, and guesses of the units of a file.
/// Theory: Eq. 10.16.

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

inline constexpr FeUnits si_units{1.0, 1.0, 1.0};               ///< metre, kilogram, newton
inline constexpr FeUnits mm_tonne_newton{1e-3, 1e3, 1.0};       ///< millimetre, tonne, newton
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

/// Quantities of a model in the units of its files, and its true mass.
struct UnitFacts {
  double speed;   ///< speed of waves from node to node
  double mass;    ///< total mass
  double volume;  ///< volume of the box around the nodes
  double given;   ///< true mass [kg]
};

/// First guess with which waves travel at 1 to 13 km/s, the mass is the given one to 20 %, and the mean density of the
/// box around the nodes is between 0.01 and 30 000 kg/m³; null if there is none.
inline UnitGuess const* unit_guess(UnitFacts const& facts) {
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
    double const c = facts.speed * g.length * std::sqrt(g.stiffness / g.mass), m = facts.mass * g.mass,
                 density = m / (facts.volume * g.length * g.length * g.length);
    bool const solid = density >= 1e-2 && density <= 3e4;
    if (c >= 1e3 && c <= 1.3e4 && solid && std::abs(m - facts.given) <= 0.2 * facts.given) return &g;
  }
  return nullptr;
}

/// Sentence about the units of a model that fit the given mass, or an empty text.
template <class = void>
std::string unit_sentence(UnitFacts const& facts) {
  UnitGuess const* const guess = unit_guess(facts);
  if (!guess || (guess->length == 1.0 && guess->mass == 1.0 && guess->stiffness == 1.0)) return {};
  double const wave = facts.speed * guess->length * std::sqrt(guess->stiffness / guess->mass);
  return sentence_of({" With ", guess->name, ", waves travel at ", number(wave, 3), " m/s and the mass is ",
                      number(facts.mass * guess->mass, 6),
                      " kg: if the files have these units, convert the model by in_si with FeUnits{.length = ",
                      guess->length, ", .mass = ", guess->mass, ", .force = ", guess->stiffness * guess->length, "}."});
}

}  // namespace detail
}  // namespace polybody
