// A part of the library m113_compiled: links with a floating frame (see m113/compiled.hpp).
#include "../compiled.hpp"

namespace polybody {

template struct BodyKernels<Ffr, double>;
template Frame<double> frame(BodyInState<Ffr> const&, FfrPoint const&);
template FrameIn frame_in(BodyHandle<Ffr> const&, Marker<Ffr> const&);
template void Visual::attach(Marker<Ffr> const&, Surface const&, std::string);
template void Visual::sweep(BodyHandle<Ffr> const&, Bar const&, int, int);
template Ffr m113::LinkOf<Ffr>::make<void>(m113::Solid const&, Placement const&, int) const;
template Marker<Ffr> m113::LinkOf<Ffr>::pin<void>(BodyHandle<Ffr> const&, double) const;
template Marker<Ffr> m113::LinkOf<Ffr>::under<void>(BodyHandle<Ffr> const&, double, m113::Face) const;

}  // namespace polybody
