// A part of polybody::compiled_vehicle: contacts of links that publish a frame (see polybody/compiled_vehicle.hpp).
#include <polybody/compiled_vehicle.hpp>

namespace polybody {

template struct ForceKernels<m113::TrackContacts<Observes::frame, FlatGround>, double>;
template void m113::TrackContacts<Observes::frame, FlatGround>::check(std::string const&) const;
template void for_each_contact(System const&, ElementHandle<m113::TrackContacts<Observes::frame, FlatGround>> const&,
                               TouchingPointVisit const&);
template void detail::add_opponent(detail::ModelParts&,
                                   detail::ForceEntry<m113::TrackContacts<Observes::frame, FlatGround>>&,
                                   m113::LinkContacts<Observes::frame>::OnRoller const&,
                                   detail::PooledMarker<Rigid<>> const&, std::string);
template void detail::add_opponent(detail::ModelParts&,
                                   detail::ForceEntry<m113::TrackContacts<Observes::frame, FlatGround>>&,
                                   m113::LinkContacts<Observes::frame>::OnRims const&,
                                   detail::PooledMarker<Rigid<>> const&, std::string);
template void detail::add_opponent(detail::ModelParts&,
                                   detail::ForceEntry<m113::TrackContacts<Observes::frame, FlatGround>>&,
                                   m113::LinkContacts<Observes::frame>::OnSprocket const&,
                                   detail::PooledMarker<Rigid<>> const&, std::string);
template void detail::add_opponent(detail::ModelParts&,
                                   detail::ForceEntry<m113::TrackContacts<Observes::frame, FlatGround>>&,
                                   m113::LinkContacts<Observes::frame>::OnGround<FlatGround> const&,
                                   detail::PooledMarker<Ground> const&, std::string);
template struct ForceKernels<m113::TrackContacts<Observes::frame, BumpCourse>, double>;
template void m113::TrackContacts<Observes::frame, BumpCourse>::check(std::string const&) const;
template void for_each_contact(System const&, ElementHandle<m113::TrackContacts<Observes::frame, BumpCourse>> const&,
                               TouchingPointVisit const&);
template void detail::add_opponent(detail::ModelParts&,
                                   detail::ForceEntry<m113::TrackContacts<Observes::frame, BumpCourse>>&,
                                   m113::LinkContacts<Observes::frame>::OnRoller const&,
                                   detail::PooledMarker<Rigid<>> const&, std::string);
template void detail::add_opponent(detail::ModelParts&,
                                   detail::ForceEntry<m113::TrackContacts<Observes::frame, BumpCourse>>&,
                                   m113::LinkContacts<Observes::frame>::OnRims const&,
                                   detail::PooledMarker<Rigid<>> const&, std::string);
template void detail::add_opponent(detail::ModelParts&,
                                   detail::ForceEntry<m113::TrackContacts<Observes::frame, BumpCourse>>&,
                                   m113::LinkContacts<Observes::frame>::OnSprocket const&,
                                   detail::PooledMarker<Rigid<>> const&, std::string);
template void detail::add_opponent(detail::ModelParts&,
                                   detail::ForceEntry<m113::TrackContacts<Observes::frame, BumpCourse>>&,
                                   m113::LinkContacts<Observes::frame>::OnGround<BumpCourse> const&,
                                   detail::PooledMarker<Ground> const&, std::string);

}  // namespace polybody
