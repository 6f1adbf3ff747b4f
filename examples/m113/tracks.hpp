#pragma once
/// \file
/// Tracks of the vehicle: links and their contacts, as parts of any model that has their types.

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <polybody/forces/contact_group.hpp>
#include <polybody/math/type_list.hpp>
#include <polybody/system/subassembly.hpp>
#include <polybody/vehicle/link_ground_contact.hpp>
#include <polybody/vehicle/link_roller_contact.hpp>
#include <polybody/vehicle/pin_sprocket_contact.hpp>

#include "hull.hpp"
#include "links.hpp"
#include "options.hpp"
#include "track_frames.hpp"

namespace polybody::m113 {

/// Links of one track.
template <class Link>
struct LinkParts {
  std::vector<BodyHandle<Link>> links = {};  ///< links in the order of the track; pin i is in front of link i
  std::vector<Marker<Link>> front = {}, middle = {}, rear = {};  ///< markers of each link: front pin, middle, rear pin

  /// Appends `link` and its markers at the pins and the middle. Appends the frames of these markers to `track`.
  void add(LinkOf<Link> const& of, BodyHandle<Link> const& link, Track& track) {
    links.push_back(link);
    front.push_back(of.front(link));
    middle.push_back(of.middle(link));
    rear.push_back(of.rear(link));
    track.front.push_back(frame_in(link, front.back()));
    track.middle.push_back(frame_in(link, middle.back()));
    track.rear.push_back(frame_in(link, rear.back()));
  }
};

namespace detail {

/// Adds the 64 links of one side, with names that begin with `name`.
template <class Link>
[[gnu::cold]] void add_links(Subassembly<Bodies<Link>>& part, LinkOf<Link> const& of_links, Side s,
                             VehicleOptions const& options, LinkParts<Link>& parts, Track& track) {
  std::string const name = s == Side::left ? "left link " : "right link ";
  for (int i = 0; i < links; ++i) {
    Placement const place = options.start.links[std::size_t(i)].placement(sign(s) * track_y);
    Link const link = of_links.make(options.masses.link, place, options.link_elements);
    parts.add(of_links, part.add(link, name + std::to_string(i)), track);
  }
}

}  // namespace detail

/// Profile of the teeth of the sprockets.
inline SprocketProfile sprocket_profile() {
  return {.teeth = teeth,
          .pitch = pitch,
          .pin_radius = pin_radius,
          .valley_radius = valley_radius,
          .flank = flank,
          .tip_radius = tip_radius};
}

/// Contacts of links whose markers are of the kind `observed`. Contacts of cables lie in the middle plane of the track:
/// one contact of a cable represents two contacts of a rigid link.
template <MarkerKind observed>
struct LinkContacts {
  using OnRoller = Contact<LinkRollerContact<observed>>;     ///< inner face on the rims of a wheel
  using OnRims = Contact<GuideHornContact<observed>>;        ///< horn between the rims of a wheel
  using OnSprocket = Contact<PinSprocketContact<observed>>;  ///< front pin between the teeth
  /// Pad on the ground.
  template <Terrain Ground>
  using OnGround = Contact<LinkGroundContact<Ground, observed>>;
  /// True for links that are cables: they have no roll, so contacts lie in the track's middle plane.
  static constexpr bool in_plane = observed != MarkerKind::frame;

  double friction = 1.0;  ///< factor of the friction coefficients of data.hpp [1]; 0: no friction
  bool shared = false;    ///< true: as `VehicleOptions::shared_contacts`

  /// Contact of a link with rollers of this `radius` [m]. \param length length of the face along the link [m]
  OnRoller on_roller(double radius, double length = pitch) const {
    return law(LinkRollerContact<observed>{.pitch = length,
                                           .half_thickness = half_thickness,
                                           .half_width = half_width,
                                           .radius = radius,
                                           .handover = std::min(0.03, 0.49 * length),
                                           .rims = in_plane ? std::vector{0.0} : std::vector{-rim_y, rim_y}},
               on_wheel, 2.0);
  }
  /// Contact of the horn with rims of this `radius` [m].
  OnRims on_rims(double radius) const {
    Vec3 const tip(horn.x, horn.y, horn.z + 0.5 * horn_size.z);
    return law(GuideHornContact<observed>{.tip = tip, .play = horn_play, .radius = radius}, on_wheel, 1.0);
  }
  /// Contact of a pin with the teeth. \param ahead distance from the marker to the front pin [m]
  OnSprocket on_teeth(double ahead = 0.5 * pitch) const {
    return law(PinSprocketContact<observed>{.profile = sprocket_profile(),
                                            .valley = first_valley,
                                            .rings = in_plane ? std::vector{0.0} : std::vector{-tooth_y, tooth_y},
                                            .ahead = ahead},
               on_sprocket, 2.0);
  }
  /// Contact of the pad with the ground. \param corners corners of the pad, relative to the marker
  template <Terrain Ground>
  OnGround<Ground> on_terrain(Ground const& ground, std::vector<Vec3> const& corners) const {
    return law(LinkGroundContact<Ground, observed>{.terrain = ground, .pad = corners}, on_ground, double(pad.size()));
  }
  /// Corners of the pad relative to a marker on the middle line at the distance `x` in front of the link's centre. If
  /// `x` is given, the result contains the corners at `x` only; otherwise, it contains all corners.
  static std::vector<Vec3> corners(std::optional<double> x = {}) {
    std::vector<Vec3> found;
    for (Vec3Storage const& p : pad)
      if ((!in_plane || p.y > 0.0) && (!x || p.x == *x))
        found.push_back(Vec3(p.x - (x ? *x : 0.0), in_plane ? 0.0 : p.y, p.z));
    return found;
  }

 private:
  /// `points`: number of contact points of a rigid link on one body.
  template <ContactGeometry G>
  Contact<G> law(G const& geometry, ContactNumbers const& c, double points) const {
    double const share = (in_plane ? 2.0 : 1.0) / (shared ? points : 1.0);
    return {geometry,
            {.stiffness = share * c.stiffness, .damping = share * c.damping, .onset = onset},
            {.coefficient = friction * c.friction, .slip_speed = slip_speed}};
  }
};

/// Contact group for links with markers of the kind `observed`, on one type of ground.
template <MarkerKind observed, Terrain Ground>
using TrackContacts = ContactGroup<typename LinkContacts<observed>::OnRoller, typename LinkContacts<observed>::OnRims,
                                   typename LinkContacts<observed>::OnSprocket,
                                   typename LinkContacts<observed>::template OnGround<Ground>>;

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

  /// Adds the contacts of one track. \param name prefix of all names \returns one contact group, or four if contacts
  /// act at their own points
  [[gnu::cold]] std::vector<ElementHandle<Contacts>> add(std::string const& name, Carriers<Base> const& carriers,
                                                         LinkParts<Link> const& of_side, Ground const& ground,
                                                         Track& track) {
    OfLinks const of_links{options_.friction ? options_.friction_factor : 0.0, options_.shared_contacts};
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
  /// Adds a contact group of `markers`; each link has the same number of markers.
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
