#pragma once
/// \file
/// The linear solvers that are used where none is named. The tests put other ones here (tests/named_solver).

#include <polybody/solvers/auto_lu.hpp>
#include <polybody/solvers/block_lu.hpp>

namespace polybody {

/// Of time steps.
using DefaultSolver = BlockSolver;
/// Of statics, where a block may be without a pivot of its own.
using DefaultStaticSolver = AutoLu;

}  // namespace polybody
