#pragma once
/// \file
/// The vehicle of m113.hpp as a model, its tracks under a formulation of choice. Not in polybody.hpp: of use to
/// vehicles only.

#include <array>
#include <vector>

#include <polybody/forces/axial_spring.hpp>
#include <polybody/forces/spring_damper.hpp>
#include <polybody/joints/point_on_line.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/prescribed_rate.hpp>
#include <polybody/joints/prismatic.hpp>
#include <polybody/joints/revolute.hpp>
#include <polybody/joints/spherical.hpp>
#include <polybody/joints/weld.hpp>
#include <polybody/system/model.hpp>
#include <polybody/vehicle/hull.hpp>
#include <polybody/vehicle/track_contacts.hpp>
#include <polybody/vehicle/track_links.hpp>
#include <polybody/vehicle/track_path.hpp>
#include <polybody/vehicle/tracked_vehicle.hpp>

namespace polybody::m113 {

/// Where the links of either side and the idler are at the start.
struct TrackStart {
  double idler_x = idler_reference_x;                        ///< [m]
  std::vector<TrackLink> links = wrap_track(track()).links;  ///< 64
};

/// Pins as penalties of `stiffness` [N/m]: rows that are direction cosines get that of forces at the ends of a link's
/// width.
inline PenaltyPerRow<5> penalty_pin(double stiffness) {
  Vec<double, 5> rows;
  rows << 1.0, 1.0, 1.0, pin_arm * pin_arm, pin_arm * pin_arm;
  return {.stiffness = Vec<double, 5>(stiffness * rows), .damping = Vec<double, 5>(pin_damping * rows)};
}
/// Pins as bushings of `stiffness` [N/m], whose third axis is the pin's.
inline Bushing bushing_pin(double stiffness) {
  Vec3 const along(1.0, 1.0, 1.0), about(pin_arm * pin_arm, pin_arm * pin_arm, 0.0);
  return {.stiffness = Bushing::diagonal(stiffness * along, stiffness * about),
          .damping = Bushing::diagonal(pin_damping * along, pin_damping * about)};
}

/// How a track of ideal pins closes. Pins about parallel axes around a loop have three rows too many.
enum class Closure {
  stiff_spring,  ///< the 64th pin is no constraint but 10⁹ N/m between two points, as thesis Table 3.4 counts
  in_plane       ///< two rows hold its points together across the pin's axis: the loop needs no more
};

/// Where on a link that what it touches acts, as a wrench.
enum class ContactsAct {
  in_the_middle,   ///< all about the link's middle
  at_their_places  ///< wheels about the middle of a third of the link, teeth about the front pin, the ground about the
                   ///< pairs of corners of the pad, rims about the middle
};

/// Options of the vehicle besides the formulation of its tracks. The defaults are those of m113.hpp.
struct VehicleOptions {
  Solids masses = thesis;
  bool suspension = true;          ///< else the arms are welded to the chassis, without springs
  double preload = m113::preload;  ///< of the tensioners [N]
  int cut = 0;                     ///< the pin of each track that closes the loop where pins are rows
  Closure closure = Closure::stiff_spring;
  TrackStart start = {};
  int link_elements = 0;  ///< of each flexible link; 0: one, and two of a floating frame
  bool friction = true;
  ContactsAct contacts = ContactsAct::in_the_middle;
  bool held = false;         ///< the chassis is welded to the ground and the arms to the chassis
  bool ground_body = false;  ///< as thesis Table 3.4 counts: the ground is a body too, welded to the world
};

/// \throws InvalidInput.
template <class = void>  // compiled where it is used
void check(VehicleOptions const& options) {
  if (options.start.links.size() != std::size_t(links))
    throw InvalidInput{"M113: the start needs the places of ", links, " links, but has ", options.start.links.size(),
                       "."};
  if (options.cut < 0 || options.cut >= links)
    throw InvalidInput{"M113: the pin that closes a track is one of 0 … 63, but ", options.cut, " is asked for."};
  if (options.link_elements < 0)
    throw InvalidInput{"M113: a flexible link has one element or more, but ", options.link_elements, " are asked for."};
}

/// The bodies that carry one track.
template <class Base>
struct Carriers {
  std::vector<BodyHandle<Base>> wheels = {}, arms = {}, sprocket = {}, idler = {},
                                tensioner = {};  ///< the last three: one each

