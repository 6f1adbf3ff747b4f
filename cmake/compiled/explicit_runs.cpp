// A part of polybody::compiled: runs by explicit integrators (see polybody/compiled.hpp).
#include <polybody/compiled.hpp>

namespace polybody {

template class Simulation<SymplecticEuler>;
template class Simulation<Rattle>;
template class Simulation<CentralDifference<>>;
template class Simulation<CentralDifference<Projection>>;
template class Simulation<RungeKutta4<>>;
template class Simulation<RungeKutta4<Projection>>;
template class Simulation<DormandPrince<>>;
template class Simulation<DormandPrince<Projection>>;
template class Simulation<AdamsBashforthMoulton<>>;
template class Simulation<AdamsBashforthMoulton<Projection>>;
template class Simulation<AdamsBashforthMoulton<CoordinatePartitioning>>;

}  // namespace polybody
