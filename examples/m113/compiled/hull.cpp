// A part of the library m113_compiled: the hull and tracks of rigid links (see m113/compiled.hpp).
#include "../compiled.hpp"

namespace polybody {

template struct JointKernels<Joint<Revolute, PenaltyPerEquation<5>>, double>;
template m113::HullSide m113::hull_side<void>(m113::Side, m113::Solids const&, double, bool);
template BodyHandle<Rigid<>> m113::detail::add_chassis<Rigid<>, Ramp>(m113::HullTypes<Rigid<>, Ramp>::Part&,
                                                                      m113::VehicleOptions const&);
template ElementHandle<Joint<PrescribedRate<Ramp>, Constraint>> m113::detail::add_carriers(
    m113::HullTypes<Rigid<>, Ramp>::Part&, m113::HullSide const&, BodyHandle<Rigid<>> const&, Ramp const&, double,
    std::vector<BodyHandle<Rigid<>>>&);
template struct m113::Carriers<Rigid<>>;
template struct m113::LinkParts<Rigid<>>;
template void m113::detail::add_links(Subassembly<Bodies<Rigid<>>>&, m113::LinkOf<Rigid<>> const&, m113::Side,
                                      m113::VehicleOptions const&, m113::LinkParts<Rigid<>>&, m113::Track&);
template void m113::detail::attach_hull(Visual&, BodyHandle<Rigid<>> const&);
template void m113::detail::attach_carriers(Visual&, m113::Carriers<Rigid<>> const&);
template void m113::detail::attach_links(Visual&, m113::LinkParts<Rigid<>> const&);
template class m113::TrackContactsAdder<Rigid<>, Rigid<>, FlatGround>;
template class m113::TrackContactsAdder<Rigid<>, Rigid<>, BumpCourse>;

}  // namespace polybody
