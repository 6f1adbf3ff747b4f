// The M113's tracks at rest on the fixed vehicle, against an independent computation with rigid contacts. Here a pin
// or link with the contact force N penetrates two rings or rims by N/2k, so the track is slightly longer.

#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include <polybody/io/table.hpp>

#include "m113/settled_track.hpp"
#include "support/held.hpp"
#include "support/refusal.hpp"

namespace polybody {
namespace track_start_test {

constexpr double pi = std::numbers::pi;

/// A row of the table of the independent computation.
struct Reference {
  double preload, idler_x, spring, ground_run, upper_run;  ///< [N], [m], [N], [N], [N]
};
constexpr std::array<Reference, 4> table{{{0.0, -3.959963, 3.82e3, 1.5e3, 2.3e3},
                                          {20e3, -3.972315, 11.47e3, 5.3e3, 6.1e3},
                                          {40e3, -3.975523, 28.3e3, 13.6e3, 14.6e3},
                                          {60e3, -3.976410, 47.4e3, 23.1e3, 24.3e3}}};

m113::TrackStart const& settled(double preload) {
  static std::map<double, m113::TrackStart> known;
  auto const [entry, fresh] = known.try_emplace(preload);
  if (fresh) entry->second = m113::settled_track({.preload = preload});
  return entry->second;
}

Vec2 end(TrackLink const& link, double side) {
  return link.centre + side * 0.5 * m113::pitch * Vec2(std::cos(link.angle), -std::sin(link.angle));
}
std::vector<Vec2> pins_of(m113::TrackStart const& start) {
  std::vector<Vec2> pins;
  for (TrackLink const& link : start.links) pins.push_back(end(link, 1.0));
  return pins;
}
TrackLayout layout_of(m113::TrackStart const& start) {
  TrackLayout layout = m113::track();
  layout.circles[5].centre[0] = start.idler_x;
  return layout;
}

double const weight = m113::wallin_2016.link.mass * 9.81 / m113::pitch;  ///< weight of one metre of track [N/m]

/// The highest tension in a row's equilibrium: that of the upper run, plus at most the weight that hangs from the top
/// of the sprocket.
double highest_tension(Reference const& row) { return row.upper_run + weight * (m113::sprocket_z + 0.28); }
/// The depth at which two points carry N [m].
double depth(double normal) { return normal / (2.0 * m113::on_sprocket.stiffness); }

/// Change of the track's length per displacement of the idler, from `TrackPath::pull`.
double share() {
  TrackPath const path = wrap_track(m113::track());
  return -path.pull.dot(path.layout.tensioner.direction);
}
/// Upper bound of the displacement of the idler. The deformation of contacts lengthens the path by ΔL with T ΔL = ΣN
/// d, and ΣN ≤ 2π T around a convex loop. The mean depth is at most that of the sprocket, at which links rotate most
/// and N = 2 T sin π/10. Hence ΔL ≤ 2π d. The tension is that of the reference; with yielding contacts it is lower,
/// as the spring relaxes with the idler.
double given_way(Reference const& row) { return 2.0 * pi * depth(2.0 * row.upper_run * std::sin(pi / 10.0)) / share(); }

/// Upper bound of the distance of pins from the reference. It is the sum of the displacement of the idler, the
/// additional sag of the upper run, and the deformation of the supporting contacts. The sag is w L²/8T between the
/// sprocket and wheel 2 and grows because the tension is lower.
double out_of_place(Reference const& row) {
  double const span = -m113::wheel(1, m113::Side::left).x, sag = weight * span * span / (8.0 * row.upper_run);
  double const spring =
      row.preload + m113::tensioner.stiffness * (settled(row.preload).idler_x - m113::idler_reference_x);
  return given_way(row) + sag * (row.spring / spring - 1.0) + depth(highest_tension(row));
}

/// The smallest gap between wheel i and the upper run.
double gap_above(m113::TrackStart const& start, int wheel) {
  TrackLayout const layout = layout_of(start);
  std::vector<Vec2> const pins = pins_of(start);
  double least = 1.0;
  for (std::size_t i = 0; i < 64; ++i)
    if (pins[i][1] > m113::wheel_z)
      least = std::min(least, detail::track_gap(pins[i], pins[(i + 1) % 64], layout.half_thickness,
                                                layout.circles[std::size_t(wheel)]));
  return least;
}

TEST(SettledTrack, Closes) {
  for (Reference const& row : table) {
    m113::TrackStart const& start = settled(row.preload);
    ASSERT_EQ(start.links.size(), 64u);
    for (std::size_t i = 0; i < 64; ++i)
      EXPECT_LT((end(start.links[i], -1.0) - end(start.links[(i + 1) % 64], 1.0)).norm(), 1e-9 * m113::pitch)
          << "link " << i;
    EXPECT_LT(clearances(layout_of(start), pins_of(start)).stretch, 1e-9 * m113::pitch);
  }
}

// Penetrations agree with the tension. Pins on the sprocket carry 2 T sin π/10, and links, which rotate by less than
// 60° at their contacts, less than T. At 20 kN that is 1.8 mm. On the ground the front corners of a link are also two
// points.
TEST(SettledTrack, SinksNoDeeperThanItsTensionPresses) {
  for (Reference const& row : table) {
    TrackClearances const gaps = clearances(layout_of(settled(row.preload)), pins_of(settled(row.preload)), 0.0);
    double const tension = highest_tension(row);
    EXPECT_GT(gaps.circles, -depth(tension)) << row.preload;
    EXPECT_GT(gaps.sprocket, -depth(2.0 * tension * std::sin(pi / 10.0))) << row.preload;
    EXPECT_GT(gaps.ground, -depth(tension)) << row.preload;
    EXPECT_LT(gaps.circles, 0.0) << row.preload;
    EXPECT_LT(gaps.sprocket, 0.0) << row.preload;
    EXPECT_LT(gaps.ground, 0.0) << row.preload;
  }
}

// The idler is further out than in the reference. The difference is at most the deformation of the contacts: 3.0 mm at
// 20 kN, 7.2 mm at 40 kN.
TEST(SettledTrack, HasItsIdlerWhereTheReferenceHas) {
  for (Reference const& row : table) {
    double const out = row.idler_x - settled(row.preload).idler_x;
    EXPECT_GT(out, 0.0) << row.preload;
    EXPECT_LT(out, given_way(row)) << row.preload;
  }
  held({"M113 track", "place of the idler at rest, contacts of 2e6 N/m [m]", By::independent,
        "links.csv, a program of its own, rigid contacts", "settled_track"},
       settled(m113::preload).idler_x, m113::idler_start_x, 3e-3);
}

TEST(SettledTrack, HasItsPinsWhereTheReferenceHas) {
  Table const links = read_csv(std::filesystem::path(__FILE__).parent_path() / "data" / "links.csv");
  std::vector<double> const x = links.column("pin_front_x"), z = links.column("pin_front_z");
  std::vector<Vec2> const pins = pins_of(settled(m113::preload));
  EXPECT_LT(out_of_place(table[1]), 15e-3);
  for (std::size_t i = 0; i < 64; ++i)
    EXPECT_LT((pins[i] - Vec2(x[i], z[i])).norm(), out_of_place(table[1])) << "pin " << i;
  double farthest = 0.0;
  for (std::size_t i = 0; i < 64; ++i) farthest = std::max(farthest, (pins[i] - Vec2(x[i], z[i])).norm());
  held_within({"M113 track", "pins at rest, contacts of 2e6 N/m [m]", By::independent,
               "links.csv, a program of its own, rigid contacts", "settled_track"},
              farthest, 15e-3, {.scale = m113::pitch});
}

// Independent computation of the gaps between the upper run and the wheels, in millimetres. With less tension the
// upper run also rests on the same wheels as the reference.
TEST(SettledTrack, LiesOnTheWheelsThatTheReferenceLiesOn) {
  constexpr std::array<std::array<double, 5>, 4> gaps{
      {{0, 0, 0, 0, 0}, {17, 0, 0, 0, 0}, {44, 5, 0, 0, 16}, {58, 19, 0, 1, 23}}};
  for (std::size_t row = 0; row < 4; ++row)
    for (int i = 0; i < m113::wheels; ++i) {
      double const gap = gap_above(settled(table[row].preload), i), expected = 1e-3 * gaps[row][std::size_t(i)];
      EXPECT_NEAR(gap, expected, out_of_place(table[row])) << "wheel " << i + 1 << " at " << table[row].preload;
      if (expected == 0.0) {
        EXPECT_LE(gap, 0.0) << "wheel " << i + 1 << " at " << table[row].preload;
      }
    }
}

// A vehicle built with this start satisfies its constraint equations, for any choice of the cut pin.
TEST(SettledTrack, IsAStartForTheVehicle) {
  for (int const cut : {0, 17}) {
    m113::Vehicle<> const vehicle(Constraint{}, {m113::drive(25.0), m113::drive(25.0)},
                                  {.cut = cut, .closure = m113::Closure::in_plane, .start = settled(m113::preload)});
    State const x = vehicle.model.reference_state();
    System system(vehicle.model);
    EXPECT_LT(largest_violation(system, x).position, 1e-9 * m113::pitch);
    auto const& side = vehicle.side(m113::Side::right);
    EXPECT_NEAR(position(vehicle.model, x, side.idler[0].at(Vec3(0, 0, 0))).x(), settled(m113::preload).idler_x, 1e-15);
    EXPECT_NEAR(position(vehicle.model, x, side.links[3].at(Vec3(0, 0, 0))).z(),
                settled(m113::preload).links[3].centre[1], 1e-15);
  }
}

TEST(SettledTrack, RefusesWhatCannotBeMeant) {
  double const nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(has(refusal([&] { m113::settled_track({.preload = nan}); }),
                  "\"left tensioner spring\": the preload must be finite"));
  EXPECT_TRUE(has(refusal([&] { m113::settled_track({.cut = 64}); }),
                  "the pin that closes a track must lie in [0, 63], but is 64"));
  EXPECT_TRUE(has(refusal([&] { m113::settled_track({.cut = -1}); }), "but is -1"));
  m113::VehicleOptions options;
  options.masses.link.mass = 0.0;
  EXPECT_TRUE(has(refusal([&] { m113::settled_track(options); }), "the mass must be positive"));
  m113::VehicleOptions few;
  few.start.links.pop_back();
  EXPECT_TRUE(has(refusal([&] { m113::Vehicle<>(Constraint{}, {m113::drive(0.0), m113::drive(0.0)}, few); }),
                  "needs the positions of 64 links, but has 63"));
}

// A preload is refused if it pulls the track through its wheels, or pushes the idler into the last wheel.
TEST(SettledTrack, RefusesAPreloadBeyondTheTensionersTravel) {
  for (double const bad : {1e6, -100e3})
    EXPECT_TRUE(has(refusal([&] { m113::settled_track({.preload = bad}); }), "preload")) << bad;
}

}  // namespace track_start_test
}  // namespace polybody
