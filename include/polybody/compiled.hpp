#pragma once
/// \file
/// polybody.hpp for programs that link the library target `polybody::compiled`. This library contains compiled code
/// that does not depend on the user's model: `System`, runs with the library's integrators and the default solver,
/// joint coordinates, and the tangents of the common flexible bodies.

#include <polybody/polybody.hpp>

namespace polybody {

extern template class BasicSystem<double>;
extern template class ReductionOf<double>;
extern template class JointTreeOf<double>;
extern template class LinearEliminationOf<double>;
extern template class detail::BodyEquationsOf<void>;
extern template class detail::ReducedCoordinates<void>;
extern template class detail::ReducedCoordinates<joint_coordinates::Augmented>;
extern template class detail::ReducedCoordinates<joint_coordinates::ArticulatedBody>;
extern template void assemble<DefaultSolver>(System&, State&, double, int);

extern template struct BodyKernels<Rigid<>, double>;
extern template struct BodyKernels<Rigid<EulerParameters>, double>;
extern template struct BodyKernels<planar::Rigid, double>;
extern template struct BodyKernels<planar::AncfCable<>, double>;
extern template struct BodyKernels<planar::AncfCable<EngineeringStrain>, double>;
extern template struct BodyKernels<planar::Lrvf, double>;
extern template planar::AncfCable<>::Beam(Bar const&, BarConstants const&, Index);
extern template planar::AncfCable<EngineeringStrain>::Beam(Bar const&, BarConstants const&, Index);
extern template planar::Beam<planar::SimoVuQuocBy<ReducedQuadrature>>::Beam(Bar const&, BarConstants const&, Index);
extern template struct BodyKernels<AncfBeam<>, double>;
extern template AncfBeam<>::AncfBeam(Bar const&, Index, ReferenceCurve const&, bool);
extern template struct BodyKernels<AncfCable<>, double>;
extern template struct BodyKernels<AncfCable<EngineeringStrain>, double>;
extern template AncfCable<>::AncfCable(Bar const&, BarConstants const&, Index, ReferenceCurve const&);
extern template AncfCable<EngineeringStrain>::AncfCable(Bar const&, BarConstants const&, Index, ReferenceCurve const&);
extern template struct BodyKernels<AncfBeam<Continuum<>>, double>;
extern template AncfBeam<Continuum<>>::AncfBeam(Bar const&, Index, ReferenceCurve const&, bool);
extern template struct BodyKernels<Lrvf<>, double>;
extern template Lrvf<>::Lrvf(Bar const&, detail::ChainSections const&, Index, ReferenceCurve const&);
extern template struct JointKernels<Joint<Revolute, Constraint>, double>;
extern template struct JointKernels<Joint<Revolute, Bushing>, double>;
extern template struct JointKernels<Joint<Revolute, AncfLinear>, double>;
extern template struct JointKernels<Joint<Revolute, JointCoordinates>, double>;
extern template struct JointKernels<Joint<Spherical, Constraint>, double>;
extern template struct JointKernels<Joint<Spherical, Penalty>, double>;
extern template struct JointKernels<Joint<Prismatic, Constraint>, double>;
extern template struct JointKernels<Joint<PointOnLine, Constraint>, double>;
extern template struct JointKernels<Joint<PrescribedRate<Ramp>, Constraint>, double>;
extern template struct JointKernels<Joint<Weld, Constraint>, double>;
extern template struct JointKernels<Joint<planar::Revolute, Constraint>, double>;
extern template struct JointKernels<Joint<planar::Revolute, Penalty>, double>;
extern template struct JointKernels<Joint<planar::Weld, Constraint>, double>;
extern template struct JointKernels<Joint<planar::Weld, Penalty>, double>;
extern template struct ForceKernels<PointMoment<Ramp>, double>;
extern template struct ForceKernels<SpringDamper, double>;
extern template struct ForceKernels<AxialSpring, double>;
extern template Frame<double> frame(BodyInState<Rigid<>> const&, Rigid<>::Point const&);
extern template FrameIn frame_in(BodyHandle<Rigid<>> const&, Marker<Rigid<>> const&);
extern template void Visual::attach(Marker<Rigid<>> const&, Surface const&, std::string);
extern template Frame<double> frame(BodyInState<AncfBeam<>> const&, AncfBeam<>::Point const&);
extern template FrameIn frame_in(BodyHandle<AncfBeam<>> const&, Marker<AncfBeam<>> const&);
extern template void Visual::attach(Marker<AncfBeam<>> const&, Surface const&, std::string);
extern template void Visual::sweep(BodyHandle<AncfBeam<>> const&, Bar const&, int, int);
extern template Frame<double> frame(BodyInState<AncfCable<>> const&, AncfCable<>::Point const&);
extern template Frame<double> frame(BodyInState<AncfCable<EngineeringStrain>> const&,
                                    AncfCable<EngineeringStrain>::Point const&);
extern template FrameIn frame_in(BodyHandle<AncfCable<>> const&, Marker<AncfCable<>> const&);
extern template FrameIn frame_in(BodyHandle<AncfCable<EngineeringStrain>> const&,
                                 Marker<AncfCable<EngineeringStrain>> const&);
extern template void Visual::attach(Marker<AncfCable<>> const&, Surface const&, std::string);
extern template void Visual::attach(Marker<AncfCable<EngineeringStrain>> const&, Surface const&, std::string);
extern template void Visual::sweep(BodyHandle<AncfCable<>> const&, Bar const&, int, int);
extern template void Visual::sweep(BodyHandle<AncfCable<EngineeringStrain>> const&, Bar const&, int, int);
extern template Frame<double> frame(BodyInState<AncfBeam<Continuum<>>> const&, AncfBeam<Continuum<>>::Point const&);
extern template FrameIn frame_in(BodyHandle<AncfBeam<Continuum<>>> const&, Marker<AncfBeam<Continuum<>>> const&);
extern template void Visual::attach(Marker<AncfBeam<Continuum<>>> const&, Surface const&, std::string);
extern template void Visual::sweep(BodyHandle<AncfBeam<Continuum<>>> const&, Bar const&, int, int);
extern template Frame<double> frame(BodyInState<Lrvf<>> const&, Lrvf<>::Point const&);
extern template FrameIn frame_in(BodyHandle<Lrvf<>> const&, Marker<Lrvf<>> const&);
extern template void Visual::attach(Marker<Lrvf<>> const&, Surface const&, std::string);
extern template void Visual::sweep(BodyHandle<Lrvf<>> const&, Bar const&, int, int);
extern template detail::LinearPointOf<double> detail::linear_point<AncfBeam<>, double>(AncfBeam<> const&,
                                                                                       AncfBeam<>::Point const&);
extern template detail::LinearPointOf<double> detail::linear_point<AncfCable<>, double>(AncfCable<> const&,
                                                                                        AncfCable<>::Point const&);
extern template detail::LinearPointOf<double> detail::linear_point<AncfCable<EngineeringStrain>, double>(
    AncfCable<EngineeringStrain> const&, AncfCable<EngineeringStrain>::Point const&);
extern template detail::LinearPointOf<double> detail::linear_point<AncfBeam<Continuum<>>, double>(
    AncfBeam<Continuum<>> const&, AncfBeam<Continuum<>>::Point const&);
extern template void detail::fill_linear_rows<Revolute, double>(detail::LinearPointOf<double> const&,
                                                                detail::LinearPointOf<double> const&, Vec3 const&,
                                                                LinearConstraints&);
extern template void Visual::carry<void>(Visual::Place, Surface const&, std::string);
extern template void Visual::draw_line<void>(Visual::Place, Visual::Place, double, std::string const&);
extern template std::vector<Vec2> outline<void>(Bar const&, int);
extern template Surface swept<void>(int, int);
extern template Surface cylinder<double>(double, double, Vec3 const&, int);
extern template Surface box<void>(Vec3 const&);
extern template void detail::place_ground(Sequence<detail::GroundMarker> const&, Index, Index, Data<double>&);
extern template void detail::place_linear_rows(Sequence<LinearConstraints> const&, double*, Data<double>&);
extern template void detail::measure_linear_rows(Sequence<LinearConstraints> const&, VecX const&, Data<double> const&,
                                                 double*);
extern template BarConstants constants<void>(Bar const&);

extern template class Simulation<GeneralisedAlpha>;
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
