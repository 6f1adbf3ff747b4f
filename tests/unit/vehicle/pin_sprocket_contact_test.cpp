// Pins between a sprocket's teeth. Numbers are those of the M113, from an independent computation of the sprocket's
// profile.

#include <polybody/vehicle/pin_sprocket_contact.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/differences.hpp>

#include "m113/data.hpp"
#include "support/contact_points.hpp"
#include "support/held.hpp"
#include "support/refusal.hpp"

namespace polybody {
using namespace laws;
namespace pin_on_sprocket_test {

constexpr double pi = std::numbers::pi, degree = pi / 180.0;
double const nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();

SprocketProfile const profile{.teeth = m113::teeth,
                              .pitch = m113::pitch,
                              .pin_radius = m113::pin_radius,
                              .valley_radius = m113::valley_radius,
                              .flank = m113::flank,
                              .tip_radius = m113::tip_radius};
PinSprocketContact<> const one_ring{.profile = profile, .valley = m113::first_valley};
PinSprocketContact<> const two_rings{
    .profile = profile, .valley = m113::first_valley, .rings = {-m113::tooth_y, m113::tooth_y}};
PinSprocketContact<MarkerKind::axis> const on_cable{
    .profile = profile, .valley = m113::first_valley, .rings = {-m113::tooth_y, m113::tooth_y}};

/// A link whose front pin is at (radial, tangential) of the valley `middle` of a sprocket, `axial` along its axle.
/// Its y is along the axle and its x at `angle` to the radius.
Frame<double> seated(Frame<double> const& sprocket, double middle, Vec2 const& pin, double axial = 0.0,
                     double angle = 1.9) {
  Vec3 const out(std::sin(middle), 0, std::cos(middle)), side(std::cos(middle), 0, -std::sin(middle)),
      y = Vec3::UnitY();
  Vec3 const x = std::cos(angle) * out + std::sin(angle) * side;
  Mat3 axes;
  axes << x, y, x.cross(y);
  Vec3 const centre = pin[0] * out + pin[1] * side + axial * y - 0.5 * m113::pitch * x;
  return {.r = sprocket.r + sprocket.A * centre, .A = sprocket.A * axes};
}

/// d and n of a pin at `pin`, radial and tangential relative to the middle of a valley; no depth without contact.
struct Touch {
  double depth;
  Vec2 normal;
};
Touch touch(Vec2 const& pin) {
  auto const found = contact_points(PinSprocketContact<>{.profile = profile, .valley = 0.0}, seated({}, 0.0, pin), {});
  if (found.empty()) return {0.0, Vec2::Zero()};
  return {found[0].depth, Vec2(found[0].normal.z(), found[0].normal.x())};
}
Vec2 polar(double r, double angle) { return r * Vec2(std::cos(angle), std::sin(angle)); }

TEST(SprocketProfile, SeatsPinsOnThePitchCircle) {
  auto const radius = [](char const* what, double value, double reference, double tolerance) {
    held({"M113 contact", what, By::independent, "geometry of the profile, computed by hand", "SprocketProfile"}, value,
         reference, tolerance);
  };
  radius("pitch radius of the sprocket [m]", profile.pitch_radius(), 0.246588, 5e-7);
  radius("radius on which the valleys are centred [m]", profile.arc_centre(), 0.261588, 5e-7);
  radius("radius of the root [m]", profile.arc_centre() - profile.valley_radius, 0.226588, 5e-7);
  radius("addendum [m]", profile.tip_radius - profile.pitch_radius(), 15.4e-3, 5e-5);
  auto const seat = profile.overlap<double>(profile.pitch_radius(), 0.0);
  EXPECT_NEAR(seat.depth, 0.0, 1e-16);
  EXPECT_EQ(seat.radial, 1.0);
  EXPECT_EQ(seat.tangential, 0.0);
  Touch const pressed = touch(Vec2(profile.pitch_radius() - 1e-4, 0.0));
  EXPECT_NEAR(pressed.depth, 1e-4, 1e-16);
  EXPECT_LT((pressed.normal - Vec2(1, 0)).norm(), 1e-15);
  // Pins one pitch apart are in neighbouring valleys.
  EXPECT_NEAR((polar(profile.pitch_radius(), 36.0 * degree) - polar(profile.pitch_radius(), 0.0)).norm(), m113::pitch,
              1e-16);
}

// The corner is on the tip circle and on the flank's line. This line touches the arc at f = (0.244088, 0.030311), 60
// deg from the bottom. The tip is 0.086 m thick between its two corners.
TEST(SprocketProfile, FlankMeetsTheTipAtItsCorner) {
  Vec2 const k = profile.corner(), f(0.244088, 0.030311);
  EXPECT_NEAR(k.norm(), profile.tip_radius, 1e-15);
  EXPECT_LT((f - Vec2(profile.arc_centre() - profile.valley_radius * std::cos(m113::flank),
                      profile.valley_radius * std::sin(m113::flank)))
                .norm(),
            1e-6);
  Vec2 const up = (k - f).normalized();
  // inclined by 30 deg relative to the radius of the valley
  EXPECT_NEAR(std::atan2(up[1], up[0]), 30.0 * degree, 1e-4);
  double const half = pi / 10.0 - std::atan2(k[1], k[0]);
  held({"M113 contact", "thickness of a tooth's tip [m]", By::independent, "geometry of the profile, computed by hand",
        "SprocketProfile"},
       2.0 * profile.tip_radius * std::sin(half), 0.086, 5e-4);
  // A pin at the end of the flank touches the corner: on the flank's normal, at the distance r_p.
  Vec2 const n(std::cos(m113::flank), -std::sin(m113::flank));
  EXPECT_NEAR(profile.overlap<double>(k[0] + n[0] * 0.0199, k[1] + n[1] * 0.0199).depth, 1e-4, 1e-15);
}

// Clearance of a pin that rotates about its seated neighbour, by an independent computation: 9.7, 10.7 and 17 mm at
// 5, 10 and 20 deg, without contact at any angle.
TEST(SprocketProfile, LetsGoOfAPinThatTurnsAboutItsNeighbour) {
  double const step = 2.0 * pi / 10.0;
  Vec2 const neighbour = polar(profile.pitch_radius(), -step);  // seated in the previous valley
  Vec2 const chord = polar(profile.pitch_radius(), 0.0) - neighbour;
  auto const clearance = [&](double turn) {
    Vec2 const pin = neighbour + Eigen::Rotation2D<double>(-turn) * chord;  // away from the sprocket
    double const angle = std::atan2(pin[1], pin[0]), from_valley = angle - step * std::round(angle / step);
    Vec2 const local = polar(pin.norm(), std::abs(from_valley));
    return -profile.overlap<double>(local[0], local[1]).depth;
  };
  Claim const clear{"M113 contact", "clearance of a pin that turns about its seated neighbour [m]", By::independent,
                    "geometry of the profile, computed by hand", "SprocketProfile"};
  held(clear, clearance(5.0 * degree), 9.7e-3, 5e-5, {"5°"});
  held(clear, clearance(10.0 * degree), 10.7e-3, 5e-5, {"10°"});
  held(clear, clearance(20.0 * degree), 17.0e-3, 5e-5, {"20°"});
  for (double turn = 0.1; turn < 90.0; turn += 0.1) EXPECT_GT(clearance(turn * degree), 0.0) << turn;
}

/// Calls f(pin, next) for neighbours 1 µm apart along lines across a valley and half of its two teeth.
template <class F>
void along_lines(F const& f) {
  Numbers number;
  for (int line = 0; line < 60; ++line) {
    Vec2 const from = polar(0.25 + number(0.04), number(20.0 * degree)),
               to = polar(0.25 + number(0.04), number(20.0 * degree));
    int const steps = int((to - from).norm() / 1e-6);
    for (int i = 0; i < steps; ++i)
      f(Vec2(from + (to - from) * (double(i) / steps)), Vec2(from + (to - from) * (double(i + 1) / steps)));
  }
}

// As a pin moves along arc, flank, corner and tip, its depth changes by at most its displacement. The normal n
// rotates by at most that displacement over the smallest distance from a centre of curvature. This distance is r_p −
// 15 mm at the corner, which gives 200 per metre. Deeper pins are omitted, because at a depth of r_p the centre is
// within the tooth. The depth grows against n.
TEST(SprocketProfile, DepthAndNormalAreContinuous) {
  int touching = 0, began = 0;
  double most = 0.0, turned = 0.0, slope = 0.0;
  along_lines([&](Vec2 const& pin, Vec2 const& next) {
    Touch const a = touch(pin), b = touch(next);
    if (a.depth > 0.015 || b.depth > 0.015) return;
    double const way = (next - pin).norm();
    most = std::max(most, std::abs(b.depth - a.depth) - way);
    if (a.depth == 0.0 || b.depth == 0.0) {
      began += a.depth != b.depth;
      return;
    }
    ++touching;
    turned = std::max(turned, (b.normal - a.normal).norm() / way);
    slope = std::max(slope, std::abs(b.depth - a.depth + (next - pin).dot(0.5 * (a.normal + b.normal))) / way);
  });
  EXPECT_LT(most, 1e-15);
  EXPECT_LT(turned, 200.0);
  // angle between the chord's direction and the mean normal: at most the rotation of n in a step
  EXPECT_LT(slope, 200.0 * 1e-6);
  EXPECT_GT(touching, 100000);
  EXPECT_GT(began, 20);
}

// This test with dual numbers, exact in every piece.
TEST(SprocketProfile, NormalIsTheSlopeOfTheDepth) {
  Numbers number;
  std::array<int, 4> pieces{};  // arc, flank, corner, tip
  for (int k = 0; k < 20000; ++k) {
    Vec2 const pin = polar(0.255 + number(0.028), std::abs(number(18.0 * degree)));
    auto const o = profile.overlap<Dual<2>>(Dual<2>::variable(pin[0], 0), Dual<2>::variable(pin[1], 1));
    if (o.depth.v < 0.0 || o.depth.v > 0.015) continue;
    EXPECT_NEAR(o.depth.d[0], -o.radial.v, 1e-13);
    EXPECT_NEAR(o.depth.d[1], -o.tangential.v, 1e-13);
    EXPECT_NEAR(o.radial.v * o.radial.v + o.tangential.v * o.tangential.v, 1.0, 1e-13);
    double const phi = std::atan2(pin[1], profile.arc_centre() - pin[0]);
    Vec2 const from_corner = pin - profile.corner();
    bool const tip = std::atan2(pin[1], pin[0]) >= std::atan2(profile.corner()[1], profile.corner()[0]);
    bool const corner = from_corner[0] * std::sin(m113::flank) + from_corner[1] * std::cos(m113::flank) > 0.0;
    ++pieces[phi <= m113::flank ? 0 : !corner ? 1 : tip ? 3 : 2];
  }
  for (int const count : pieces) EXPECT_GT(count, 50);
}

// Pins press on their valleys. The normal has the angle φ to the pin's own radius, and the links on both sides have
// the angle π/N to the tangent:
//   (T − t) cos π/N = N sin φ,  (T + t) sin π/N = N cos φ,  so  t/T = (1 − K)/(1 + K),  K = tan φ tan π/N:
// Independent values are 0.79 at 20 deg, 0.57 at 40 and 0.28 at 60.
TEST(SprocketProfile, SharesTheLoadAmongItsTeeth) {
  struct Case {
    double angle, ratio;
  };
  for (Case const c : {Case{20.0, 0.79}, {40.0, 0.57}, {60.0, 0.28}}) {
    // The position on the arc with this angle, at a very small depth. The angle of the normal is the arc's angle plus
    // the pin's own polar angle.
    double low = 0.0, high = c.angle * degree;
    auto const place = [&](double phi) {
      double const r = m113::valley_radius - m113::pin_radius + 1e-9;
      return Vec2(profile.arc_centre() - r * std::cos(phi), r * std::sin(phi));
    };
    for (int i = 0; i < 60; ++i) {
      double const phi = 0.5 * (low + high);
      Vec2 const p = place(phi);
      (phi + std::atan2(p[1], p[0]) < c.angle * degree ? low : high) = phi;
    }
    Vec2 const pin = place(low), n = touch(pin).normal, out = pin.normalized(), side(-out[1], out[0]);
    // Unit vectors along the links: t pulls back, away from the flank's side, T forward.
    double const s = std::sin(pi / 10.0), co = std::cos(pi / 10.0);
    Vec2 const slack = -co * side - s * out, tight = co * side - s * out;
    Mat<double, 2, 2> both;
    both << slack, tight;
    Vec2 const tension = both.inverse() * -n;  // tensions for N = 1
    double const k = std::tan(c.angle * degree) * std::tan(pi / 10.0);
    auto const ratio = [&](By by, char const* source, double reference, double tolerance) {
      held({"M113 contact", "tension behind a pin over that before it", by, source, "PinSprocketContact"},
           tension[0] / tension[1], reference, tolerance, {equals("φ", c.angle) + "°"});
    };
    ratio(By::closed_form, "(1 − K)/(1 + K), K = tan φ tan π/N", (1.0 - k) / (1.0 + k), 1e-8);
    ratio(By::independent, "geometry of the profile, computed by hand", c.ratio, 5e-3);
    EXPECT_GT(tension[0], 0.0);
  }
}

TEST(PinSprocketContact, IsTheProfileInAnyValleyOfASprocketTurnedAnyhow) {
  Numbers number;
  int compared = 0;
  for (int k = 0; k < 2000; ++k) {
    Frame<double> const sprocket = number.frame();
    int const valley = int(std::floor(5.0 + number(5.0)));
    double const middle = m113::first_valley + 36.0 * degree * valley, axial = number(0.05),
                 side = number() > 0.0 ? 1.0 : -1.0;
    Vec2 const pin = polar(0.25 + number(0.03), std::abs(number(17.9 * degree)));
    Frame<double> const link = seated(sprocket, middle, Vec2(pin[0], side * pin[1]), axial, number(pi));
    auto const o = profile.overlap<double>(pin[0], pin[1]);
    auto const found = contact_points(two_rings, link, sprocket);
    ASSERT_EQ(found.size(), o.depth > 0.0 ? 2u : 0u);
    Vec3 const out(std::sin(middle), 0, std::cos(middle)), across(std::cos(middle), 0, -std::sin(middle));
    for (std::size_t i = 0; i < found.size(); ++i, ++compared) {
      double const ring = (i == 0 ? -1.0 : 1.0) * m113::tooth_y + axial;
      Vec3 const n = sprocket.A * (o.radial * out + side * o.tangential * across);
      Vec3 const centre = sprocket.r + sprocket.A * (pin[0] * out + side * pin[1] * across + ring * Vec3::UnitY());
      EXPECT_NEAR(found[i].depth, o.depth, 1e-14);
      EXPECT_EQ(found[i].handover.share, 1.0);
      EXPECT_LT((found[i].normal - n).norm(), 1e-12);  // n rotates by 1/r, with r of only a few mm
      EXPECT_LT((found[i].place - (centre - m113::pin_radius * n)).norm(), 1e-13);
    }
  }
  EXPECT_GT(compared, 500);
}

TEST(PinSprocketContact, IsTheSameAfterWholeTeeth) {
  Numbers number;
  int compared = 0;
  for (int k = 0; k < 500; ++k) {
    Frame<double> const sprocket = number.frame();
    Frame<double> turned = sprocket;
    turned.A = sprocket.A * exp_so3<double>(Vec3(0, 36.0 * degree * (k % 21 - 10), 0));
    Frame<double> const link = seated(sprocket, number(pi), Vec2(0.25 + number(0.03), 0.0), number(0.05), number(pi));
    auto const expected = contact_points(two_rings, link, sprocket), found = contact_points(two_rings, link, turned);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i, ++compared) {
      EXPECT_NEAR(found[i].depth, expected[i].depth, 1e-14);
      EXPECT_LT((found[i].normal - expected[i].normal).norm(), 1e-12);
      EXPECT_LT((found[i].place - expected[i].place).norm(), 1e-13);
    }
  }
  EXPECT_GT(compared, 200);
}

/// A sprocket at random and a link whose pin is near the teeth, misaligned by up to about `askew`.
std::pair<Frame<double>, Frame<double>> near_pose(Numbers& number, double askew) {
  Frame<double> const sprocket = number.frame();
  Frame<double> link =
      seated(sprocket, number(pi), polar(0.26 + number(0.06), number(18.0 * degree)), number(0.3), number(pi));
  Vec3 const pin = link.r + link.A.col(0) * (0.5 * m113::pitch);
  link.A = exp_so3<double>(number.vec<3>(askew)) * link.A;
  link.r = pin - link.A.col(0) * (0.5 * m113::pitch);
  return {link, sprocket};
}

// A misaligned pin is deeper in one ring than in the other; ∂d/∂r of the link is −n.
TEST(PinSprocketContact, NormalIsTheSlopeOfTheDepth) {
  Numbers number;
  int compared = 0;
  for (int k = 0; k < 500; ++k) {
    auto const [link, sprocket] = near_pose(number, 0.05);
    auto const found = contact_points(two_rings, link, sprocket);
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found[i].depth > 0.015) continue;
      for (int j = 0; j < 3; ++j) {
        double const slope = slope_at_zero(
            [&](double h) {
              Frame<double> shifted = link;
              shifted.r[j] += h;
              auto const p = contact_points(two_rings, shifted, sprocket);
              return p.size() == found.size() ? p[i].depth : nan;
            },
            1e-7);
        EXPECT_NEAR(slope, -found[i].normal[j], 2e-5);  // 200 per metre times h if a piece ends within the difference
      }
      ++compared;
    }
  }
  EXPECT_GT(compared, 100);
}