  /// \param bodies the chassis and those of `hull`
  void set(HullSide const& hull, std::vector<BodyHandle<Base>> const& bodies, Track& track) {
    sprocket = {bodies[hull.sprocket]};
    tensioner = {bodies[hull.tensioner]};
    idler = {bodies[hull.idler]};
    for (int i = 0; i < m113::wheels; ++i) {
      wheels.push_back(bodies[hull.wheel(i)]);
      arms.push_back(bodies[hull.arm(i)]);
    }
    track.sprocket = frame_in(sprocket[0], sprocket[0].at(Vec3(0, 0, 0)));
    track.tensioner = frame_in(tensioner[0], tensioner[0].at(Vec3(0, 0, 0)));
  }
};

/// The links of one track.
template <class Link>
struct LinkParts {
  std::vector<BodyHandle<Link>> links = {};
  std::vector<Marker<Link>> front = {}, middle = {}, rear = {};  ///< of each link: front pin, middle, rear pin

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

/// Chassis, and on each side sprocket, idler, tensioner, five wheels on arms and 64 links; `Link` is a link's body,
/// `PinPolicy` how links hang together. Where pins are rows or joint coordinates, 63 of a track are, and the last one
/// is as `Closure` says; where they are forces or linear rows, all 64 are alike.
template <class Link = Rigid<>, Policy PinPolicy = Constraint, Terrain Ground = FlatGround, TimeLaw Drive = Ramp>
class Vehicle : public TrackedVehicle {
 public:
  using LinkType = Link;
  static constexpr Observes observed = Link::observes;
  static constexpr bool closes_alike = AddsForce<PinPolicy> || LinearInCoordinates<PinPolicy>;
  using Base =
      std::conditional_t<std::is_same_v<Link, Rigid<EulerParameters>>, Link, Rigid<>>;  ///< of all that is no link
  using Hinge = Joint<Revolute, Constraint>;
  using Slide = Joint<Prismatic, Constraint>;
  using Fixed = Joint<Weld, Constraint>;
  using Driven = Joint<PrescribedRate<Drive>, Constraint>;
  using Pin = Joint<Revolute, PinPolicy>;
  using SpringPin = std::conditional_t<closes_alike, Pin, Joint<Spherical, Penalty>>;
  using PlanePin = std::conditional_t<closes_alike, Pin, Joint<PointOnLine, Constraint>>;
  using OfLinks = LinkContacts<observed>;
  using Contacts = ContactGroup<typename OfLinks::OnRoller, typename OfLinks::OnRims, typename OfLinks::OnSprocket,
                                typename OfLinks::template OnGround<Ground>>;
  using ModelType =
      Model<EachOnce<Bodies, Base, Link>, EachOnce<Joints, Hinge, Slide, Fixed, Driven, Pin, SpringPin, PlanePin>,
            Forces<SpringDamper, AxialSpring, Contacts>>;
  using Handle = BodyHandle<Base>;

  /// One side. Pin i is in front of link i; `pins[i]` is at pin i but for the one where the loop is cut.
  struct SideParts : Carriers<Base>, LinkParts<Link> {
    std::vector<ElementHandle<Pin>> pins = {};
    std::vector<ElementHandle<Driven>> drive = {};       ///< one
    std::vector<ElementHandle<Contacts>> contacts = {};  ///< one; four where contacts act at their places
  };

  ModelType model{Gravity{0, 0, -9.81}};
  std::vector<Handle> chassis;  ///< one
  std::array<SideParts, 2> sides;

