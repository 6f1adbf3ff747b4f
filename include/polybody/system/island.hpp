#pragma once
/// \file
/// Island of a model: bodies that no joint and no force element connects to the other bodies. The ground connects no
/// bodies. The equations of an island do not depend on the unknowns of the other islands.
/// Theory: Eq. 6.45.

#include <memory>

#include <polybody/system/layout.hpp>

namespace polybody {

template <StateScalar T>
class ModelOperations;

/// Positions of the unknowns of an island among those of its model.
struct IslandPlaces {
  /// Consecutive unknowns.
  struct Range {
    Index own, model, count;  ///< index of the first unknown in the island and in the model; number of unknowns
  };
  Sequence<Range> q, v, rows;  ///< coordinates; velocities, then first-order states; constraint equations
};

/// Equations of an island, as arguments of the constructor of a system.
struct ModelIsland {
  std::shared_ptr<ModelOperations<double> const> operations;  ///< functions of the island; they contain its bodies
  ModelLayout layout;                                         ///< sizes and names
  Data<double> data;                                          ///< arrays of an evaluation
  IslandPlaces places;                                        ///< positions in the model
};

}  // namespace polybody
