#include <polybody/solvers/auto_lu.hpp>
#include <polybody/solvers/block_lu.hpp>

template class polybody::BlockFactor<polybody::Symmetry::measured>;
template class Eigen::SparseLU<polybody::EigenSparseLu::Matrix, Eigen::COLAMDOrdering<int>>;
template class Eigen::internal::SparseLUImpl<double, int>;
