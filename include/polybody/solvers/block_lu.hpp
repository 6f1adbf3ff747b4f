#pragma once
#include <polybody/solvers/block_factor.hpp>

namespace polybody {

/// Block LU in the order of `BlockLdlt`, for unsymmetric tangents.
using BlockLu = BlockFactor<Symmetry::none>;
/// Block LU that does the half of the work when the matrix is symmetric.
using BlockSolver = BlockFactor<Symmetry::measured>;

}  // namespace polybody
