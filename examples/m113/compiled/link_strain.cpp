// A part of the library m113_compiled: strain of flexible links (see m113/compiled.hpp).
#include "../compiled.hpp"

namespace polybody {

template double m113::link_strain(BodyHandle<AncfBeam<>> const&, State const&);
template double m113::link_bending(BodyHandle<AncfBeam<>> const&, State const&, Vec3 const&, double);
template double m113::link_strain(BodyHandle<AncfCable<>> const&, State const&);
template double m113::link_bending(BodyHandle<AncfCable<>> const&, State const&, Vec3 const&, double);
template double m113::link_strain(BodyHandle<AncfBeam<Continuum<>>> const&, State const&);
template double m113::link_bending(BodyHandle<AncfBeam<Continuum<>>> const&, State const&, Vec3 const&, double);
template double m113::link_strain(BodyHandle<Lrvf<>> const&, State const&);
template double m113::link_bending(BodyHandle<Lrvf<>> const&, State const&, Vec3 const&, double);
template double m113::link_strain(BodyHandle<Ffr> const&, State const&);
template double m113::link_bending(BodyHandle<Ffr> const&, State const&, Vec3 const&, double);

}  // namespace polybody
