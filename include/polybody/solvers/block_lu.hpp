#pragma once
#include <polybody/solvers/block_factor.hpp>

namespace polybody {

/// Block LU factorisation in the elimination order of `BlockLdlt`, for unsymmetric tangents.
using BlockLu = BlockFactor<Symmetry::none>;
/// Block LU factorisation that does half the work if the matrix is symmetric.
using BlockSolver = BlockFactor<Symmetry::measured>;

}  // namespace polybody
