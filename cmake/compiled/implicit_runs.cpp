// A part of polybody::compiled: runs by implicit integrators (see polybody/compiled.hpp).
#include <polybody/compiled.hpp>

namespace polybody {

template class Simulation<GeneralisedAlpha>;
template class Simulation<HhtAlpha>;
template class Simulation<Newmark>;
template class Simulation<Trapezoidal>;
template class Simulation<EnergyMomentum>;
template class Simulation<EnergyDecaying>;
template class Simulation<Radau>;

}  // namespace polybody