  SideParts const& side(Side s) const { return sides[s == Side::left ? 0 : 1]; }

  /// \throws InvalidInput.
  Vehicle(PinPolicy const& pin, std::array<Drive, 2> const& drives, VehicleOptions const& options = {},
          Ground const& ground = {}, LinkOf<Link> const& of_links = {})
      : of_links_(of_links) {
    check(options);
    if (options.ground_body) {
      auto const body = model.add(solid({1.0, {1, 1, 1}}, Vec3(0, 0, 0)), "ground body");
      model.connect(Fixed{}, model.ground().at({0, 0, 0}), body.at(Vec3(0, 0, 0)), "ground weld");
    }
    chassis.push_back(model.add(solid(options.masses.chassis, m113::chassis), "chassis"));
    hull = frame_in(chassis[0], chassis[0].at(Vec3(0, 0, 0)));
    if (options.held)
      model.connect(Fixed{}, model.ground().at(Vec3(m113::chassis)), chassis[0].at(Vec3(0, 0, 0)), "hold");
    add_side(Side::left, pin, drives[0], options, ground);
    add_side(Side::right, pin, drives[1], options, ground);
  }

 private:
  static Base solid(Solid const& s, Vec3 const& centre, double about_y = 0.0) {
    return Base(s.mass, detail::principal(s.inertia), Placement::at(centre, Vec3(0, about_y, 0)));
  }

  void add_side(Side s, PinPolicy const& pin, Drive const& drive, VehicleOptions const& options, Ground const& ground) {
    SideParts& parts = sides[s == Side::left ? 0 : 1];
    HullSide const of_side = hull_side(s, options.masses, options.start.idler_x, options.suspension && !options.held);
    std::vector<Handle> bodies{chassis[0]};
    for (HullBody const& b : of_side.bodies) bodies.push_back(model.add(solid(b.solid, b.centre, b.about_y), b.name));
    parts.set(of_side, bodies, tracks[s == Side::left ? 0 : 1]);
    for (HullJoint const& j : of_side.joints)
      join(j, bodies[j.a].at(j.at_a), bodies[j.b].at(j.at_b), drive, options, parts);
    add_links(s, of_side.name, pin, options, parts);
    add_contacts(s, of_side.name, options, ground);
  }

  void join(HullJoint const& j, Marker<Base> const& a, Marker<Base> const& b, Drive const& drive,
            VehicleOptions const& options, SideParts& parts) {
    Vec3 const y = Vec3::UnitY();
    switch (j.kind) {
      case HullJoint::Kind::axle:
        model.connect(Hinge{Revolute{.axis = y}, {}}, a, b, j.name);
        break;
      case HullJoint::Kind::mount:
        model.connect(Fixed{}, a, b, j.name);
        break;
      case HullJoint::Kind::guide:
        model.connect(Slide{Prismatic{.axis = Vec3::UnitX()}, {}}, a, b, j.name);
        break;
      case HullJoint::Kind::drive:
        parts.drive.push_back(model.connect(Driven{{.law = {drive}, .axis = y}, {}}, a, b, j.name));
        break;
      case HullJoint::Kind::tensioner:
        model.apply(
            AxialSpring{
                .stiffness = m113::tensioner.stiffness, .damping = m113::tensioner.damping, .preload = options.preload},
            a, b, j.name);
        break;
      case HullJoint::Kind::shock:
        model.apply(SpringDamper{.stiffness = shock.stiffness, .damping = shock.damping, .free_length = shock.length},
                    a, b, j.name);
        break;
    }
  }

