#pragma once
#include <polybody/solvers/block_factor.hpp>

namespace polybody {

/// Block LDLᵀ factorisation of a symmetric matrix; the half below the diagonal is not read. The tangent is unsymmetric
/// with friction, or with damping of rotating flexible bodies. With `BlockLdlt`, Newton's method then contracts with a
/// rate of 0.6 or worse. `BlockSolver` reads both halves and measures the asymmetry.
using BlockLdlt = BlockFactor<Symmetry::assumed>;

}  // namespace polybody
