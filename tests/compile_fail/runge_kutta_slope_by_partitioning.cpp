// refused: CoordinatePartitioning is not supported
#include <polybody/gradients/runge_kutta_derivatives.hpp>
#include <polybody/integrators/coordinate_partitioning.hpp>

using namespace polybody;

using Slope = RungeKuttaLinearisedStep<RungeKutta4<CoordinatePartitioning>>;
Slope const* slope(Slope const& s) { return &s + sizeof(Slope); }
