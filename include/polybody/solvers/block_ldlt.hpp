#pragma once
#include <polybody/solvers/block_factor.hpp>

namespace polybody {

/// Block LDLᵀ of a symmetric matrix; the half below the diagonal is not read.
using BlockLdlt = BlockFactor<Symmetry::assumed>;

}  // namespace polybody
