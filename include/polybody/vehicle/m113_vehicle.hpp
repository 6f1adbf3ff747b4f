#pragma once
/// \file
/// The vehicle of m113.hpp as a model, its tracks under a formulation of choice. Not in polybody.hpp: of use to
/// vehicles only.

#include <array>
#include <vector>

#include <polybody/forces/axial_spring.hpp>
#include <polybody/forces/contact_group.hpp>
#include <polybody/forces/spring_damper.hpp>
#include <polybody/joints/point_on_line.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/prescribed_rate.hpp>
#include <polybody/joints/prismatic.hpp>
#include <polybody/joints/revolute.hpp>
#include <polybody/joints/spherical.hpp>
#include <polybody/joints/weld.hpp>
#include <polybody/system/model.hpp>
#include <polybody/vehicle/link_on_ground.hpp>
#include <polybody/vehicle/link_on_roller.hpp>
#include <polybody/vehicle/pin_on_sprocket.hpp>
#include <polybody/vehicle/track_links.hpp>
#include <polybody/vehicle/track_path.hpp>

namespace polybody::m113 {

/// Where the links of either side and the idler are at the start.
struct TrackStart {
  double idler_x = idler_reference_x;                        ///< [m]
  std::vector<TrackLink> links = wrap_track(track()).links;  ///< 64
};

/// The teeth of the sprockets.
inline SprocketProfile sprocket_profile() {
  return {.teeth = teeth,
          .pitch = pitch,
          .pin_radius = pin_radius,
          .valley_radius = valley_radius,
          .flank = flank,
          .tip_radius = tip_radius};
}

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
  bool held = false;         ///< the chassis is welded to the ground and the arms to the chassis
  bool ground_body = false;  ///< as thesis Table 3.4 counts: the ground is a body too, welded to the world
};

/// Chassis, and on each side sprocket, idler, tensioner, five wheels on arms and 64 links; `Link` is a link's body,
/// `PinPolicy` how links hang together. Where pins are rows or joint coordinates, 63 of a track are, and the last one
/// is as `Closure` says; where they are forces or linear rows, all 64 are alike.
template <class Link = Rigid<>, Policy PinPolicy = Constraint, Terrain Ground = FlatGround, TimeLaw Drive = Ramp>
class Vehicle {
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
  using OnRoller = Contact<LinkOnRoller<observed>>;
  using OnRims = Contact<HornOnRims<observed>>;
  using OnSprocket = Contact<PinOnSprocket<observed>>;
  using OnGround = Contact<LinkOnGround<Ground, observed>>;
  using Contacts = ContactGroup<OnRoller, OnRims, OnSprocket, OnGround>;
  using ModelType =
      Model<EachOnce<Bodies, Base, Link>, EachOnce<Joints, Hinge, Slide, Fixed, Driven, Pin, SpringPin, PlanePin>,
            Forces<SpringDamper, AxialSpring, Contacts>>;
  using Handle = BodyHandle<Base>;
  using LinkMarker = decltype(LinkOf<Link>::middle(std::declval<BodyHandle<Link> const&>()));

  /// One side. Pin i is in front of link i; `pins[i]` is at pin i but for the one where the loop is cut.
  struct SideParts {
    std::vector<BodyHandle<Link>> links = {};
    std::vector<LinkMarker> front = {}, middle = {}, rear = {};  ///< of each link: front pin, middle, rear pin
    std::vector<ElementHandle<Pin>> pins = {};
    std::vector<Handle> wheels = {}, arms = {}, sprocket = {}, idler = {},
                        tensioner = {};                  ///< the last three: one each
    std::vector<ElementHandle<Driven>> drive = {};       ///< one
    std::vector<ElementHandle<Contacts>> contacts = {};  ///< one
  };

  ModelType model{Gravity{0, 0, -9.81}};
  std::vector<Handle> chassis;  ///< one
  std::array<SideParts, 2> sides;

  SideParts const& side(Side s) const { return sides[s == Side::left ? 0 : 1]; }

