// A part of polybody::compiled: the loops over common bodies and joints (see polybody/compiled.hpp).
#include <polybody/compiled.hpp>

namespace polybody {

template struct BodyKernels<Rigid<>, double>;
template struct BodyKernels<Rigid<EulerParameters>, double>;
template struct BodyKernels<planar::Rigid, double>;
template struct BodyKernels<planar::AncfCable<>, double>;
template struct BodyKernels<planar::AncfCable<EngineeringStrain>, double>;
template struct BodyKernels<planar::Lrvf, double>;
template planar::AncfCable<>::Beam(Bar const&, BarConstants const&, Index);
template planar::AncfCable<EngineeringStrain>::Beam(Bar const&, BarConstants const&, Index);
template planar::Beam<planar::SimoVuQuocBy<ReducedQuadrature>>::Beam(Bar const&, BarConstants const&, Index);
template struct JointKernels<Joint<Revolute, Constraint>, double>;
template struct JointKernels<Joint<Revolute, Bushing>, double>;
template struct JointKernels<Joint<Revolute, AncfLinear>, double>;
template struct JointKernels<Joint<Revolute, JointCoordinates>, double>;
template struct JointKernels<Joint<Spherical, Constraint>, double>;
template struct JointKernels<Joint<Spherical, Penalty>, double>;
template struct JointKernels<Joint<Prismatic, Constraint>, double>;
template struct JointKernels<Joint<PointOnLine, Constraint>, double>;
template struct JointKernels<Joint<PrescribedRate<Ramp>, Constraint>, double>;
template struct JointKernels<Joint<Weld, Constraint>, double>;
template struct JointKernels<Joint<planar::Revolute, Constraint>, double>;
template struct JointKernels<Joint<planar::Revolute, Penalty>, double>;
template struct JointKernels<Joint<planar::Weld, Constraint>, double>;
template struct JointKernels<Joint<planar::Weld, Penalty>, double>;
template struct ForceKernels<PointMoment<Ramp>, double>;
template struct ForceKernels<SpringDamper, double>;
template struct ForceKernels<AxialSpring, double>;
template void detail::place_ground(Sequence<detail::GroundMarker> const&, Index, Index, Data<double>&);
template void detail::place_linear_rows(Sequence<LinearConstraints> const&, double*, Data<double>&);
template void detail::measure_linear_rows(Sequence<LinearConstraints> const&, VecX const&, Data<double> const&,
                                          double*);
template BarConstants constants<void>(Bar const&);

}  // namespace polybody
