#include <polybody/solvers/auto_lu.hpp>

template class Eigen::SparseLU<polybody::EigenSparseLu::Matrix, Eigen::COLAMDOrdering<int>>;
template class Eigen::internal::SparseLUImpl<double, int>;