TEST(PinSprocketContact, PassesDualNumbersOn) {
  Numbers number;
  int compared = 0;
  for (int k = 0; k < 200; ++k) {
    auto const [link, sprocket] = near_pose(number, 0.05);
    Vec6 const motion = number.vec<6>();
    compared += expect_contact_duals(two_rings, link, sprocket, motion);
    compared += expect_contact_duals(on_cable, link, sprocket, motion);
  }
  EXPECT_GT(compared, 100);
}

TEST(PinSprocketContact, OnACableIsThatOnALinkThatDoesNotRoll) {
  Numbers number;
  int compared = 0;
  for (int k = 0; k < 2000; ++k) {
    auto const [twisted, sprocket] = near_pose(number, 0.3);
    Frame<double> link = twisted;
    Vec3 const x = link.A.col(0), axle = sprocket.A.col(1), y = (axle - x * x.dot(axle)).normalized();
    link.A << x, y, x.cross(y);
    auto const expected = contact_points(two_rings, link, sprocket),
               found = contact_points(on_cable, twisted, sprocket);
    ASSERT_EQ(found.size(), expected.size()) << k;
    for (std::size_t i = 0; i < found.size(); ++i, ++compared) {
      EXPECT_NEAR(found[i].depth, expected[i].depth, 1e-13);
      EXPECT_LT((found[i].normal - expected[i].normal).norm(), 1e-11);
      EXPECT_LT((found[i].place - expected[i].place).norm(), 1e-12);
    }
  }
  EXPECT_GT(compared, 500);
}

