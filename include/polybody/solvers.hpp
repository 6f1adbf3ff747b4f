#pragma once
/// \file
/// Linear solvers in addition to those of polybody.hpp: dense LU, and the sparse LDLᵀ and LU factorisations of Eigen.

#include <polybody/solvers/dense_lu.hpp>
#include <polybody/solvers/eigen_ldlt.hpp>
#include <polybody/solvers/eigen_sparse_lu.hpp>
