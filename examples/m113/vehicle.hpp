#pragma once
/// \file
/// Model of the vehicle of data.hpp with a selectable formulation of its tracks.

#include <polybody/joints/standard_joints.hpp>
#include <polybody/system/model.hpp>

#include "hull.hpp"
#include "tracks.hpp"

namespace polybody::m113 {

/// Vehicle of a chassis and two sides; each side has a sprocket, an idler, a tensioner, five wheels on arms and 64
/// links. `Link` is the body of a link; `PinPolicy` is the policy of the pins between links. If pins are constraints or
/// joint coordinates, 63 pins of a track have this policy, and `Closure` selects the last pin. If pins are forces or
/// linear constraint equations, all 64 pins have this policy.
template <class Link = Rigid<>, Policy PinPolicy = Constraint, Terrain Ground = FlatGround, TimeFunction Drive = Ramp>
class Vehicle : public TrackedVehicle {
 public:
  using LinkType = Link;                                  ///< type of the body of a link
  static constexpr MarkerKind observed = Link::observes;  ///< kind of the markers on a link
  /// True if all 64 pins of a track have the policy `PinPolicy`.
  static constexpr bool closes_alike = CompliantPolicy<PinPolicy> || LinearPolicy<PinPolicy>;
  /// Body of all parts except links.
  using Base = std::conditional_t<std::is_same_v<Link, Rigid<EulerParameters>>, Link, Rigid<>>;
  using Hull = HullTypes<Base, Drive>;     ///< types of the bodies and joints that carry the tracks
  using Driven = typename Hull::Driven;    ///< driving constraint of a sprocket: its speed is prescribed
  using Pin = Joint<Revolute, PinPolicy>;  ///< pin between two links
  /// Pin that closes a loop under `Closure::stiff_spring`.
  using SpringPin = std::conditional_t<closes_alike, Pin, Joint<Spherical, Penalty>>;
  /// Pin that closes a loop under `Closure::in_plane`.
  using PlanePin = std::conditional_t<closes_alike, Pin, Joint<PointOnLine, Constraint>>;
  using Contacts = TrackContacts<observed, Ground>;  ///< contacts of the links of a track
  /// Type of the model, with the bodies, joints and forces of the vehicle only.
  using ModelType = Model<EachOnce<Bodies, Base, Link>,
                          EachOnce<Joints, typename Hull::Hinge, typename Hull::Slide, typename Hull::Fixed, Driven,
                                   Pin, SpringPin, PlanePin>,
                          Forces<SpringDamper, AxialSpring, Contacts>>;
  using Handle = BodyHandle<Base>;  ///< handle of a body that is not a link

  /// Parts of one side. Pin i is in front of link i. `pins[i]` is the handle of pin i, or an empty handle if another
  /// joint closes the loop there.
  struct SideParts : Carriers<Base>, LinkParts<Link> {
    std::vector<ElementHandle<Pin>> pins = {};           ///< (64) handles of the pins
    std::vector<ElementHandle<Driven>> drive = {};       ///< one handle, of the driving constraint
    std::vector<ElementHandle<Contacts>> contacts = {};  ///< one group; four if contacts act at their own points
  };

  ModelType model{Gravity{0, 0, -9.81}};  ///< all parts of the vehicle; gravity is 9.81 m/s² along −z
  std::vector<Handle> chassis;            ///< one handle, of the chassis
  std::array<SideParts, 2> sides;         ///< left, right

  SideParts const& side(Side s) const { return sides[s == Side::left ? 0 : 1]; }  ///< parts of the side s

  /// Creates the vehicle with the policy `pin` for its pins. \param drives functions of time of the left and the right
  /// sprocket's speed
  /// \throws InvalidInput.
  [[gnu::cold]] Vehicle(PinPolicy const& pin, std::array<Drive, 2> const& drives, VehicleOptions const& options = {},
                        Ground const& ground = {}, LinkOf<Link> const& of_links = {}) {
    check(options);
    typename Hull::Part part(model);
    chassis.push_back(detail::add_chassis<Base, Drive>(part, options));
    hull = frame_in(chassis[0], chassis[0].at(Vec3(0, 0, 0)));
    Subassembly<Bodies<Link>> track(model);
    TrackContactsAdder<Link, Base, Ground> contacts(typename TrackContactsAdder<Link, Base, Ground>::Part(model),
                                                    of_links, options);
    for (Side const s : {Side::left, Side::right}) {
      std::size_t const k = s == Side::left ? 0 : 1;
      SideParts& parts = sides[k];
      HullSide const of_side = hull_side(s, options.masses, options.start.idler_x, options.suspension && !options.held);
      std::vector<Handle> bodies;
      parts.drive = {detail::add_carriers<Base>(part, of_side, chassis[0], drives[k], options.preload, bodies)};
      parts.set(of_side, bodies, tracks[k]);
      detail::add_links(track, of_links, s, options, parts, tracks[k]);
      add_pins(of_side.name, pin, options, parts);
      parts.contacts = contacts.add(of_side.name, parts, parts, ground, tracks[k]);
    }
  }

 private:
  [[gnu::cold]] void add_pins(std::string const& name, PinPolicy const& policy, VehicleOptions const& options,
                              SideParts& parts) {
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
};

}  // namespace polybody::m113
