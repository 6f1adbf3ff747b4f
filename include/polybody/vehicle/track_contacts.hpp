#pragma once
/// \file
/// Contacts of the links of the vehicle of m113.hpp. For vehicles; not included by polybody.hpp.

#include <algorithm>
#include <optional>

#include <polybody/forces/contact_group.hpp>
#include <polybody/vehicle/link_ground_contact.hpp>
#include <polybody/vehicle/link_roller_contact.hpp>
#include <polybody/vehicle/m113.hpp>
#include <polybody/vehicle/pin_sprocket_contact.hpp>

namespace polybody::m113 {

/// Profile of the teeth of the sprockets.
inline SprocketProfile sprocket_profile() {
  return {.teeth = teeth,
          .pitch = pitch,
          .pin_radius = pin_radius,
          .valley_radius = valley_radius,
          .flank = flank,
          .tip_radius = tip_radius};
}

/// Contacts of links whose middle marker has the quantities `observed`. Contacts of cables lie in the middle plane of
/// the track: one contact represents the two contacts of a rigid link.
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

  double friction = 1.0;  ///< factor of the friction coefficients of m113.hpp [1]; 0: no friction

  /// Contact of a link with rollers of this `radius` [m]. \param length length of the face along the link [m]
  OnRoller on_roller(double radius, double length = pitch) const {
    return law(LinkRollerContact<observed>{.pitch = length,
                                           .half_thickness = half_thickness,
                                           .half_width = half_width,
                                           .radius = radius,
                                           .handover = std::min(0.03, 0.49 * length),
                                           .rims = in_plane ? std::vector{0.0} : std::vector{-rim_y, rim_y}},
               on_wheel);
  }
  /// Contact of the horn with rims of this `radius` [m].
  OnRims on_rims(double radius) const {
    Vec3 const tip(horn.x, horn.y, horn.z + 0.5 * horn_size.z);
    return law(GuideHornContact<observed>{.tip = tip, .play = horn_play, .radius = radius}, on_wheel);
  }
  /// Contact of a pin with the teeth. \param ahead distance from the marker to the front pin [m]
  OnSprocket on_teeth(double ahead = 0.5 * pitch) const {
    return law(PinSprocketContact<observed>{.profile = sprocket_profile(),
                                            .valley = first_valley,
                                            .rings = in_plane ? std::vector{0.0} : std::vector{-tooth_y, tooth_y},
                                            .ahead = ahead},
               on_sprocket);
  }
  /// Contact of the pad with the ground. \param corners corners of the pad, relative to the marker
  template <Terrain Ground>
  OnGround<Ground> on_terrain(Ground const& ground, std::vector<Vec3> const& corners) const {
    return law(LinkGroundContact<Ground, observed>{.terrain = ground, .pad = corners}, on_ground);
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
  template <ContactGeometry G>
  Contact<G> law(G const& geometry, ContactNumbers const& c) const {
    double const share = in_plane ? 2.0 : 1.0;
    return {geometry,
            {.stiffness = share * c.stiffness, .damping = share * c.damping, .onset = onset},
            {.coefficient = friction * c.friction, .slip_speed = slip_speed}};
  }
};

/// Group of all contacts of links with the quantities `observed`, on one type of ground.
template <MarkerKind observed, Terrain Ground>
using TrackContacts = ContactGroup<typename LinkContacts<observed>::OnRoller, typename LinkContacts<observed>::OnRims,
                                   typename LinkContacts<observed>::OnSprocket,
                                   typename LinkContacts<observed>::template OnGround<Ground>>;

}  // namespace polybody::m113
