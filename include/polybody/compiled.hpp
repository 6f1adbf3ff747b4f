#pragma once
/// \file
/// polybody.hpp, with the promise that the library target `polybody::compiled` is linked: what does not depend on the
/// user's model is compiled there, once. That is `System`, runs by the library's integrators with the default solver,
/// joint coordinates, and the tangents of the common flexible bodies.
/// Not in polybody.hpp: it is for programs that link `polybody::compiled`.

#include <polybody/polybody.hpp>

namespace polybody {

extern template class BasicSystem<double>;
extern template class ReductionOf<double>;
extern template class detail::ReducedCoordinates<void>;
extern template class detail::ReducedCoordinates<recursive::Augmented>;
extern template class detail::ReducedCoordinates<recursive::Reduced>;
extern template class detail::ReducedCoordinates<recursive::ArticulatedBody>;
extern template void assemble<DefaultSolver>(System&, State&, double, int);

extern template struct BodyKernels<Rigid<>, double>;
extern template struct BodyKernels<Rigid<EulerParameters>, double>;
extern template struct BodyKernels<planar::Rigid, double>;
extern template struct BodyKernels<planar::AncfCable<>, double>;
extern template struct BodyKernels<planar::Lrvf, double>;
extern template struct BodyKernels<AncfBeam<>, double>;
extern template struct BodyKernels<AncfCable<>, double>;
extern template AncfCable<>::AncfCable(Bar const&, BarConstants const&, Index, ReferenceCurve const&);
extern template struct BodyKernels<AncfBeam<Continuum<>>, double>;
extern template AncfBeam<Continuum<>>::AncfBeam(Bar const&, Index, ReferenceCurve const&, bool);
extern template struct BodyKernels<Lrvf<>, double>;
extern template Lrvf<>::Lrvf(Bar const&, BarConstants const&, Index, ReferenceCurve const&);
extern template struct JointKernels<Joint<Revolute, Constraint>, double>;
extern template struct JointKernels<Joint<Spherical, Constraint>, double>;
extern template struct JointKernels<Joint<Weld, Constraint>, double>;
extern template struct JointKernels<Joint<planar::Revolute, Constraint>, double>;
extern template void detail::place_ground(Sequence<detail::GroundMarker> const&, Index, Index, Data<double>&);
extern template void detail::place_linear_rows(Sequence<LinearRows> const&, double*, Data<double>&);
extern template void detail::measure_linear_rows(Sequence<LinearRows> const&, VecX const&, Data<double> const&,
                                                 double*);
extern template BarConstants constants<void>(Bar const&);

extern template class Simulation<GeneralizedAlpha>;
extern template class Simulation<HhtAlpha>;
extern template class Simulation<Newmark>;
extern template class Simulation<Trapezoidal>;
extern template class Simulation<EnergyMomentum>;
extern template class Simulation<EnergyDecaying>;
extern template class Simulation<Radau>;

extern template class Simulation<SymplecticEuler>;
extern template class Simulation<Rattle>;
extern template class Simulation<CentralDifference<>>;
extern template class Simulation<CentralDifference<Projection>>;
extern template class Simulation<RungeKutta4<>>;
extern template class Simulation<RungeKutta4<Projection>>;
extern template class Simulation<DormandPrince<>>;
extern template class Simulation<DormandPrince<Projection>>;
extern template class Simulation<AdamsBashforthMoulton<>>;
extern template class Simulation<AdamsBashforthMoulton<Projection>>;
extern template class Simulation<AdamsBashforthMoulton<CoordinatePartitioning>>;

}  // namespace polybody