template <class G>
int missed(G const& geometry, double askew) {
  Numbers number;
  int touching = 0, far = 0, found = 0, beyond = 0;
  for (int k = 0; k < 20000; ++k) {
    auto const [link, sprocket] = number() > 0.0 ? near_pose(number, askew) : std::pair(number.frame(), number.frame());
    bool const touches = !contact_points(geometry, link, sprocket).empty(), may = geometry.may_touch(link, sprocket);
    touching += touches;
    far += !may;
    bool const within = geometry.reach(sprocket).holds(link.r);
    found += (touches && !may) || (may && !within);
    beyond += !within;
  }
  EXPECT_GT(touching, 1000);
  EXPECT_GT(far, 1000);  // the bound excludes many poses
  EXPECT_GT(beyond, 1000);
  return found;
}

// The bound is valid for any misalignment of the pin, as after a link has come off.
TEST(PinSprocketContact, IsNeverMissedByItsBound) {
  EXPECT_EQ(missed(one_ring, 3.0), 0);
  EXPECT_EQ(missed(two_rings, 3.0), 0);
  EXPECT_EQ(missed(on_cable, 3.0), 0);
}

// If the tangent is along the axle, the y direction of a cable is undefined: there is no contact point, instead of
// one with NaN.
TEST(PinSprocketContact, OfACableAlongTheAxleIsNone) {
  Frame<double> link;
  link.A << Vec3::UnitY(), -Vec3::UnitX(), Vec3::UnitZ();
  link.r = Vec3(0.0, 0.0, profile.pitch_radius() - 0.001) - 0.5 * m113::pitch * Vec3::UnitY();
  EXPECT_TRUE(contact_points(on_cable, link, {}).empty());
}

