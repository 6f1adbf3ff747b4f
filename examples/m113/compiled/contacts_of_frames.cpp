// A part of the library m113_compiled: contacts of links whose markers have a frame (see m113/compiled.hpp).
#include "../compiled.hpp"

namespace polybody {

template struct ForceKernels<m113::TrackContacts<MarkerKind::frame, FlatGround>, double>;
template void m113::TrackContacts<MarkerKind::frame, FlatGround>::check(std::string const&) const;
template void for_each_contact(System const&, ElementHandle<m113::TrackContacts<MarkerKind::frame, FlatGround>> const&,
                               TouchingPointVisit const&);
template void detail::add_contact_partner(detail::ModelParts&,
                                          detail::ForceEntry<m113::TrackContacts<MarkerKind::frame, FlatGround>>&,
                                          m113::LinkContacts<MarkerKind::frame>::OnRoller const&,
                                          detail::PooledMarker<Rigid<>> const&, std::string);
template void detail::add_contact_partner(detail::ModelParts&,
                                          detail::ForceEntry<m113::TrackContacts<MarkerKind::frame, FlatGround>>&,
                                          m113::LinkContacts<MarkerKind::frame>::OnRims const&,
                                          detail::PooledMarker<Rigid<>> const&, std::string);
template void detail::add_contact_partner(detail::ModelParts&,
                                          detail::ForceEntry<m113::TrackContacts<MarkerKind::frame, FlatGround>>&,
                                          m113::LinkContacts<MarkerKind::frame>::OnSprocket const&,
                                          detail::PooledMarker<Rigid<>> const&, std::string);
template void detail::add_contact_partner(detail::ModelParts&,
                                          detail::ForceEntry<m113::TrackContacts<MarkerKind::frame, FlatGround>>&,
                                          m113::LinkContacts<MarkerKind::frame>::OnGround<FlatGround> const&,
                                          detail::PooledMarker<Ground> const&, std::string);
template struct ForceKernels<m113::TrackContacts<MarkerKind::frame, BumpCourse>, double>;
template void m113::TrackContacts<MarkerKind::frame, BumpCourse>::check(std::string const&) const;
template void for_each_contact(System const&, ElementHandle<m113::TrackContacts<MarkerKind::frame, BumpCourse>> const&,
                               TouchingPointVisit const&);
template void detail::add_contact_partner(detail::ModelParts&,
                                          detail::ForceEntry<m113::TrackContacts<MarkerKind::frame, BumpCourse>>&,
                                          m113::LinkContacts<MarkerKind::frame>::OnRoller const&,
                                          detail::PooledMarker<Rigid<>> const&, std::string);
template void detail::add_contact_partner(detail::ModelParts&,
                                          detail::ForceEntry<m113::TrackContacts<MarkerKind::frame, BumpCourse>>&,
                                          m113::LinkContacts<MarkerKind::frame>::OnRims const&,
                                          detail::PooledMarker<Rigid<>> const&, std::string);
template void detail::add_contact_partner(detail::ModelParts&,
                                          detail::ForceEntry<m113::TrackContacts<MarkerKind::frame, BumpCourse>>&,
                                          m113::LinkContacts<MarkerKind::frame>::OnSprocket const&,
                                          detail::PooledMarker<Rigid<>> const&, std::string);
template void detail::add_contact_partner(detail::ModelParts&,
                                          detail::ForceEntry<m113::TrackContacts<MarkerKind::frame, BumpCourse>>&,
                                          m113::LinkContacts<MarkerKind::frame>::OnGround<BumpCourse> const&,
                                          detail::PooledMarker<Ground> const&, std::string);

}  // namespace polybody
