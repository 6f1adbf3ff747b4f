#pragma once
/// \file
/// The linear solvers that are used where none is named. The tests put other ones here (tests/named_solver).

#include <polybody/solvers/auto_lu.hpp>
#include <polybody/solvers/block_lu.hpp>

namespace polybody {

/// The solver of time steps.
using DefaultSolver = BlockSolver;
/// The solver of statics, where a block may be without a pivot of its own.
using DefaultStaticSolver = AutoLu;

}  // namespace polybody
