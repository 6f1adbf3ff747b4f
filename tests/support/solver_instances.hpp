#pragma once
// Solvers are compiled once for all tests (solver_instances.cpp), not again in every file.
#include <polybody/solvers/default_solver.hpp>

extern template class polybody::BlockFactor<polybody::Symmetry::measured>;
extern template class Eigen::SparseLU<polybody::EigenSparseLu::Matrix, Eigen::COLAMDOrdering<int>>;
extern template class Eigen::internal::SparseLUImpl<double, int>;
