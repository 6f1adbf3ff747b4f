// A part of polybody::compiled: the functions of a model with erased type (see polybody/compiled.hpp).
#include <polybody/compiled.hpp>

namespace polybody {

template class BasicSystem<double>;
template class ReductionOf<double>;
template class JointTreeOf<double>;
template class LinearEliminationOf<double>;
template class detail::BodyEquationsOf<void>;
template class detail::ReducedCoordinates<void>;
template class detail::ReducedCoordinates<joint_coordinates::Augmented>;
template class detail::ReducedCoordinates<joint_coordinates::ArticulatedBody>;
template void assemble<DefaultSolver>(System&, State&, double, int);

}  // namespace polybody
