#pragma once
/// \file
/// What is asked of a random model at each state that it visits.

#include <map>
#include <set>

#include "random_models/realise.hpp"

namespace polybody::random_models {

/// A residual: how far off, where zero is right, and what is tolerated.
struct Residual {
  char const* check;
  double value;
  double tolerance;
};

/// How often each pair of the tables of composition is met: table, row, column.
using Pairs = std::map<std::string, std::map<std::pair<std::string, std::string>, long>>;

struct Outcome {
  std::uint64_t seed = 0;
  std::vector<Residual> residuals = {};  ///< the largest of each check
  std::string error = {};                ///< what an unexpected exception said
  bool from_reference = false;           ///< no other place was found at which all joints close
  bool refused = false;                  ///< the model, in a sentence
  bool redundant = false;                ///< rows repeat others: multipliers are not compared
  bool singular = false;                 ///< rows nearly repeat others: neither is anything that is solved for
  int failures = 0;                      ///< steps that were made to fail, and did
  bool right() const;
};

/// Draws the model of a seed, realises it, and checks it.
Outcome examine(std::uint64_t seed, int types, WideType const& type);

/// Adds the pairs of a seed's model.
void count_pairs(std::uint64_t seed, int types, WideType const& type, Pairs& pairs);

}  // namespace polybody::random_models
