#pragma once
/// \file
/// What the links of the vehicle of m113.hpp touch. Not in polybody.hpp: of use to vehicles only.

#include <algorithm>
#include <optional>

#include <polybody/forces/contact_group.hpp>
#include <polybody/vehicle/link_on_ground.hpp>
#include <polybody/vehicle/link_on_roller.hpp>
#include <polybody/vehicle/m113.hpp>
#include <polybody/vehicle/pin_on_sprocket.hpp>

namespace polybody::m113 {

/// The teeth of the sprockets.
inline SprocketProfile sprocket_profile() {
  return {.teeth = teeth,
          .pitch = pitch,
          .pin_radius = pin_radius,
          .valley_radius = valley_radius,
          .flank = flank,
          .tip_radius = tip_radius};
}

/// The contacts of links whose middle observes so much: a cable's lie in its middle plane, one for each two.
template <Observes observed>
struct LinkContacts {
  using OnRoller = Contact<LinkOnRoller<observed>>;     ///< inner face on the rims of a wheel
  using OnRims = Contact<HornOnRims<observed>>;         ///< horn between the rims of a wheel
  using OnSprocket = Contact<PinOnSprocket<observed>>;  ///< front pin between the teeth
  /// Pad on the ground.
  template <Terrain Ground>
  using OnGround = Contact<LinkOnGround<Ground, observed>>;
  /// Links are cables, which know no roll: contacts lie in the track's middle plane.
  static constexpr bool in_plane = observed != Observes::frame;

  double friction = 1.0;  ///< times the coefficients of m113.hpp [1]; 0: none

  /// A link on rollers of this `radius` [m]. \param length of the face along the link [m]
  OnRoller on_roller(double radius, double length = pitch) const {
    return law(LinkOnRoller<observed>{.pitch = length,
                                      .half_thickness = half_thickness,
                                      .half_width = half_width,
                                      .radius = radius,
                                      .handover = std::min(0.03, 0.49 * length),
                                      .rims = in_plane ? std::vector{0.0} : std::vector{-rim_y, rim_y}},
               on_wheel);
  }
  /// The horn between rims of this radius [m].
  OnRims on_rims(double radius) const {
    Vec3 const tip(horn.x, horn.y, horn.z + 0.5 * horn_size.z);
    return law(HornOnRims<observed>{.tip = tip, .play = horn_play, .radius = radius}, on_wheel);
  }
  /// \param ahead from the marker to the front pin [m]
  OnSprocket on_teeth(double ahead = 0.5 * pitch) const {
    return law(PinOnSprocket<observed>{.profile = sprocket_profile(),
                                       .valley = first_valley,
                                       .rings = in_plane ? std::vector{0.0} : std::vector{-tooth_y, tooth_y},
                                       .ahead = ahead},
               on_sprocket);
  }
  /// \param corners of the pad, from the marker
  template <Terrain Ground>
  OnGround<Ground> on_terrain(Ground const& ground, std::vector<Vec3> const& corners) const {
    return law(LinkOnGround<Ground, observed>{.terrain = ground, .pad = corners}, on_ground);
  }
  /// Corners of the pad seen from a marker on the middle line, `x` ahead of the link's centre: all, or those at `x`
  /// alone.
  static std::vector<Vec3> corners(std::optional<double> x = {}) {
    std::vector<Vec3> found;
    for (Triple const& p : pad)
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

/// All that links touch that observe so much, on a ground.
template <Observes observed, Terrain Ground>
using TrackContacts = ContactGroup<typename LinkContacts<observed>::OnRoller, typename LinkContacts<observed>::OnRims,
                                   typename LinkContacts<observed>::OnSprocket,
                                   typename LinkContacts<observed>::template OnGround<Ground>>;

}  // namespace polybody::m113
