#pragma once
/// \file
/// Contact of a track's pins with the teeth of its sprocket.
/// Theory: Eqs. 8.36 to 8.39.

#include <numbers>
#include <optional>
#include <vector>

#include <polybody/forces/contact.hpp>
#include <polybody/vehicle/link_axes.hpp>

namespace polybody {

/// Profile of a sprocket with N teeth, for round pins of radius r_p in the valleys. The bottom of a valley is an arc of
/// radius r_a > r_p and half angle φ. The arc's centre is at r_c = R_p + r_a − r_p, so that a pin at the bottom lies on
/// the pitch circle R_p. Straight flanks continue along the arc's tangents up to the tip circle R_t.
struct SprocketProfile {
  Required<int> teeth;             ///< N, number of teeth
  Required<double> pitch;          ///< p, pitch of the track [m]
  Required<double> pin_radius;     ///< r_p, radius of a pin [m]
  Required<double> valley_radius;  ///< r_a, radius of the arc [m]
  Required<double> flank;          ///< φ, half angle of the arc [rad]
  Required<double> tip_radius;     ///< R_t, outer radius of the teeth [m]

  /// R_p, radius of the pitch circle [m].
  double pitch_radius() const { return 0.5 * pitch / std::sin(std::numbers::pi / teeth); }
  /// r_c, distance of the arc's centre from the axle [m].
  double arc_centre() const { return pitch_radius() + valley_radius - pin_radius; }
  /// Distance from the axle at which a pin just touches a tip; there is no contact at a greater distance [m].
  double outer_radius() const { return tip_radius + pin_radius; }
  /// (2) Intersection of flank and tip circle: distances from the axle along the middle of the valley and across it
  /// [m].
  Vec2 corner() const {
    Vec2 const foot(arc_centre() - valley_radius * std::cos(flank), valley_radius * std::sin(flank)),
        up(std::sin(flank), std::cos(flank));
    double const b = foot.dot(up);
    return foot + (std::sqrt(b * b - foot.squaredNorm() + tip_radius * tip_radius) - b) * up;
  }

  /// \throws InvalidInput if the numbers do not define a tooth.
  void check(std::string const& name) const {
    if (teeth < 4)
      throw InvalidInput("sprocket.teeth", {ErrorObject{name}, ": a sprocket needs at least four teeth, but has ",
                                            ErrorValue{int(teeth)}, "."});
    require_positive(pitch, name, ": the pitch of the track", "m");
    require_positive(pin_radius, name, ": the pins' radius", "m");
    if (!(valley_radius > pin_radius) || !std::isfinite(valley_radius))
      throw InvalidInput("sprocket.valley",
                         {ErrorObject{name}, ": the radius of the valleys must exceed the radius of the pins, ",
                          pin_radius, " m, but is ", ErrorValue{valley_radius}, " m."});
    if (!(flank > 0.0 && flank < 0.5 * std::numbers::pi))
      throw InvalidInput(
          "sprocket.valley",
          {ErrorObject{name}, ": the half angle of a valley's arc must lie between 0 and pi/2 rad, but is ",
           ErrorValue{flank}, " rad."});
    double const foot = std::hypot(arc_centre() - valley_radius * std::cos(flank), valley_radius * std::sin(flank));
    if (!(tip_radius > foot) || !std::isfinite(tip_radius))
      throw InvalidInput("sprocket.valley",
                         {ErrorObject{name}, ": the tip radius must exceed the radius at the ends of the valley arcs, ",
                          foot, " m, but is ", ErrorValue{tip_radius}, " m."});
    Vec2 const k = corner();
    if (std::atan2(k[1], k[0]) >= std::numbers::pi / teeth)
      throw InvalidInput(
          "sprocket.valley",
          {ErrorObject{name},
           ": the valleys overlap and leave no teeth. Use a smaller `valley_radius` or `tip_radius`, or fewer teeth."});
  }

  /// Penetration and unit normal of a pin on the profile. Both are continuous functions of the pin's position.
  template <StateScalar T>
  struct Overlap {
    T depth, radial, tangential;  ///< penetration [m]; normal along the middle of the valley and across it
  };
  /// Penetration and normal of a pin at (x, y) from the axle [m]: x along the middle of a valley, y ≥ 0 across it.
  /// The penetration is negative if pin and tooth are separated.
  template <StateScalar T>
  Overlap<T> overlap(T const& x, T const& y) const {
    using std::sqrt;
    double const rc = arc_centre(), room = valley_radius - pin_radius, c = std::cos(flank), s = std::sin(flank);
    T const u = rc - x;  // towards the bottom
    Vec2 const k = corner();
    // Distance along the flank beyond its outer end.
    double const along = (value_of(x) - k[0]) * s + (value_of(y) - k[1]) * c;
    if (value_of(y) * c <= value_of(u) * s && value_of(u) > 0.0) {  // contact with the arc
      T const r = sqrt(u * u + y * y);
      if (value_of(r) <= 0.0) return {T(-room), T(1.0), T(0.0)};
      return {r - room, u / r, -y / r};
    }
    if (along <= 0.0) return {u * c + y * s - room, T(c), T(-s)};
    T const r = sqrt(x * x + y * y);
    if (value_of(y) * k[0] >= value_of(x) * k[1]) return {T(outer_radius()) - r, x / r, y / r};
    T const dx = x - k[0], dy = y - k[1], e = sqrt(dx * dx + dy * dy);
    return {T(pin_radius.value) - e, dx / e, dy / e};
  }
};

/// Contact of the front pin of a link with the teeth of a sprocket. Marker a is on the link's middle line, with x to
/// the front pin. Marker b is the sprocket's centre, with its axle along y.
template <MarkerKind observed = MarkerKind::frame>
struct PinSprocketContact {
  static constexpr MarkerKind needs = observed;
  static constexpr MarkerKind needs_of_second = MarkerKind::frame;

