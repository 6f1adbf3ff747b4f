#pragma once
/// \file
/// Default linear solvers. Some tests replace this header (tests/named_solver).

#include <polybody/solvers/auto_lu.hpp>
#include <polybody/solvers/block_factor.hpp>

namespace polybody {

/// Linear solver of time steps.
using DefaultSolver = BlockSolver;
/// Linear solver of statics. It also solves matrices with singular diagonal blocks.
using DefaultStaticSolver = AutoLu;

}  // namespace polybody
