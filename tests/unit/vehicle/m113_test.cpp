// The data of m113/data.hpp against an independent data sheet of the vehicle of Wallin 2016. The bodies and joints
// in tests/unit/vehicle/data are those of this data sheet without the links (positions to nine digits). Totals and
// conventions are its own as well.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include <polybody/math/quaternion.hpp>
#include <polybody/run/probe.hpp>

#include "m113/data.hpp"
#include "m113/decoupled_link_strain.hpp"
#include "m113/modal_links.hpp"
#include "m113/tracks.hpp"
#include "m113/visual.hpp"
#include "support/held.hpp"

namespace polybody {
namespace m113_test {

using m113::Side;

/// The numbers of each row of a file of tests/unit/vehicle/data after its first `names` fields, by these fields.
std::map<std::string, std::vector<double>> rows(char const* file, int names) {
  std::ifstream in(std::filesystem::path(__FILE__).parent_path() / "data" / file);
  std::map<std::string, std::vector<double>> found;
  std::string line;
  for (std::getline(in, line); std::getline(in, line);) {
    std::size_t end = 0;
    for (int i = 0; i < names; ++i) end = line.find(',', end) + 1;
    std::istringstream fields(line.substr(end));
    std::vector<double>& numbers = found[line.substr(0, end - 1)];
    for (std::string field; std::getline(fields, field, ',');) numbers.push_back(std::stod(field));
  }
  return found;
}

char const* letter(Side side) { return side == Side::left ? "_L" : "_R"; }

/// Compares a body's mass, moments of inertia, position and angle about y with its row.
void expect_body(std::vector<double> const& row, m113::Solid const& body, Vec3 const& place, double angle) {
  ASSERT_EQ(row.size(), 11u);
  EXPECT_DOUBLE_EQ(row[0], body.mass);
  EXPECT_EQ(Vec3(row[1], row[2], row[3]), Vec3(body.inertia));
  held_within({"M113 data", "places of the bodies [m]", By::independent, "bodies.csv", "m113/data.hpp"},
              (Vec3(row[4], row[5], row[6]) - place).norm(), 1e-8, {.scale = 1.0});
  EXPECT_LT(
      (Vec4(row[7], row[8], row[9], row[10]) - Vec4(std::cos(0.5 * angle), 0.0, std::sin(0.5 * angle), 0.0)).norm(),
      1e-8);
}

void expect_point(std::vector<double> const& row, Vec3 const& place, Vec3 const& axis) {
  ASSERT_EQ(row.size(), 6u);
  held_within({"M113 data", "places of the joints [m]", By::independent, "joints.csv", "m113/data.hpp"},
              (Vec3(row[0], row[1], row[2]) - place).norm(), 1e-8, {.scale = 1.0});
  EXPECT_EQ(Vec3(row[3], row[4], row[5]), axis);
}

/// The kinetic energy of a link that moves at 2 m/s is 2 m.
template <class B>
void expect_mass(m113::LinkOf<B> const& links, double mass) {
  Model<Bodies<B>, Joints<>> model;
  auto const link = model.add(links.make({}, {}, 0), "link");
  State x = model.reference_state();
  std::span<double const> const q(x.q.data(), std::size_t(x.q.size()));
  link.body().rigid_velocity(q, Vec3(2.0, 0.0, 0.0), Vec3::Zero(), std::span(x.v.data(), std::size_t(x.v.size())));
  EXPECT_NEAR(energy(model, x).kinetic, 2.0 * mass, 1e-12 * mass);
}

TEST(M113, BodiesAreThoseOfTheReference) {
  auto const bodies = rows("bodies.csv", 1);
  EXPECT_EQ(bodies.size(), 27u);  // 155 less 128 links
  expect_body(bodies.at("chassis"), m113::wallin_2016.chassis, m113::chassis, 0.0);
  for (Side const side : {Side::left, Side::right}) {
    auto const row = [&](std::string const& name) {
      SCOPED_TRACE(name + letter(side));
      return bodies.at(name + letter(side));
    };
    expect_body(row("sprocket"), m113::wallin_2016.sprocket, m113::sprocket(side), 0.0);
    expect_body(row("idler"), m113::wallin_2016.idler, m113::idler(side), 0.0);
    expect_body(row("tensioner"), m113::wallin_2016.tensioner, m113::idler(side), 0.0);
    for (int i = 0; i < m113::wheels; ++i) {
      expect_body(row("wheel" + std::to_string(i + 1)), m113::wallin_2016.wheel, m113::wheel(i, side), 0.0);
      expect_body(row("arm" + std::to_string(i + 1)), m113::wallin_2016.arm, m113::arm(i, side), m113::arm_angle);
    }
  }
}

TEST(M113, JointsAndSpringsAreWhereTheReferenceHasThem) {
  auto const joints = rows("joints.csv", 3);
  EXPECT_EQ(joints.size(), 48u);
  Vec3 const x(1.0, 0.0, 0.0), y(0.0, 1.0, 0.0), z(0.0, 0.0, 1.0);
  for (Side const side : {Side::left, Side::right}) {
    std::string const s = letter(side);
    expect_point(joints.at("revolute+drive,chassis,sprocket" + s), m113::sprocket(side), y);
    expect_point(joints.at("prismatic,chassis,tensioner" + s), m113::idler(side), x);
    expect_point(joints.at("revolute,tensioner" + s + ",idler" + s), m113::idler(side), y);
    std::string const spring = "spring k=1e6 c=1.4e4 F0=20000 ref x,chassis,tensioner" + s;
    expect_point(joints.at(spring), m113::idler(side, m113::idler_reference_x), x);
    for (int i = 0; i < m113::wheels; ++i) {
      std::string const n = std::to_string(i + 1) + s;
      expect_point(joints.at("revolute,chassis,arm" + n), m113::arm_pivot(i, side), y);
      // The row contains the wheel's centre. The arm's end is in the plane of the arm, on the same axis.
      expect_point(joints.at("revolute,arm" + n + ",wheel" + n), m113::wheel(i, side), y);
      Vec3 const end = m113::arm_point(i, side, m113::arm_length);
      EXPECT_LT((end - Vec3(m113::wheel(i, side))).cross(y).norm(), 1e-12);
      Vec3 const on_arm = m113::arm_point(i, side, m113::shock_on_arm);
      expect_point(joints.at("shock k=1e6 c=1.5e4 l0=0.508 end on arm,chassis,arm" + n), on_arm, z);
      expect_point(joints.at("shock end on chassis,chassis,arm" + n), on_arm + m113::shock.length * z, z);
    }
  }
  EXPECT_EQ(m113::shock.stiffness, 1e6);
  EXPECT_EQ(m113::shock.damping, 1.5e4);
  EXPECT_EQ(m113::tensioner.stiffness, 1e6);
  EXPECT_EQ(m113::tensioner.damping, 1.4e4);
  EXPECT_EQ(m113::preload, 20000.0);
}

// Sum of the masses of Wallin 2016, Table 3.1: 15 912.1 kg with the tensioners. The mass of the real vehicle is 11.36
// t.
TEST(M113, WeighsWhatTheReferenceSays) {
  held({"M113 data", "mass of the vehicle of the thesis [kg]", By::independent, "thesis Table 3.1, added up by hand",
        "m113/data.hpp"},
       m113::wallin_2016.total(), 15912.1, 0.05);
  held({"M113 data", "mass of the real vehicle [kg]", By::independent,
        "masses of Project Chrono and thesis Table 3.1, added up by hand", "m113/data.hpp"},
       m113::production_vehicle.total(), 11.36e3, 5.0);
}

// Every row of Wallin 2016, Table 3.1, is that of a homogeneous solid. A cylinder has m R²/2 about its axis and m
// (3R² + w²)/12 about a transverse axis. A box a × b × c has m (b² + c²)/12 about the edge a. So the axes and
// dimensions here are those of the table. Table values have three to five digits.
TEST(M113, InertiasAreThoseOfSolidsOfItsDimensions) {
  double const width = 2.0 * m113::half_width;
  auto const solid = [](char const* what, char const* source) {
    return Claim{"M113 data", what, By::closed_form, source, "thesis Table 3.1, 3 to 5 digits"};
  };
  auto const wheel = [&](m113::Solid const& s, double radius) {
    held(solid("moments of inertia of wheels about their axis [kg m²]", "m R²/2"), s.inertia.y,
         0.5 * s.mass * radius * radius, 5e-4 * s.inertia.y, {equals("R", radius)});
    held(solid("moments of inertia of wheels across [kg m²]", "m (3 R² + w²)/12"), s.inertia.x,
         s.mass * (3.0 * radius * radius + width * width) / 12.0, 5e-4 * s.inertia.x, {equals("R", radius)});
    EXPECT_EQ(s.inertia.z, s.inertia.x);
  };
  wheel(m113::wallin_2016.wheel, m113::wheel_radius);
  wheel(m113::wallin_2016.idler, m113::idler_radius);
  wheel(m113::wallin_2016.sprocket, 0.2520);
  m113::Solid const &arm = m113::wallin_2016.arm, &link = m113::wallin_2016.link, &chassis = m113::wallin_2016.chassis;
  EXPECT_NEAR(arm.inertia.x, 0.5 * arm.mass * 0.01, 5e-4 * arm.inertia.x);  // a bar of radius 0.1 m
  EXPECT_NEAR(arm.inertia.y, arm.mass * (0.03 + m113::arm_length * m113::arm_length) / 12.0, 5e-4 * arm.inertia.y);
  auto const box = [](m113::Solid const& s, Vec3 const& a) {  // a: its edges along x, y, z
    EXPECT_NEAR(s.inertia.x, s.mass * (a[1] * a[1] + a[2] * a[2]) / 12.0, 1e-3 * s.inertia.x);
    EXPECT_NEAR(s.inertia.y, s.mass * (a[0] * a[0] + a[2] * a[2]) / 12.0, 1e-3 * s.inertia.y);
    EXPECT_NEAR(s.inertia.z, s.mass * (a[0] * a[0] + a[1] * a[1]) / 12.0, 1e-3 * s.inertia.z);
  };
  box(link, {0.1516, width, 2.0 * m113::half_thickness});
  box(chassis, {4.603, 1.500, 1.287});
}

// The sprocket's radii, the speeds of Wallin 2016, Figures 3.6 and 4.3, and a cable with a height of 0.0398 m, worked
// out by hand.
TEST(M113, FollowsFromPitchAndTeeth) {
  TrackLayout const track = m113::track();
  auto const derived = [](char const* what, double value, double reference, double tolerance, char const* at = "") {
    held({"M113 data", what, By::independent, "pitch and number of teeth, computed by hand", "m113/data.hpp"}, value,
         reference, tolerance, {at});
  };
  derived("pitch radius of the sprocket [m]", track.pitch_radius(), 0.246588, 5e-7);
  derived("rolling radius of the sprocket [m]", m113::rolling_radius, 0.242552, 5e-7);
  derived("speed of the vehicle [m/s]", m113::rolling_radius * m113::moderate_sprocket_speed, 6.064, 5e-4, "chapter 3");
  derived("speed of the vehicle [m/s]", m113::rolling_radius * m113::fast_sprocket_velocities[0], 7.277, 5e-4,
          "chapter 4, slow");
  derived("speed of the vehicle [m/s]", m113::rolling_radius * m113::fast_sprocket_velocities[1], 19.404, 5e-4,
          "chapter 4, fast");
  EXPECT_NEAR(m113::cable_height, 0.0398, 5e-5);
  EXPECT_NEAR(m113::density * m113::cable_width * m113::cable_height * m113::pitch, 18.024, 1e-12);
}

// The arc of the valley is centred on the radius 0.261588, its root is at 0.226588; worked out by hand from the pitch
// radius.
TEST(M113, PinsSitOnThePitchCircle) {
  double const centre = m113::track().pitch_radius() + m113::valley_radius - m113::pin_radius;
  EXPECT_NEAR(centre, 0.261588, 5e-7);
  EXPECT_NEAR(centre - m113::valley_radius, 0.226588, 5e-7);
  EXPECT_LT(centre, m113::tip_radius);
}

// x(10 s) = 33.35, 40.02 and 106.7 m are the distances of a linear ramp, in closed form. A ramp with rounded ends
// gives the same distances.
TEST(M113, DriveRestsForOneSecondAndRampsForSeven) {
  for (auto const& [speed, distance] : {std::pair{25.0, 33.35}, {30.0, 40.02}, {80.0, 106.7}})
    for (double const rounding : {0.0, 0.1}) {
      Ramp const drive = m113::drive(speed, rounding);
      EXPECT_EQ(drive(0.9).value, 0.0);
      EXPECT_NEAR(drive(4.5).value, 0.5 * speed, 1e-13);
      EXPECT_EQ(drive(8.1).value, speed);
      held({"M113 data", "distance of the drive in 10 s [m]", By::independent,
            "integral of the speed, computed by hand", "Ramp"},
           drive.integral(10.0) * m113::rolling_radius, distance, 0.05,
           {equals("speed", speed) + equals(", rounding", rounding)});
    }
  EXPECT_EQ(m113::drive(25.0).breakpoints(), (std::vector{1.0, 8.0}));
}

// The horn's box is 75 mm high. The middle of its upper face touches a rim, as the links are on both sides of it.
TEST(M113, HornReachesToTheTopOfItsBox) {
  Vec3 const tip = m113::LinkContacts<MarkerKind::frame>().on_rims(0.3).geometry.tip;
  EXPECT_LT((tip - Vec3(0.045, 0.0, 0.0375 + 0.5 * 0.075)).norm(), 1e-15);
}

// ε = M h/(2 E I) = 6 M/(E b h²).
TEST(M113, LinkBendsAsARectangleDoes) {
  double const young = m113::link_bar().material->young, b = m113::cable_width, h = m113::cable_height;
  EXPECT_NEAR(m113::bending_by_moment() * young * b * h * h, 6.0, 1e-12);
}

// A link of another height: its mass is ρ b h p, its strain N/(E b h) for a force N, its bending strain 6 M/(E b h²)
// for a moment M. As a body it has that mass, and the kinetic energy m v²/2 in translation.
TEST(M113, LinksMayHaveAnotherSection) {
  double const young = m113::youngs_modulus, b = m113::cable_width, p = m113::pitch;
  for (double const h : {m113::cable_height / 3.0, 1.7 * m113::cable_height}) {
    double const mass = m113::density * b * h * p;
    EXPECT_NEAR(m113::with_steel_links({}, h).link.mass, mass, 1e-13 * mass);
    EXPECT_NEAR(m113::running_strain(0.0, 1e3, h) * young * b * h, 1e3, 1e-10);
    EXPECT_NEAR(m113::running_strain(3.0, 0.0, h, mass) * young, m113::density * 9.0, 1e-9);
    EXPECT_NEAR(m113::bending_by_moment(h) * young * b * h * h, 6.0, 1e-12);
    expect_mass(m113::LinkOf<AncfCable<>>{.height = h}, mass);
    expect_mass(m113::LinkOf<Lrvf<>>{.height = h}, mass);
    expect_mass(m113::LinkOf<Ffr>{.height = h}, mass);
  }
}

// Every corner of the sprocket's picture is between root and tip.
TEST(M113, DrawsItsSprocketBetweenRootAndTip) {
  SprocketProfile const profile = m113::sprocket_profile();
  double least = 1.0, most = 0.0;
  for (Vec3 const& p : m113::detail::toothed_wheel(0.1).points) {
    least = std::min(least, std::hypot(p[0], p[2]));
    most = std::max(most, std::hypot(p[0], p[2]));
  }
  EXPECT_NEAR(least, profile.arc_centre() - profile.valley_radius, 1e-12);
  EXPECT_NEAR(most, profile.tip_radius, 1e-12);
}

}  // namespace m113_test
}  // namespace polybody
