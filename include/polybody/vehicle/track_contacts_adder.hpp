#pragma once
/// \file
/// Contacts of the links of a track, as a part of any model that has their types. For vehicles; not included by
/// polybody.hpp.

#include <utility>
#include <vector>

#include <polybody/math/type_list.hpp>
#include <polybody/vehicle/track_contacts.hpp>
#include <polybody/vehicle/vehicle_carriers.hpp>
#include <polybody/vehicle/vehicle_tracks.hpp>

namespace polybody::m113 {

/// Adds the contacts of the links of one side to a model.
template <class Link, class Base, Terrain Ground>
class TrackContactsAdder {
 public:
  using OfLinks = LinkContacts<Link::observes>;            ///< contacts of links of this type
  using Contacts = TrackContacts<Link::observes, Ground>;  ///< contact group of the links
  /// Types of bodies and forces that a model requires for the contacts.
  using Part = Subassembly<EachOnce<Bodies, Base, Link>, Joints<>, Forces<Contacts>>;

  /// `of_links` and `options` must outlive this object.
  TrackContactsAdder(Part part, LinkOf<Link> const& of_links, VehicleOptions const& options)
      : part_(part), of_links_(of_links), options_(options) {}

  /// Adds the contacts of one track. \param name prefix of all names \returns the contact groups: one; four if contacts
  /// act at their own points
  [[gnu::cold]] std::vector<ElementHandle<Contacts>> add(std::string const& name, Carriers<Base> const& carriers,
                                                         LinkParts<Link> const& of_side, Ground const& ground,
                                                         Track& track) {
    OfLinks const of_links{options_.friction ? options_.friction_factor : 0.0};
    bool const in_the_middle = options_.contacts == ContactsAct::in_the_middle;
    double const face = in_the_middle ? pitch : pitch / 3.0;
    auto const rims = add_group(of_side.middle, name + "track", track);
    auto const rollers =
        in_the_middle ? rims : add_group(under(of_side, {-face, 0.0, face}, Face::wheels), name + "inner faces", track);
    auto const roller = [&](BodyHandle<Base> const& body, double radius) {
      auto const axle = body.at(Vec3(0, 0, 0));
      part_.add_partner(rollers, of_links.on_roller(radius, face), axle, body.name);
      part_.add_partner(rims, of_links.on_rims(radius), axle, body.name + " (horn)");
    };
    for (BodyHandle<Base> const& wheel : carriers.wheels) roller(wheel, wheel_radius);
    roller(carriers.idler[0], idler_radius);
    auto const sprocket = carriers.sprocket[0].at(Vec3(0, 0, 0));
    auto const pins = in_the_middle ? rims : add_group(of_side.front, name + "pins on teeth", track);
    part_.add_partner(pins, of_links.on_teeth(in_the_middle ? 0.5 * pitch : 0.0), sprocket, carriers.sprocket[0].name);
    double const x = pad[0].x;
    auto const pads = in_the_middle ? rims : add_group(under(of_side, {-x, x}, Face::ground), name + "pads", track);
    part_.add_partner(pads, of_links.on_terrain(ground, in_the_middle ? of_links.corners() : of_links.corners(x)),
                      part_.ground().at({0, 0, 0}), "ground");
    return std::exchange(groups_, {});
  }

 private:
  /// Adds a contact group of `markers`; each link has the same number of them.
  [[gnu::cold]] ElementHandle<Contacts> add_group(std::vector<Marker<Link>> const& markers, std::string const& name,
                                                  Track& track) {
    auto const group = part_.apply(Contacts{}, markers, name);
    groups_.push_back(group);
    Index const of_each = Index(markers.size()) / links;
    track.contacts = [group, of_each, others = track.contacts](System const& system, TouchingPointVisit const& visit) {
      if (others) others(system, visit);
      for_each_contact(system, group, [&](TouchingPoint const& p) {
        TouchingPoint of_link = p;
        of_link.body /= of_each;
        visit(of_link);
      });
    };
    return group;
  }
  /// Points on each link at the given distances in front of its middle.
  [[gnu::cold]] std::vector<Marker<Link>> under(LinkParts<Link> const& parts, std::vector<double> const& ahead,
                                                Face face) const {
    std::vector<Marker<Link>> found;
    for (auto const& link : parts.links)
      for (double const x : ahead) found.push_back(of_links_.under(link, x, face));
    return found;
  }

  Part part_;
  LinkOf<Link> const& of_links_;
  VehicleOptions const& options_;
  std::vector<ElementHandle<Contacts>> groups_ = {};
};

}  // namespace polybody::m113
