// The track of an M113-like vehicle against an independent computation of its taut track and of its equilibrium
// (positions rounded to 1e-9 m). Further tests: chains of short links against strings, and invented vehicles.

#include <gtest/gtest.h>

#include <filesystem>

#include <polybody/io/table.hpp>
#include <polybody/math/quaternion.hpp>
#include <polybody/vehicle/track_path.hpp>

#include "m113/data.hpp"
#include "support/held.hpp"
#include "support/refusal.hpp"

namespace polybody {
namespace track_path_test {

constexpr double pi = std::numbers::pi;

Table reference(char const* name) { return read_csv(std::filesystem::path(__FILE__).parent_path() / "data" / name); }

/// The front pins of all links.
std::vector<Vec2> pins_of(Table const& table) {
  std::vector<double> const x = table.column("pin_front_x"), z = table.column("pin_front_z");
  std::vector<Vec2> pins;
  for (std::size_t i = 0; i < x.size(); ++i) pins.emplace_back(x[i], z[i]);
  return pins;
}

/// A battle tank: rear sprocket, rollers under the upper run, seven wheels, and a front idler that also tightens
/// upwards. `pressed` adds a roller on the outer face of the upper run between the second and the third roller
/// beneath it.
TrackLayout tank(bool pressed) {
  TrackLayout t{.links = 77,
                .pitch = 0.18,
                .half_thickness = 0.04,
                .sprocket = {.name = "rear sprocket", .centre = Vec2(-5.6, 0.75), .teeth = 11, .valley = 0.1},
                .circles = {{"roller 1", Vec2(-4.3, 0.95), 0.1}, {"roller 2", Vec2(-2.8, 0.97), 0.1}},
                .tensioner = {.circle = "idler", .direction = Vec2(0.9, 0.2), .least = -0.1, .most = 0.3}};
  if (pressed) t.circles.push_back({"presser", Vec2(-2.0, 1.12), 0.1, TrackSide::outside});
  t.circles.push_back({"roller 3", Vec2(-1.3, 0.95), 0.1});
  t.circles.push_back({"idler", Vec2(0.2, 0.7), 0.25});
  for (int i = 0; i < 7; ++i) t.circles.push_back({"wheel " + std::to_string(i + 1), Vec2(-0.5 - 0.73 * i, 0.4), 0.32});
  return t;
}

/// The layout rotated by `angle` about y and displaced.
TrackLayout carried(TrackLayout t, double angle, Vec2 const& by) {
  auto const turned = [&](Vec2 const& r) {
    return Vec2(std::cos(angle) * r[0] + std::sin(angle) * r[1], -std::sin(angle) * r[0] + std::cos(angle) * r[1]);
  };
  t.sprocket.centre = turned(t.sprocket.centre) + by;
  t.sprocket.valley = t.sprocket.valley + angle;
  for (TrackCircle& c : t.circles) c.centre = turned(c.centre) + by;
  t.tensioner.direction = turned(t.tensioner.direction);
  return t;
}

/// The names of the touched parts, in the order in which the track meets them.
std::string touched(TrackPath const& path) {
  std::string names;
  int before = TrackLink::none;
  for (TrackLink const& link : path.links) {
    if (link.touches == TrackLink::none || link.touches == before) continue;
    before = link.touches;
    names += (names.empty() ? "" : ", ") + path.layout.circles[before].name;
  }
  return names;
}

// Independent computation: 64 links of 0.1524 m close at x = −3.963784 (position without stretch, to twelve digits).
TEST(TrackPath, OfTheM113ClosesWhereTheReferenceDoes) {
  TrackPath const path = wrap_track(m113::track());
  auto const claim = [](char const* what) {
    return Claim{"M113 track", what, By::independent, "links_taut.csv, a program of its own", "wrap_track, 64 links"};
  };
  held(claim("place of the idler [m]"), -3.95 - path.travel, -3.963784320626, 1e-11);
  EXPECT_NEAR(path.layout.circles[5].centre[0], m113::idler_reference_x, 1e-11);
  EXPECT_EQ(path.seated, 5);
  EXPECT_EQ(path.first_valley, 0);

  Table const table = reference("links_taut.csv");
  std::vector<Vec2> const pins = pins_of(table);
  ASSERT_EQ(path.pins.size(), 64u);
  ASSERT_EQ(path.links.size(), 64u);
  std::vector<double> const x = table.column("x"), z = table.column("z"), angle = table.column("beta_rad");
  std::vector<double> const q0 = table.column("q0"), q2 = table.column("q2");
  for (std::size_t i = 0; i < 64; ++i) {
    std::string const link = equals("link", double(i));
    held_within(claim("places of the pins [m]"), (path.pins[i] - pins[i]).norm(), 1e-9, {link, 4.0});
    held_within(claim("middles of the links [m]"), (path.links[i].centre - Vec2(x[i], z[i])).norm(), 1e-9, {link, 4.0});
    held(claim("angles of the links [rad]"), path.links[i].angle, angle[i], 1e-8, {link, 1.0});
    Placement const place = path.links[i].placement(-m113::track_y);
    EXPECT_LT((place.origin - Vec3(x[i], -1.0795, z[i])).norm(), 1e-9) << "link " << i;
    EXPECT_LT((place.axes - rotation_matrix<double>(Vec4(q0[i], 0.0, q2[i], 0.0))).norm(), 1e-8) << "link " << i;
  }
}

// Links 9 and 27 touch wheels 1 and 5, links 32 to 37 the idler. The upper run clears all wheels in the independent
// computation of straight runs.
TEST(TrackPath, TellsWhatEachLinkAndPinRestsOn) {
  TrackPath const path = wrap_track(m113::track());
  EXPECT_EQ(touched(path), "wheel 1, wheel 5, idler");
  for (int i = 0; i < 64; ++i) {
    int const expected = i == 9 ? 0 : i == 27 ? 4 : i >= 32 && i <= 37 ? 5 : TrackLink::none;
    EXPECT_EQ(path.links[i].touches, expected) << "link " << i;
    EXPECT_EQ(path.pin_on(i), i < 5 ? TrackPath::sprocket : i >= 33 && i <= 37 ? 5 : TrackLink::none) << "pin " << i;
  }
}

// Independent computation: p = 0.154 m gives −4.0120.
TEST(TrackPath, OfALongerPitchClosesFurtherBack) {
  TrackLayout layout = m113::track();
  layout.pitch = 0.154;
  held({"M113 track", "place of the idler, p = 0.154 m [m]", By::independent, "a program of its own",
        "wrap_track, 64 links"},
       wrap_track(layout).layout.circles[5].centre[0], -4.0120, 5e-5);
}

// The independent computation has a unique root. The length of the loop increases over the whole travel of the idler.
TEST(TrackPath, OfTheM113HasOneRoot) {
  TrackLayout const layout = m113::track();
  for (double travel = -0.02; travel < 0.0995; travel += 5e-4)
    EXPECT_LT(track_length(layout, travel), track_length(layout, travel + 5e-4)) << "travel " << travel;
}

// Independent computation of the equilibrium with a preload. The tensioner's spring carries 28.3 kN at tensions of
// 13.6 to 14.6 kN in the two runs, and 47.4 kN at 23.1 to 24.3 kN. A higher tension gives straighter runs.
TEST(TrackPath, PullsTheTensionerWithBothRuns) {
  TrackPath const path = wrap_track(m113::track());
  double const share = -path.pull.dot(path.layout.tensioner.direction);
  EXPECT_GT(28.3 / share, 13.6);
  EXPECT_LT(28.3 / share, 14.6);
  EXPECT_GT(47.4 / share, 23.1);
  EXPECT_LT(47.4 / share, 24.3);
  // The directions of links 32 and 37 in links_taut.csv: (cos b₃₂ − cos b₃₇, sin b₃₇ − sin b₃₂).
  EXPECT_NEAR(path.pull[0], std::cos(0.233036280) - std::cos(3.031794984), 1e-8);
  EXPECT_NEAR(path.pull[1], std::sin(3.031794984) - std::sin(0.233036280), 1e-8);
}

// For every vehicle, links have their length, and faces touch rims without penetration. Pins are on the pitch circle
// or outside, and the chain makes one full turn.
TEST(TrackPath, ClosesWithoutStretchOrPenetration) {
  TrackLayout moved = m113::track();
  moved.sprocket.valley = moved.sprocket.valley + 0.11;
  TrackLayout relisted = tank(false);
  relisted.sprocket.valley = relisted.sprocket.valley + 4.0 * 2.0 * pi / 11.0;
  for (TrackLayout const& layout : {m113::track(), moved, tank(false), tank(true), relisted}) {
    TrackPath const path = wrap_track(layout);
    TrackClearances const gaps = clearances(path);
    ASSERT_EQ(int(path.pins.size()), layout.links);
    EXPECT_LT(gaps.stretch, 1e-14);
    EXPECT_NEAR(gaps.circles, 0.0, 1e-14);
    EXPECT_NEAR(gaps.sprocket, 0.0, 1e-14);
    double turned = 0.0;
    for (std::size_t i = 0; i < path.links.size(); ++i)
      turned += std::remainder(path.links[(i + 1) % path.links.size()].angle - path.links[i].angle, 2.0 * pi);
    EXPECT_NEAR(turned, 2.0 * pi, 1e-12);
  }
}

TEST(TrackPath, GoesOverReturnRollersToARearSprocket) {
  TrackPath const path = wrap_track(tank(false));
  EXPECT_EQ(touched(path), "roller 1, roller 2, roller 3, idler, wheel 1, wheel 7");
  EXPECT_GE(path.seated, 5);
  EXPECT_LT(path.pins[0][1], 0.75);  // the track reaches the rear sprocket from below
  EXPECT_GT(path.pull.dot(Vec2(-0.9, -0.2)), 1.5);
  EXPECT_LT((path.layout.circles[3].centre - Vec2(0.2, 0.7) - path.travel * Vec2(0.9, 0.2).normalized()).norm(), 1e-15);
}

TEST(TrackPath, PassesBelowARollerOnItsOuterFace) {
  TrackPath const path = wrap_track(tank(true));
  EXPECT_EQ(touched(path), "roller 1, roller 2, presser, roller 3, idler, wheel 1, wheel 7");
  double inward = 0.0;  // the chain bends back at the presser by the rotations of the two adjacent runs
  for (std::size_t i = 1; i < path.links.size(); ++i)
    inward = std::min(inward, std::remainder(path.links[i].angle - path.links[i - 1].angle, 2.0 * pi));
  EXPECT_LT(inward, -0.1);
}

/// Largest excess length of a chain over a string, on tangents to a circle of radius r. At a corner no further than p
/// from the points of contact of its links, the excess is 2 (t − r atan(t/r)) ≤ 2p³/(3r²). There are at most wrap r/p
/// + 2 corners. The bound includes the chords of the sprocket's seats, p³/(24r²) each.
double excess(double pitch, double radius, double wrap) {
  return 2.0 * std::pow(pitch, 3) / (3.0 * radius * radius) * (wrap * radius / pitch + 2.0);
}

/// Two circles of radii r₁ (the pitch circle) and r₂ = R + h, at the distance d.
TrackLayout belt(int teeth, double r1, double r2, double d, double h) {
  return {.links = 100,
          .pitch = 2.0 * r1 * std::sin(pi / teeth),
          .half_thickness = h,
          .sprocket = {.centre = Vec2(0.0, 0.0), .teeth = teeth, .valley = 0.01},
          .circles = {{"idler", Vec2(-d, 0.0), r2 - h}},
          .tensioner = {.circle = "idler", .direction = Vec2(-1.0, 0.0), .least = 0.0, .most = 0.0}};
}

// An open belt has the length 2 √(d² − (r₂ − r₁)²) + π (r₁ + r₂) + 2 (r₂ − r₁) asin((r₂ − r₁)/d).
TEST(TrackPath, OfShortLinksIsAsLongAsAString) {
  double const d = 3.0, r1 = 0.4, r2 = 0.6, gamma = std::asin((r2 - r1) / d);
  double const string = 2.0 * d * std::cos(gamma) + pi * (r1 + r2) + 2.0 * (r2 - r1) * gamma;
  for (int const teeth : {40, 400}) {
    TrackLayout const layout = belt(teeth, r1, r2, d, 0.02);
    double const allowed = excess(layout.pitch, r1, pi) + excess(layout.pitch, r2, pi + 2.0 * gamma);
    held({"M113 track", "length of an open belt of short links [m]", By::closed_form,
          "2 √(d² − (r₂ − r₁)²) + π (r₁ + r₂) + 2 (r₂ − r₁) asin((r₂ − r₁)/d)", "track_length"},
         track_length(layout, 0.0) * layout.pitch, string, allowed, {equals("teeth", teeth)});
    EXPECT_LT(allowed, teeth == 40 ? 4e-2 : 4e-4);
  }
}

// A presser at (−d/2, z) between equal circles divides the upper run into two tangents. They cross the lines of
// centres, of length D: sin γ = (r + ρ)/D, tan δ = 2z/d. Each is D cos γ long. Both circles gain the arc γ − δ, and
// the presser takes twice that arc.
TEST(TrackPath, OfShortLinksBendsAroundBothFacesAsAStringDoes) {
  double const d = 3.0, r = 0.5, rho = 0.2, z = 0.55, between = std::hypot(0.5 * d, z);
  double const gamma = std::asin((r + rho) / between), delta = std::atan2(z, 0.5 * d), bend = gamma - delta;
  ASSERT_GT(bend, 0.05);
  double const string = d + 2.0 * between * std::cos(gamma) + 2.0 * r * (pi + bend) + 2.0 * rho * bend;
  for (int const teeth : {80, 800}) {
    TrackLayout layout = belt(teeth, r, r, d, 0.02);
    layout.circles.push_back({"presser", Vec2(-0.5 * d, z), rho - 0.02, TrackSide::outside});
    double const allowed = 2.0 * excess(layout.pitch, r, pi + bend) + excess(layout.pitch, rho, 2.0 * bend);
    held({"M113 track", "length of a belt of short links bent to both sides [m]", By::closed_form,
          "a string of tangents and arcs", "track_length"},
         track_length(layout, 0.0) * layout.pitch, string, allowed, {equals("teeth", teeth)});
    EXPECT_LT(allowed, teeth == 80 ? 2e-2 : 2e-4);
  }
}

TEST(TrackPath, DoesNotDependOnWhereTheVehicleStands) {
  Vec2 const by(12.0, -3.0);
  TrackPath const path = wrap_track(tank(true)), elsewhere = wrap_track(carried(tank(true), 0.7, by));
  EXPECT_NEAR(path.travel, elsewhere.travel, 1e-12);
  ASSERT_EQ(path.seated, elsewhere.seated);
  for (std::size_t i = 0; i < path.links.size(); ++i) {
    EXPECT_NEAR(std::remainder(elsewhere.links[i].angle - path.links[i].angle - 0.7, 2.0 * pi), 0.0, 1e-12)
        << "link " << i;
    EXPECT_EQ(elsewhere.links[i].touches, path.links[i].touches) << "link " << i;
  }
}

// The choice of the valley for the sprocket's angle does not affect the path.
TEST(TrackPath, DoesNotDependOnTheValleyThatIsNamed) {
  TrackLayout other = m113::track();
  other.sprocket.valley = other.sprocket.valley + 7.0 * 2.0 * pi / 10.0;
  TrackPath const path = wrap_track(m113::track()), same = wrap_track(other);
  EXPECT_EQ(same.first_valley, -7);
  for (std::size_t i = 0; i < path.pins.size(); ++i)
    EXPECT_LT((path.pins[i] - same.pins[i]).norm(), 1e-13) << "pin " << i;
}

// The taut track of the M113 is computed without the ground. Its lowest pin is number 10, at z = 0.010440856 in
// links_taut.csv. The lowest corner is that of link 10 at this pin, h cos(0.008430089) below it.
TEST(TrackClearances, SeeTheGround) {
  TrackPath const path = wrap_track(m113::track());
  EXPECT_NEAR(clearances(path, 0.0).ground, 0.010440856 - 0.03315 * std::cos(0.008430089), 2e-9);
  EXPECT_NEAR(clearances(path, -0.05).ground, clearances(path, 0.0).ground + 0.05, 1e-15);
  EXPECT_EQ(clearances(path).ground, std::numeric_limits<double>::infinity());
}

// Independent computation: gaps ≥ −5e-15, lengths exact, all before rounding to 1e-9 m.
TEST(TrackClearances, OfTheReferenceInEquilibriumAreNotNegative) {
  TrackLayout layout = m113::track();
  layout.circles[5].centre[0] = m113::idler_start_x;
  TrackClearances const gaps = clearances(layout, pins_of(reference("links.csv")), 0.0);
  held_within({"M113 track", "stretch of the links in equilibrium [m]", By::independent,
               "links.csv, a program of its own", "clearances"},
              gaps.stretch, 2e-9, {.scale = m113::pitch});
  EXPECT_GT(gaps.circles, -2e-9);
  EXPECT_LT(gaps.circles, 2e-9);
  EXPECT_GT(gaps.sprocket, -2e-9);
  held_within({"M113 track", "gap to the ground in equilibrium [m]", By::independent, "links.csv, a program of its own",
               "clearances"},
              std::abs(gaps.ground), 2e-9, {.scale = m113::pitch});
}

// Links 32 to 37 touch the idler. 1 mm further back it penetrates each by 1 mm · sin b, most link 34 (b = 1.2146; the
// next is link 35 with 2.0502).
TEST(TrackClearances, NameTheDeepestPenetration) {
  TrackPath path = wrap_track(m113::track());
  path.layout.circles[5].centre[0] -= 1e-3;
  TrackClearances const gaps = clearances(path);
  EXPECT_NEAR(gaps.circles, -1e-3 * std::sin(1.214591136), 1e-12);
  EXPECT_EQ(gaps.link, 34);
  EXPECT_EQ(gaps.circle, 5);

  path.pins[20] += Vec2(1e-3, 0.0);
  EXPECT_NEAR(clearances(path).stretch, 1e-3, 1e-6);
  path.pins[2] = path.layout.sprocket.centre;
  EXPECT_NEAR(clearances(path).sprocket, -path.layout.pitch_radius(), 1e-15);
}

TEST(TrackPath, RefusesANumberOfLinksThatDoesNotFit) {
  TrackLayout layout = m113::track();
  layout.links = 62;
  std::string const few = refusal([&] { wrap_track(layout); });
  EXPECT_TRUE(has(few, "62 links are too few"));
  EXPECT_TRUE(has(few, "\"idler\""));
  layout.links = 70;
  EXPECT_TRUE(has(refusal([&] { wrap_track(layout); }), "70 links are too many"));
  layout.links = 0;
  EXPECT_TRUE(has(refusal([&] { wrap_track(layout); }), "the number of links"));
}

TEST(TrackPath, RefusesWheelsThatOverlap) {
  TrackLayout layout = tank(false);
  layout.circles[6].centre[0] += 0.1;  // wheels 2 and 3 are 0.73 − 2 · 0.32 = 0.09 m apart
  EXPECT_TRUE(has(refusal([&] { wrap_track(layout); }), "\"wheel 2\" and \"wheel 3\" overlap by 0.01 m"));
  layout = m113::track();
  layout.circles[0].radius = 0.31;
  EXPECT_TRUE(has(refusal([&] { wrap_track(layout); }), "duplicate circle name \"wheel 1\""));
  layout = m113::track();
  layout.tensioner.least = -0.2;  // forward of −3.95 m + 0.025 m the idler touches wheel 5
  layout.links = 62;
  EXPECT_TRUE(has(refusal([&] { wrap_track(layout); }), "\"wheel 5\" and \"idler\" overlap"));
  layout = m113::track();
  layout.circles.insert(layout.circles.begin(), {"guard", Vec2(-0.3, 0.6), 0.1});
  EXPECT_TRUE(has(refusal([&] { wrap_track(layout); }), "\"guard\" and \"sprocket\" overlap"));
}

TEST(TrackPath, RefusesAPitchTooLongForAWheel) {
  TrackLayout layout = belt(4, 0.5, 0.2, 3.0, 0.02);  // 0.71 m around a circle of 0.2 m
  layout.tensioner.most = 1.0;
  layout.links = int(std::ceil(track_length(layout, 0.0)));
  EXPECT_TRUE(has(refusal([&] { wrap_track(layout); }), "too long for \"idler\""));
  layout.sprocket.teeth = 3;
  EXPECT_TRUE(has(refusal([&] { wrap_track(layout); }), "at least four teeth"));
}

TEST(TrackPath, RefusesCirclesOutOfOrder) {
  TrackLayout layout = m113::track();
  layout.circles.erase(layout.circles.begin() + 6, layout.circles.end());
  std::reverse(layout.circles.begin(), layout.circles.end());
  EXPECT_TRUE(has(refusal([&] { wrap_track(layout); }), "does not touch \"idler\""));
  layout = m113::track();
  layout.circles.erase(layout.circles.begin() + 6, layout.circles.end());
  layout.circles[2].centre[1] = 0.6;  // wheel 3 penetrates the upper run, for which it is not listed
  EXPECT_TRUE(has(refusal([&] { wrap_track(layout); }), " m inside \"wheel 3\""));
}

TEST(TrackPath, RefusesAWheelOnItsWrongSide) {
  TrackLayout layout = m113::track();
  // In front of all other circles, but the track turns down at the sprocket.
  layout.circles.insert(layout.circles.begin(), {"nose", Vec2(1.0, 0.6), 0.3});
  layout.sprocket.centre[1] = 0.4;
  EXPECT_TRUE(has(refusal([&] { wrap_track(layout); }), "\"nose\" must lie inside the track"));
}

// The highest seat of the sprocket is at z = 0.4, below the tangent to two wheels of 0.5 m on both of its sides.
TEST(TrackPath, RefusesASprocketWithinTheRun) {
  TrackLayout layout = belt(10, 0.3, 0.5, 2.0, 0.02);
  layout.sprocket.centre = Vec2(0.0, 0.1);
  layout.circles.insert(layout.circles.begin(), {"front", Vec2(2.0, 0.0), 0.48});
  layout.tensioner.most = 0.2;
  layout.links = int(std::ceil(track_length(layout, 0.0)));
  EXPECT_TRUE(has(refusal([&] { wrap_track(layout); }), "no pin can sit on \"sprocket\""));
}

TEST(TrackPath, RefusesATensionerThatDoesNotTighten) {
  TrackLayout layout = m113::track();
  layout.tensioner.circle = "roller";
  EXPECT_TRUE(has(refusal([&] { wrap_track(layout); }), "\"roller\" is not a circle of the track"));
  layout.tensioner.circle = "wheel 3";
  layout.tensioner.direction = Vec2(0.0, 1.0);
  layout.tensioner.least = 0.0;
  layout.tensioner.most = 0.05;  // the ground run is 11 mm below it, the upper run 89 mm above
  EXPECT_TRUE(has(refusal([&] { wrap_track(layout); }), "does not touch \"wheel 3\""));
  layout.tensioner.direction = Vec2(0.0, 0.0);
  EXPECT_TRUE(has(refusal([&] { wrap_track(layout); }), "needs a direction"));
}

}  // namespace track_path_test
}  // namespace polybody