  void add_links(Side s, std::string const& name, PinPolicy const& policy, VehicleOptions const& options,
                 SideParts& parts) {
    for (int i = 0; i < links; ++i) {
      Placement const place = options.start.links[std::size_t(i)].placement(sign(s) * track_y);
      Link const link = of_links_.make(options.masses.link, place, options.link_elements);
      parts.add(of_links_, model.add(link, name + "link " + std::to_string(i)), tracks[s == Side::left ? 0 : 1]);
    }
    parts.pins.resize(std::size_t(links));
    for (int k = 1; k <= links; ++k) {
      int const i = (options.cut + k) % links;
      auto const &before = parts.rear[std::size_t((i + links - 1) % links)], &after = parts.front[std::size_t(i)];
      std::string const n = name + "pin " + std::to_string(i);
      if (k < links || closes_alike)
        parts.pins[std::size_t(i)] = model.connect(Pin{Revolute{.axis = Vec3::UnitY()}, policy}, before, after, n);
      else if constexpr (!closes_alike) {
        if (options.closure == Closure::stiff_spring)
          model.connect(SpringPin{{}, Penalty{.stiffness = pin_stiffness, .damping = pin_damping}}, before, after, n);
        else
          model.connect(PlanePin{PointOnLine{.axis = Vec3::UnitY()}, {}}, before, after, n);
      }
    }
  }

  /// Contacts of `markers`, so many of each link.
  ElementHandle<Contacts> add_group(Side s, std::vector<Marker<Link>> const& markers, std::string const& name) {
    auto const group = model.apply(Contacts{}, markers, name);
    sides[s == Side::left ? 0 : 1].contacts.push_back(group);
    auto& visit_all = tracks[s == Side::left ? 0 : 1].contacts;
    Index const of_each = Index(markers.size()) / links;
    visit_all = [group, of_each, others = visit_all](System const& system, TouchingPointVisit const& visit) {
      if (others) others(system, visit);
      for_each_contact(system, group, [&](TouchingPoint const& p) {
        TouchingPoint of_link = p;
        of_link.body /= of_each;
        visit(of_link);
      });
    };
    return group;
  }
  /// The places on each link that are so far ahead of its middle.
  std::vector<Marker<Link>> under(SideParts const& parts, std::vector<double> const& ahead, Face face) const {
    std::vector<Marker<Link>> found;
    for (auto const& link : parts.links)
      for (double const x : ahead) found.push_back(of_links_.under(link, x, face));
    return found;
  }

  void add_contacts(Side s, std::string const& name, VehicleOptions const& options, Ground const& ground) {
    SideParts& parts = sides[s == Side::left ? 0 : 1];
    OfLinks const of_links{options.friction};
    bool const in_the_middle = options.contacts == ContactsAct::in_the_middle;
    double const face = in_the_middle ? pitch : pitch / 3.0;
    auto const rims = add_group(s, parts.middle, name + "track");
    auto const rollers =
        in_the_middle ? rims : add_group(s, under(parts, {-face, 0.0, face}, Face::wheels), name + "inner faces");
    auto const roller = [&](Handle const& body, double radius) {
      auto const axle = body.at(Vec3(0, 0, 0));
      model.pair_with(rollers, of_links.on_roller(radius, face), axle, body.name);
      model.pair_with(rims, of_links.on_rims(radius), axle, body.name + " (horn)");
    };
    for (Handle const& wheel : parts.wheels) roller(wheel, wheel_radius);
    roller(parts.idler[0], idler_radius);
    auto const sprocket = parts.sprocket[0].at(Vec3(0, 0, 0));
    auto const pins = in_the_middle ? rims : add_group(s, parts.front, name + "pins on teeth");
    model.pair_with(pins, of_links.on_teeth(in_the_middle ? 0.5 * pitch : 0.0), sprocket, parts.sprocket[0].name);
    double const x = pad[0].x;
    auto const pads = in_the_middle ? rims : add_group(s, under(parts, {-x, x}, Face::ground), name + "pads");
    model.pair_with(pads, of_links.on_terrain(ground, in_the_middle ? of_links.corners() : of_links.corners(x)),
                    model.ground().at({0, 0, 0}), "ground");
  }

  LinkOf<Link> of_links_;
};

}  // namespace polybody::m113
