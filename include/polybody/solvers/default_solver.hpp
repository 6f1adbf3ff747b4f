#pragma once
/// \file
/// Default linear solvers. Some tests replace this header (tests/named_solver).

#include <polybody/solvers/auto_lu.hpp>
#include <polybody/solvers/block_lu.hpp>

namespace polybody {

/// Solver of time steps.
using DefaultSolver = BlockSolver;
/// Solver of statics. It also solves matrices with blocks that have no pivot of their own.
using DefaultStaticSolver = AutoLu;

}  // namespace polybody