  /// \throws InvalidInput.
  Vehicle(PinPolicy const& pin, std::array<Drive, 2> const& drives, VehicleOptions const& options = {},
          Ground const& ground = {}) {
    if (options.start.links.size() != std::size_t(links))
      throw InvalidInput("M113: the start needs the places of " + std::to_string(links) + " links, but has " +
                         std::to_string(options.start.links.size()) + ".");
    if (options.cut < 0 || options.cut >= links)
      throw InvalidInput("M113: the pin that closes a track is one of 0 … 63, but " + std::to_string(options.cut) +
                         " is asked for.");
    if (options.link_elements < 0)
      throw InvalidInput("M113: a flexible link has one element or more, but " + std::to_string(options.link_elements) +
                         " are asked for.");
    if (options.ground_body) {
      auto const body = model.add(solid({1.0, {1, 1, 1}}, Vec3(0, 0, 0)), "ground body");
      model.connect(Fixed{}, model.ground().at({0, 0, 0}), body.at(Vec3(0, 0, 0)), "ground weld");
    }
    chassis.push_back(model.add(solid(options.masses.chassis, m113::chassis), "chassis"));
    if (options.held)
      model.connect(Fixed{}, model.ground().at(Vec3(m113::chassis)), chassis[0].at(Vec3(0, 0, 0)), "hold");
    add_side(Side::left, pin, drives[0], options, ground);
    add_side(Side::right, pin, drives[1], options, ground);
  }

 private:
  static Base solid(Solid const& s, Vec3 const& centre, double about_y = 0.0) {
    return Base(s.mass, detail::principal(s.inertia), Placement::at(centre, Vec3(0, about_y, 0)));
  }
  /// The marker at the world's point `place` of a body whose axes are parallel to the world's.
  static auto at(Handle const& body, Vec3 const& centre, Vec3 const& place) { return body.at(Vec3(place - centre)); }

  void add_side(Side s, PinPolicy const& pin, Drive const& drive, VehicleOptions const& options, Ground const& ground) {
    SideParts& parts = sides[s == Side::left ? 0 : 1];
    std::string const name = s == Side::left ? "left " : "right ";
    Handle const& hull = chassis[0];
    Vec3 const centre = m113::chassis, y = Vec3::UnitY();
    Hinge const about_y{Revolute{.axis = y}, {}};

    Vec3 const axle = m113::sprocket(s);
    Handle const sprocket = model.add(solid(options.masses.sprocket, axle), name + "sprocket");
    parts.sprocket.push_back(sprocket);
    model.connect(about_y, at(hull, centre, axle), sprocket.at(Vec3(0, 0, 0)), name + "sprocket axle");
    parts.drive.push_back(model.connect(Driven{{.law = {drive}, .axis = y}, {}}, at(hull, centre, axle),
                                        sprocket.at(Vec3(0, 0, 0)), name + "drive"));

    Vec3 const idler_axle = m113::idler(s, options.start.idler_x);
    Handle const slider = model.add(solid(options.masses.tensioner, idler_axle), name + "tensioner");
    Handle const idler = model.add(solid(options.masses.idler, idler_axle), name + "idler");
    parts.tensioner.push_back(slider);
    parts.idler.push_back(idler);
    model.connect(Slide{Prismatic{.axis = Vec3::UnitX()}, {}}, at(hull, centre, idler_axle), slider.at(Vec3(0, 0, 0)),
                  name + "tensioner guide");
    model.connect(about_y, slider.at(Vec3(0, 0, 0)), idler.at(Vec3(0, 0, 0)), name + "idler axle");
    model.apply(
        AxialSpring{
            .stiffness = m113::tensioner.stiffness, .damping = m113::tensioner.damping, .preload = options.preload},
        at(hull, centre, m113::idler(s, idler_reference_x)), slider.at(Vec3(0, 0, 0)), name + "tensioner spring");

    for (int i = 0; i < m113::wheels; ++i) {
      std::string const n = name + "wheel " + std::to_string(i + 1);
      Vec3 const hub = m113::wheel(i, s), pivot = m113::arm_pivot(i, s), lower = m113::arm_point(i, s, shock_on_arm);
      Vec3 const middle = m113::arm(i, s), upper = lower + Vec3(0, 0, shock.length);
      Handle const wheel = model.add(solid(options.masses.wheel, hub), n);
      Handle const arm = model.add(solid(options.masses.arm, middle, arm_angle), n + " arm");
      Mat3 const into = exp_so3<double>(Vec3(0, -arm_angle, 0));
      auto const on_arm = [&](Vec3 const& place) { return arm.at(Vec3(into * (place - middle))); };
      model.connect(about_y, on_arm(hub), wheel.at(Vec3(0, 0, 0)), n + " axle");
      if (options.suspension && !options.held) {
        model.connect(about_y, at(hull, centre, pivot), on_arm(pivot), n + " pivot");
        model.apply(SpringDamper{.stiffness = shock.stiffness, .damping = shock.damping, .free_length = shock.length},
                    at(hull, centre, upper), on_arm(lower), n + " shock");
      } else {
        model.connect(Fixed{}, at(hull, centre, pivot), on_arm(pivot), n + " mount");
      }
      parts.wheels.push_back(wheel);
      parts.arms.push_back(arm);
    }
    add_links(s, name, pin, options, parts);
    add_contacts(name, options, ground, parts);
  }

