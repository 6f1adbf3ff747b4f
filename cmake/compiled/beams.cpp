// A part of polybody::compiled: the loops over beams (see polybody/compiled.hpp).
#include <polybody/compiled.hpp>

namespace polybody {

template struct BodyKernels<AncfBeam<>, double>;
template struct BodyKernels<AncfCable<>, double>;
template AncfCable<>::AncfCable(Bar const&, BarConstants const&, Index, ReferenceCurve const&);
template struct BodyKernels<AncfBeam<Continuum<>>, double>;
template AncfBeam<Continuum<>>::AncfBeam(Bar const&, Index, ReferenceCurve const&, bool);
template struct BodyKernels<Lrvf<>, double>;
template Lrvf<>::Lrvf(Bar const&, BarConstants const&, Index, ReferenceCurve const&);

}  // namespace polybody
