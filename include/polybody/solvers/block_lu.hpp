#pragma once

#include <polybody/solvers/block_factor.hpp>

namespace polybody {

/// Block LU factorisation in the elimination order of `BlockLdlt`, for unsymmetric tangents.
using BlockLu = BlockFactor<Symmetry::none>;
/// Block LU factorisation that does half the work if the matrix is symmetric.
using BlockSolver = BlockFactor<Symmetry::measured>;

/// Block LDLᵀ factorisation of a symmetric matrix; the half below the diagonal is not read. The tangent is unsymmetric
/// with friction, or with damping of rotating flexible bodies. With `BlockLdlt`, Newton's method then contracts with a
/// rate of 0.6 or worse. `BlockSolver` reads both halves and measures the asymmetry.
using BlockLdlt = BlockFactor<Symmetry::assumed>;

}  // namespace polybody
