// A part of polybody::compiled: the loops over beams (see polybody/compiled.hpp).
#include <polybody/compiled.hpp>

namespace polybody {

template struct BodyKernels<AncfBeam<>, double>;
template AncfBeam<>::AncfBeam(Bar const&, Index, ReferenceCurve const&, bool);
template struct BodyKernels<AncfCable<>, double>;
template struct BodyKernels<AncfCable<EngineeringStrain>, double>;
template AncfCable<>::AncfCable(Bar const&, BarConstants const&, Index, ReferenceCurve const&);
template AncfCable<EngineeringStrain>::AncfCable(Bar const&, BarConstants const&, Index, ReferenceCurve const&);
template struct BodyKernels<AncfBeam<Continuum<>>, double>;
template AncfBeam<Continuum<>>::AncfBeam(Bar const&, Index, ReferenceCurve const&, bool);
template struct BodyKernels<Lrvf<>, double>;
template Lrvf<>::Lrvf(Bar const&, detail::ChainSections const&, Index, ReferenceCurve const&);
template detail::LinearPointOf<double> detail::linear_point<AncfBeam<>, double>(AncfBeam<> const&,
                                                                                AncfBeam<>::Point const&);
template detail::LinearPointOf<double> detail::linear_point<AncfCable<>, double>(AncfCable<> const&,
                                                                                 AncfCable<>::Point const&);
template detail::LinearPointOf<double> detail::linear_point<AncfCable<EngineeringStrain>, double>(
    AncfCable<EngineeringStrain> const&, AncfCable<EngineeringStrain>::Point const&);
template detail::LinearPointOf<double> detail::linear_point<AncfBeam<Continuum<>>, double>(
    AncfBeam<Continuum<>> const&, AncfBeam<Continuum<>>::Point const&);
template void detail::fill_linear_rows<Revolute, double>(detail::LinearPointOf<double> const&,
                                                         detail::LinearPointOf<double> const&, Vec3 const&,
                                                         LinearConstraints&);

}  // namespace polybody
