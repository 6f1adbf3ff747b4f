#pragma once
/// \file
/// Numbers of coordinates, constraint equations and degrees of freedom of a model.

#include <polybody/elimination/reduced_coordinates.hpp>

namespace polybody {

/// Counts of a model as in thesis Table 3.4: a unit quaternion counts as four coordinates and one constraint equation.
/// Eliminated unknowns are not counted.
struct ProblemSize {
  Index coordinates = 0;         ///< coordinates of bodies
  Index constraints = 0;         ///< constraint equations of joints and of bodies
  Index velocities = 0;          ///< unknown velocities of the integrator
  Index rows = 0;                ///< multipliers of the integrator
  Index degrees_of_freedom = 0;  ///< coordinates − constraints
};

/// Counts of a step in the reduced coordinates c, or of the full model if c is empty.
inline ProblemSize problem_size(ModelLayout const& full, Coordinates const& c) {
  Index const coordinates = c ? c.reduced->coordinates : full.coordinates;
  Index const velocities = c ? c.reduced->velocities : full.velocities, rows = c ? c.reduced->rows : full.rows;
  Index const constraints = rows + coordinates - (velocities - full.states);
  return {coordinates, constraints, velocities, rows, coordinates - constraints};
}
/// Coordinates, constraint equations and degrees of freedom of a model, counted as in thesis Table 3.4.
template <class M>
ProblemSize problem_size(M const& model) {
  return problem_size(layout_of(model), coordinates_of(model));
}

}  // namespace polybody
