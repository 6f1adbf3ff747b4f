// A part of polybody::compiled: frames of bodies and their pictures (see polybody/compiled.hpp).
#include <polybody/compiled.hpp>

namespace polybody {

template Frame<double> frame(BodyInState<Rigid<>> const&, Rigid<>::Point const&);
template FrameIn frame_in(BodyHandle<Rigid<>> const&, Marker<Rigid<>> const&);
template void Visual::attach(Marker<Rigid<>> const&, Surface const&, std::string);
template Frame<double> frame(BodyInState<AncfBeam<>> const&, AncfBeam<>::Point const&);
template FrameIn frame_in(BodyHandle<AncfBeam<>> const&, Marker<AncfBeam<>> const&);
template void Visual::attach(Marker<AncfBeam<>> const&, Surface const&, std::string);
template void Visual::sweep(BodyHandle<AncfBeam<>> const&, Bar const&, int, int);
template Frame<double> frame(BodyInState<AncfCable<>> const&, AncfCable<>::Point const&);
template Frame<double> frame(BodyInState<AncfCable<EngineeringStrain>> const&,
                             AncfCable<EngineeringStrain>::Point const&);
template FrameIn frame_in(BodyHandle<AncfCable<>> const&, Marker<AncfCable<>> const&);
template FrameIn frame_in(BodyHandle<AncfCable<EngineeringStrain>> const&, Marker<AncfCable<EngineeringStrain>> const&);
template void Visual::attach(Marker<AncfCable<>> const&, Surface const&, std::string);
template void Visual::attach(Marker<AncfCable<EngineeringStrain>> const&, Surface const&, std::string);
template void Visual::sweep(BodyHandle<AncfCable<>> const&, Bar const&, int, int);
template void Visual::sweep(BodyHandle<AncfCable<EngineeringStrain>> const&, Bar const&, int, int);
template Frame<double> frame(BodyInState<AncfBeam<Continuum<>>> const&, AncfBeam<Continuum<>>::Point const&);
template FrameIn frame_in(BodyHandle<AncfBeam<Continuum<>>> const&, Marker<AncfBeam<Continuum<>>> const&);
template void Visual::attach(Marker<AncfBeam<Continuum<>>> const&, Surface const&, std::string);
template void Visual::sweep(BodyHandle<AncfBeam<Continuum<>>> const&, Bar const&, int, int);
template Frame<double> frame(BodyInState<Lrvf<>> const&, Lrvf<>::Point const&);
template FrameIn frame_in(BodyHandle<Lrvf<>> const&, Marker<Lrvf<>> const&);
template void Visual::attach(Marker<Lrvf<>> const&, Surface const&, std::string);
template void Visual::sweep(BodyHandle<Lrvf<>> const&, Bar const&, int, int);
template void Visual::carry<void>(Visual::Place, Surface const&, std::string);
template void Visual::draw_line<void>(Visual::Place, Visual::Place, double, std::string const&);
template std::vector<Vec2> outline<void>(Bar const&, int);
template Surface swept<void>(int, int);
template Surface cylinder<double>(double, double, Vec3 const&, int);
template Surface box<void>(Vec3 const&);

}  // namespace polybody