TEST(PinSprocketContact, RefusesNumbersThatCannotBeMeantByName) {
  auto const told = [](auto const& change) {
    PinSprocketContact<> bad = two_rings;
    change(bad);
    return refusal([&] { bad.check("\"sprocket\""); });
  };
  for (double const x : {0.0, -1.0, nan, infinity}) {
    EXPECT_TRUE(has(told([&](auto& g) { g.profile.pitch = x; }), "\"sprocket\": the pitch of the track"));
    EXPECT_TRUE(has(told([&](auto& g) { g.profile.pin_radius = x; }), "\"sprocket\": the pins' radius"));
    EXPECT_TRUE(has(told([&](auto& g) { g.profile.valley_radius = x; }), "\"sprocket\": the radius of the valleys"));
    EXPECT_TRUE(
        has(told([&](auto& g) { g.profile.flank = x; }), "\"sprocket\": the half angle of a valley's arc must lie"));
    EXPECT_TRUE(has(told([&](auto& g) { g.profile.tip_radius = x; }), "\"sprocket\": the tip radius must exceed"));
  }
  EXPECT_TRUE(
      has(told([](auto& g) { g.profile.teeth = 3; }), "\"sprocket\": a sprocket needs at least four teeth, but has 3"));
  EXPECT_TRUE(
      has(told([](auto& g) { g.profile.valley_radius = m113::pin_radius; }), "must exceed the radius of the pins"));
  EXPECT_TRUE(has(told([](auto& g) { g.profile.flank = 0.5 * pi; }), "between 0 and pi/2 rad"));
  EXPECT_TRUE(has(told([](auto& g) { g.profile.tip_radius = 0.2459; }),
                  "0.24596"));  // f of the independent computation: |(0.244088, 0.030311)| = 0.24596
  EXPECT_TRUE(has(told([](auto& g) { g.profile.tip_radius = 0.5; }), "leave no teeth"));
  EXPECT_TRUE(has(told([](auto& g) { g.valley = nan; }), "\"sprocket\": the angle of a valley"));
  EXPECT_TRUE(has(told([](auto& g) { g.rings.clear(); }), "\"sprocket\": a sprocket needs at least one ring"));
  EXPECT_TRUE(has(told([](auto& g) { g.rings[0] = infinity; }), "\"sprocket\": the position of a ring"));
  EXPECT_NO_THROW(two_rings.check("\"sprocket\""));
}

}  // namespace pin_on_sprocket_test
}  // namespace polybody
