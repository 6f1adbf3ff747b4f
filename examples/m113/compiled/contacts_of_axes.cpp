// A part of the library m113_compiled: contacts of links whose markers have an axis (see m113/compiled.hpp).
#include "../compiled.hpp"

namespace polybody {

template struct ForceKernels<m113::TrackContacts<MarkerKind::axis, FlatGround>, double>;
template void m113::TrackContacts<MarkerKind::axis, FlatGround>::check(std::string const&) const;
template void for_each_contact(System const&, ElementHandle<m113::TrackContacts<MarkerKind::axis, FlatGround>> const&,
                               TouchingPointVisit const&);
template void detail::add_contact_partner(detail::ModelParts&,
                                          detail::ForceEntry<m113::TrackContacts<MarkerKind::axis, FlatGround>>&,
                                          m113::LinkContacts<MarkerKind::axis>::OnRoller const&,
                                          detail::PooledMarker<Rigid<>> const&, std::string);
template void detail::add_contact_partner(detail::ModelParts&,
                                          detail::ForceEntry<m113::TrackContacts<MarkerKind::axis, FlatGround>>&,
                                          m113::LinkContacts<MarkerKind::axis>::OnRims const&,
                                          detail::PooledMarker<Rigid<>> const&, std::string);
template void detail::add_contact_partner(detail::ModelParts&,
                                          detail::ForceEntry<m113::TrackContacts<MarkerKind::axis, FlatGround>>&,
                                          m113::LinkContacts<MarkerKind::axis>::OnSprocket const&,
                                          detail::PooledMarker<Rigid<>> const&, std::string);
template void detail::add_contact_partner(detail::ModelParts&,
                                          detail::ForceEntry<m113::TrackContacts<MarkerKind::axis, FlatGround>>&,
                                          m113::LinkContacts<MarkerKind::axis>::OnGround<FlatGround> const&,
                                          detail::PooledMarker<Ground> const&, std::string);
template struct ForceKernels<m113::TrackContacts<MarkerKind::axis, BumpCourse>, double>;
template void m113::TrackContacts<MarkerKind::axis, BumpCourse>::check(std::string const&) const;
template void for_each_contact(System const&, ElementHandle<m113::TrackContacts<MarkerKind::axis, BumpCourse>> const&,
                               TouchingPointVisit const&);
template void detail::add_contact_partner(detail::ModelParts&,
                                          detail::ForceEntry<m113::TrackContacts<MarkerKind::axis, BumpCourse>>&,
                                          m113::LinkContacts<MarkerKind::axis>::OnRoller const&,
                                          detail::PooledMarker<Rigid<>> const&, std::string);
template void detail::add_contact_partner(detail::ModelParts&,
                                          detail::ForceEntry<m113::TrackContacts<MarkerKind::axis, BumpCourse>>&,
                                          m113::LinkContacts<MarkerKind::axis>::OnRims const&,
                                          detail::PooledMarker<Rigid<>> const&, std::string);
template void detail::add_contact_partner(detail::ModelParts&,
                                          detail::ForceEntry<m113::TrackContacts<MarkerKind::axis, BumpCourse>>&,
                                          m113::LinkContacts<MarkerKind::axis>::OnSprocket const&,
                                          detail::PooledMarker<Rigid<>> const&, std::string);
template void detail::add_contact_partner(detail::ModelParts&,
                                          detail::ForceEntry<m113::TrackContacts<MarkerKind::axis, BumpCourse>>&,
                                          m113::LinkContacts<MarkerKind::axis>::OnGround<BumpCourse> const&,
                                          detail::PooledMarker<Ground> const&, std::string);

}  // namespace polybody
