#pragma once
/// \file
/// Solvers of the block factorisation by symmetry: `BlockLu`, `BlockSolver` and `BlockLdlt`.

#include <polybody/solvers/block_factor.hpp>

namespace polybody {

/// Block LU factorisation in the elimination order of `BlockLdlt`, for unsymmetric tangents.
using BlockLu = BlockFactor<Symmetry::none>;
/// Block LU factorisation that does half the work if the matrix is symmetric.
using BlockSolver = BlockFactor<Symmetry::measured>;

/// Block LDLᵀ factorisation of a symmetric matrix; the half below the diagonal is not read. The tangent is unsymmetric
/// with friction, or with damping of rotating flexible bodies. `BlockLdlt` then factorises a wrong matrix, and
/// Newton's method converges slowly. `BlockSolver` reads both halves and measures the asymmetry.
using BlockLdlt = BlockFactor<Symmetry::assumed>;

}  // namespace polybody
