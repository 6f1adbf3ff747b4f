#pragma once
/// \file Checks of a random model in each state that it passes through.

#include <map>
#include <set>

#include "random_models/realise.hpp"

namespace polybody::random_models {

/// A residual: its value, which should be zero, and its tolerance.
struct Residual {
  char const* check;
  double value;
  double tolerance;
};

/// Number of occurrences of each pair in the tables of composition: table, row, column.
using Pairs = std::map<std::string, std::map<std::pair<std::string, std::string>, long>>;

struct Outcome {
  std::uint64_t seed = 0;
  std::vector<Residual> residuals = {};  ///< the largest of each check
  std::string error = {};                ///< message of an unexpected exception
  bool from_reference = false;           ///< no other configuration was found that satisfies all joints
  bool refused = false;                  ///< an error refused the model
  bool redundant = false;                ///< redundant constraints: multipliers are not compared
  bool singular = false;                 ///< nearly redundant constraints: solutions are not compared either
  int failures = 0;                      ///< steps that were made to fail, and failed
  bool right() const;
};

/// Draws the model of a seed, builds it, and checks it.
Outcome examine(std::uint64_t seed, int types, WideType const& type);

/// Adds the pairs of the model of a seed.
void count_pairs(std::uint64_t seed, int types, WideType const& type, Pairs& pairs);

}  // namespace polybody::random_models
