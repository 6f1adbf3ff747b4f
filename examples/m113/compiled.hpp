#pragma once
/// \file
/// polybody/compiled.hpp with the vehicle of vehicle.hpp, for programs that link `m113_compiled`. This library contains
/// the vehicle's hull and contacts on a FlatGround or a BumpCourse, compiled once for all formulations of the tracks.

#include <polybody/compiled.hpp>

#include "link_strain.hpp"
#include "modal_links.hpp"
#include "settled_track.hpp"
#include "visual.hpp"

namespace polybody {

extern template struct JointKernels<Joint<Revolute, PenaltyPerEquation<5>>, double>;
extern template m113::HullSide m113::hull_side<void>(m113::Side, m113::Solids const&, double, bool);
extern template BodyHandle<Rigid<>> m113::detail::add_chassis<Rigid<>, Ramp>(m113::HullTypes<Rigid<>, Ramp>::Part&,
                                                                             m113::VehicleOptions const&);
extern template ElementHandle<Joint<PrescribedRate<Ramp>, Constraint>> m113::detail::add_carriers(
    m113::HullTypes<Rigid<>, Ramp>::Part&, m113::HullSide const&, BodyHandle<Rigid<>> const&, Ramp const&, double,
    std::vector<BodyHandle<Rigid<>>>&);
extern template struct m113::Carriers<Rigid<>>;
extern template struct m113::LinkParts<Rigid<>>;
extern template void m113::detail::add_links(Subassembly<Bodies<Rigid<>>>&, m113::LinkOf<Rigid<>> const&, m113::Side,
                                             m113::VehicleOptions const&, m113::LinkParts<Rigid<>>&, m113::Track&);
extern template void m113::detail::attach_hull(Visual&, BodyHandle<Rigid<>> const&);
extern template void m113::detail::attach_carriers(Visual&, m113::Carriers<Rigid<>> const&);
extern template void m113::detail::attach_links(Visual&, m113::LinkParts<Rigid<>> const&);
extern template class m113::TrackContactsAdder<Rigid<>, Rigid<>, FlatGround>;
extern template class m113::TrackContactsAdder<Rigid<>, Rigid<>, BumpCourse>;

extern template struct ForceKernels<m113::TrackContacts<MarkerKind::axis, FlatGround>, double>;
extern template void m113::TrackContacts<MarkerKind::axis, FlatGround>::check(std::string const&) const;
extern template void for_each_contact(System const&,
                                      ElementHandle<m113::TrackContacts<MarkerKind::axis, FlatGround>> const&,
                                      TouchingPointVisit const&);
extern template void detail::add_contact_partner(detail::ModelParts&,
                                                 detail::ForceEntry<m113::TrackContacts<MarkerKind::axis, FlatGround>>&,
                                                 m113::LinkContacts<MarkerKind::axis>::OnRoller const&,
                                                 detail::PooledMarker<Rigid<>> const&, std::string);
extern template void detail::add_contact_partner(detail::ModelParts&,
                                                 detail::ForceEntry<m113::TrackContacts<MarkerKind::axis, FlatGround>>&,
                                                 m113::LinkContacts<MarkerKind::axis>::OnRims const&,
                                                 detail::PooledMarker<Rigid<>> const&, std::string);
extern template void detail::add_contact_partner(detail::ModelParts&,
                                                 detail::ForceEntry<m113::TrackContacts<MarkerKind::axis, FlatGround>>&,
                                                 m113::LinkContacts<MarkerKind::axis>::OnSprocket const&,
                                                 detail::PooledMarker<Rigid<>> const&, std::string);
extern template void detail::add_contact_partner(detail::ModelParts&,
                                                 detail::ForceEntry<m113::TrackContacts<MarkerKind::axis, FlatGround>>&,
                                                 m113::LinkContacts<MarkerKind::axis>::OnGround<FlatGround> const&,
                                                 detail::PooledMarker<Ground> const&, std::string);

extern template struct ForceKernels<m113::TrackContacts<MarkerKind::axis, BumpCourse>, double>;
extern template void m113::TrackContacts<MarkerKind::axis, BumpCourse>::check(std::string const&) const;
extern template void for_each_contact(System const&,
                                      ElementHandle<m113::TrackContacts<MarkerKind::axis, BumpCourse>> const&,
                                      TouchingPointVisit const&);
extern template void detail::add_contact_partner(detail::ModelParts&,
                                                 detail::ForceEntry<m113::TrackContacts<MarkerKind::axis, BumpCourse>>&,
                                                 m113::LinkContacts<MarkerKind::axis>::OnRoller const&,
                                                 detail::PooledMarker<Rigid<>> const&, std::string);
extern template void detail::add_contact_partner(detail::ModelParts&,
                                                 detail::ForceEntry<m113::TrackContacts<MarkerKind::axis, BumpCourse>>&,
                                                 m113::LinkContacts<MarkerKind::axis>::OnRims const&,
                                                 detail::PooledMarker<Rigid<>> const&, std::string);
extern template void detail::add_contact_partner(detail::ModelParts&,
                                                 detail::ForceEntry<m113::TrackContacts<MarkerKind::axis, BumpCourse>>&,
                                                 m113::LinkContacts<MarkerKind::axis>::OnSprocket const&,
                                                 detail::PooledMarker<Rigid<>> const&, std::string);
extern template void detail::add_contact_partner(detail::ModelParts&,
                                                 detail::ForceEntry<m113::TrackContacts<MarkerKind::axis, BumpCourse>>&,
                                                 m113::LinkContacts<MarkerKind::axis>::OnGround<BumpCourse> const&,
                                                 detail::PooledMarker<Ground> const&, std::string);

extern template struct ForceKernels<m113::TrackContacts<MarkerKind::frame, FlatGround>, double>;
extern template void m113::TrackContacts<MarkerKind::frame, FlatGround>::check(std::string const&) const;
extern template void for_each_contact(System const&,
                                      ElementHandle<m113::TrackContacts<MarkerKind::frame, FlatGround>> const&,
                                      TouchingPointVisit const&);
extern template void detail::add_contact_partner(
    detail::ModelParts&, detail::ForceEntry<m113::TrackContacts<MarkerKind::frame, FlatGround>>&,
    m113::LinkContacts<MarkerKind::frame>::OnRoller const&, detail::PooledMarker<Rigid<>> const&, std::string);
extern template void detail::add_contact_partner(
    detail::ModelParts&, detail::ForceEntry<m113::TrackContacts<MarkerKind::frame, FlatGround>>&,
    m113::LinkContacts<MarkerKind::frame>::OnRims const&, detail::PooledMarker<Rigid<>> const&, std::string);
extern template void detail::add_contact_partner(
    detail::ModelParts&, detail::ForceEntry<m113::TrackContacts<MarkerKind::frame, FlatGround>>&,
    m113::LinkContacts<MarkerKind::frame>::OnSprocket const&, detail::PooledMarker<Rigid<>> const&, std::string);
extern template void detail::add_contact_partner(
    detail::ModelParts&, detail::ForceEntry<m113::TrackContacts<MarkerKind::frame, FlatGround>>&,
    m113::LinkContacts<MarkerKind::frame>::OnGround<FlatGround> const&, detail::PooledMarker<Ground> const&,
    std::string);

extern template struct ForceKernels<m113::TrackContacts<MarkerKind::frame, BumpCourse>, double>;
extern template void m113::TrackContacts<MarkerKind::frame, BumpCourse>::check(std::string const&) const;
extern template void for_each_contact(System const&,
                                      ElementHandle<m113::TrackContacts<MarkerKind::frame, BumpCourse>> const&,
                                      TouchingPointVisit const&);
extern template void detail::add_contact_partner(
    detail::ModelParts&, detail::ForceEntry<m113::TrackContacts<MarkerKind::frame, BumpCourse>>&,
    m113::LinkContacts<MarkerKind::frame>::OnRoller const&, detail::PooledMarker<Rigid<>> const&, std::string);
extern template void detail::add_contact_partner(
    detail::ModelParts&, detail::ForceEntry<m113::TrackContacts<MarkerKind::frame, BumpCourse>>&,
    m113::LinkContacts<MarkerKind::frame>::OnRims const&, detail::PooledMarker<Rigid<>> const&, std::string);
extern template void detail::add_contact_partner(
    detail::ModelParts&, detail::ForceEntry<m113::TrackContacts<MarkerKind::frame, BumpCourse>>&,
    m113::LinkContacts<MarkerKind::frame>::OnSprocket const&, detail::PooledMarker<Rigid<>> const&, std::string);
extern template void detail::add_contact_partner(
    detail::ModelParts&, detail::ForceEntry<m113::TrackContacts<MarkerKind::frame, BumpCourse>>&,
    m113::LinkContacts<MarkerKind::frame>::OnGround<BumpCourse> const&, detail::PooledMarker<Ground> const&,
    std::string);

extern template double m113::link_strain(BodyHandle<AncfBeam<>> const&, State const&);
extern template double m113::link_bending(BodyHandle<AncfBeam<>> const&, State const&, Vec3 const&, double);
extern template double m113::link_strain(BodyHandle<AncfCable<>> const&, State const&);
extern template double m113::link_bending(BodyHandle<AncfCable<>> const&, State const&, Vec3 const&, double);
extern template double m113::link_strain(BodyHandle<AncfBeam<Continuum<>>> const&, State const&);
extern template double m113::link_bending(BodyHandle<AncfBeam<Continuum<>>> const&, State const&, Vec3 const&, double);
extern template double m113::link_strain(BodyHandle<Lrvf<>> const&, State const&);
extern template double m113::link_bending(BodyHandle<Lrvf<>> const&, State const&, Vec3 const&, double);
extern template double m113::link_strain(BodyHandle<Ffr> const&, State const&);
extern template double m113::link_bending(BodyHandle<Ffr> const&, State const&, Vec3 const&, double);

extern template struct BodyKernels<Ffr, double>;
extern template Frame<double> frame(BodyInState<Ffr> const&, FfrPoint const&);
extern template FrameIn frame_in(BodyHandle<Ffr> const&, Marker<Ffr> const&);
extern template void Visual::attach(Marker<Ffr> const&, Surface const&, std::string);
extern template void Visual::sweep(BodyHandle<Ffr> const&, Bar const&, int, int);
extern template Ffr m113::LinkOf<Ffr>::make<void>(m113::Solid const&, Placement const&, int) const;
extern template Marker<Ffr> m113::LinkOf<Ffr>::pin<void>(BodyHandle<Ffr> const&, double) const;
extern template Marker<Ffr> m113::LinkOf<Ffr>::under<void>(BodyHandle<Ffr> const&, double, m113::Face) const;

extern template m113::TrackStart m113::settled_track(m113::VehicleOptions, FlatGround const&);
extern template m113::TrackStart m113::settled_track(m113::VehicleOptions, BumpCourse const&);

}  // namespace polybody
