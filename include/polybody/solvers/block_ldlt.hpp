#pragma once
#include <polybody/solvers/block_factor.hpp>

namespace polybody {

/// Block LDLᵀ of a symmetric matrix; the half below the diagonal is not read. Where the tangent is not symmetric, as
/// with friction, or damping of flexible bodies that turn, Newton's method converges by a rate of 0.6 and worse:
/// `BlockSolver` measures that and reads both halves.
using BlockLdlt = BlockFactor<Symmetry::assumed>;

}  // namespace polybody
