#pragma once
#include <polybody/solvers/reduced_coordinates.hpp>

namespace polybody {

/// Counts of a model as thesis Table 3.4 makes them: a unit quaternion counts four coordinates and one
/// constraint. What policies eliminate is not counted.
struct Census {
  Index coordinates = 0;         ///< of bodies and the ground
  Index constraints = 0;         ///< rows of joints and of bodies
  Index speeds = 0;              ///< unknown rates of the integrator
  Index rows = 0;                ///< multipliers of the integrator
  Index degrees_of_freedom = 0;  ///< coordinates − constraints
};

/// Counts of a step in these coordinates, or of the whole model where there are none.
inline Census census(ModelLayout const& whole, Coordinates const& c) {
  Index const coordinates = c ? c.narrow->coordinates : whole.coordinates;
  Index const speeds = c ? c.narrow->speeds : whole.speeds, rows = c ? c.narrow->rows : whole.rows;
  Index const constraints = rows + coordinates - (speeds - whole.states);
  return {coordinates, constraints, speeds, rows, coordinates - constraints};
}
/// Coordinates, rows and degrees of freedom of a model, counted as the thesis does (Table 3.4).
template <class M>
Census census(M const& model) {
  return census(layout_of(model), coordinates_of(model));
}

}  // namespace polybody