  void add_links(Side s, std::string const& name, PinPolicy const& policy, VehicleOptions const& options,
                 SideParts& parts) {
    using L = LinkOf<Link>;
    for (int i = 0; i < links; ++i) {
      parts.links.push_back(
          model.add(L::make(options.masses.link, options.start.links[std::size_t(i)].placement(sign(s) * track_y),
                            options.link_elements),
                    name + "link " + std::to_string(i)));
      parts.front.push_back(L::front(parts.links.back()));
      parts.middle.push_back(L::middle(parts.links.back()));
      parts.rear.push_back(L::rear(parts.links.back()));
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

  void add_contacts(std::string const& name, VehicleOptions const& options, Ground const& ground, SideParts& parts) {
    bool const points = observed != Observes::frame;  // a cable's contacts lie in its middle plane: one for each two
    auto const law = [&]<ContactGeometry G>(G const& geometry, ContactNumbers const& c) {
      double const share = points ? 2.0 : 1.0;
      return Contact<G>{geometry,
                        {.stiffness = share * c.stiffness, .damping = share * c.damping, .onset = onset},
                        {.coefficient = options.friction ? c.friction : 0.0, .slip_speed = slip_speed}};
    };
    std::vector<double> const rims = points ? std::vector{0.0} : std::vector{-rim_y, rim_y};
    std::vector<double> const rings = points ? std::vector{0.0} : std::vector{-tooth_y, tooth_y};
    std::vector<Vec3> corners;
    for (Triple const& p : m113::pad)
      if (!points || p.y > 0.0) corners.push_back(Vec3(p.x, points ? 0.0 : p.y, p.z));
    auto const group = model.apply(Contacts{}, parts.middle, name + "track");
    parts.contacts.push_back(group);

    auto const roller = [&](Handle const& body, double radius, std::string const& n) {
      auto const axle = body.at(Vec3(0, 0, 0));
      LinkOnRoller<observed> const face{
          .pitch = pitch, .half_thickness = half_thickness, .half_width = half_width, .radius = radius, .rims = rims};
      model.pair_with(group, law(face, on_wheel), axle, n);
      Vec3 const tip = Vec3(horn) + Vec3(0, 0, 0.5 * horn_size.z);
      model.pair_with(group, law(HornOnRims<observed>{.tip = tip, .play = horn_play, .radius = radius}, on_wheel), axle,
                      n + " (horn)");
    };
    for (int i = 0; i < m113::wheels; ++i)
      roller(parts.wheels[std::size_t(i)], wheel_radius, name + "wheel " + std::to_string(i + 1));
    roller(parts.idler[0], idler_radius, name + "idler");
    model.pair_with(group,
                    law(PinOnSprocket<observed>{.profile = sprocket_profile(), .valley = first_valley, .rings = rings},
                        on_sprocket),
                    parts.sprocket[0].at(Vec3(0, 0, 0)), name + "sprocket");
    LinkOnGround<Ground, observed> const pads{.terrain = ground, .pad = corners};
    model.pair_with(group, law(pads, on_ground), model.ground().at({0, 0, 0}), "ground");
  }
};

}  // namespace polybody::m113