  SprocketProfile profile;            ///< profile of the teeth and radius of the pins
  Required<double> valley;            ///< angle of any one valley in the sprocket's axes, from z towards x [rad]
  std::vector<double> rings = {0.0};  ///< positions of the rings of teeth along the axle [m]
  /// Distance from marker a to the pin [m]; if empty, a is the link's centre and the distance is half a pitch.
  std::optional<double> ahead = {};

  /// Distance from marker a to the pin along x [m].
  double to_pin() const { return ahead ? *ahead : 0.5 * profile.pitch; }
  void check(std::string const& name) const {
    profile.check(name);
    require_finite(valley, name, ": the angle of a valley", "rad");
    require_finite(to_pin(), name, ": the position of the pin relative to its marker", "m");
    if (rings.empty())
      throw InvalidInput("sprocket.rings",
                         {ErrorObject{name}, ": a sprocket needs at least one ring of teeth. Set `rings`."});
    for (double const y : rings) require_finite(y, name, ": the position of a ring", "m");
  }
  bool may_touch(Frame<double> const& link, Frame<double> const& sprocket) const {
    Vec3 const x = detail::column<double>(link.A, 0), axle = detail::column<double>(sprocket.A, 1);
    Vec3 const arm = difference<double>(detail::shifted<double>(link.r, x, to_pin()), sprocket.r);
    double const across = arm.dot(axle), far = farthest_ring();
    double const askew = observed == MarkerKind::frame ? cross<double>(detail::column<double>(link.A, 1), axle).norm()
                                                       : std::abs(x.dot(axle));
    // Greatest distance of the pin's middle from the axle. At the rings the pin may be nearer by up to far · askew.
    double const reach = profile.outer_radius() + far * askew;
    return arm.squaredNorm() - across * across < reach * reach;
  }
  ContactReach reach(Frame<double> const& sprocket) const {
    return ContactReach::cylinder(sprocket.r, detail::column<double>(sprocket.A, 1),
                                  profile.outer_radius() + farthest_ring() + std::abs(to_pin()));
  }
  template <StateScalar T, class Visit>
  void for_each_point(Frame<T> const& link, Frame<T> const& sprocket, Visit&& visit) const {
    Vec<T, 3> const lateral = detail::column<T>(link_axes<observed, T>(link, detail::column<T>(sprocket.A, 1)), 1);
    Vec<T, 3> const along = detail::column<T>(link.A, 0), axis_x = detail::column<T>(sprocket.A, 0),
                    axis_z = detail::column<T>(sprocket.A, 2);
    Vec<T, 3> const pin = difference<T>(detail::shifted<T>(link.r, along, T(to_pin())), sprocket.r);
    // Rotation to the valley, computed once for all rings.
    double turned = std::numeric_limits<double>::quiet_NaN(), s = 0.0, c = 1.0;
    for (double const ring : rings) {
      Vec<T, 3> const arm = detail::shifted<T>(pin, lateral, T(ring));
      T const x = arm.dot(axis_x), z = arm.dot(axis_z);
      double const step = 2.0 * std::numbers::pi / profile.teeth;
      double const angle = std::atan2(value_of(x), value_of(z)),
                   middle = valley + step * std::round((angle - valley) / step);
      if (middle != turned) {
        turned = middle;
        s = std::sin(middle);
        c = std::cos(middle);
      }
      // Components along the middle of the valley, and across it from z towards x.
      T const out = x * s + z * c, side = x * c - z * s;
      bool const forward = value_of(side) >= 0.0;
      auto const o = profile.template overlap<T>(out, forward ? side : T(-side));
      if (!(value_of(o.depth) > 0.0)) continue;  // no contact without penetration, nor for a cable along the axle
      T const across = forward ? o.tangential : T(-o.tangential);
      T const by_x = o.radial * s + across * c, by_z = o.radial * c - across * s;
      Vec<T, 3> const n = detail::shifted<T>(detail::scaled<T>(axis_x, by_x), axis_z, by_z);
      Vec<T, 3> const middle_of_pin = detail::sum<T>(sprocket.r, arm);
      visit(ContactPoint<T>{detail::shifted<T>(middle_of_pin, n, -T(profile.pin_radius.value)), n, o.depth});
    }
  }

 private:
  /// Largest distance of a ring of teeth from the centre of the sprocket, along its axis [m].
  double farthest_ring() const {
    double far = 0.0;
    for (double const ring : rings) far = std::max(far, std::abs(ring));
    return far;
  }
};

static_assert(ContactGeometry<PinSprocketContact<>> && ContactGeometry<PinSprocketContact<MarkerKind::axis>>);

}  // namespace polybody
