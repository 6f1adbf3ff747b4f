#include <polybody/vehicle/link_ground_contact.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/differences.hpp>

#include "support/contact_points.hpp"
#include "support/held.hpp"
#include "support/refusal.hpp"

namespace polybody {
using namespace laws;
namespace link_on_ground_test {

double const nan = std::numeric_limits<double>::quiet_NaN();

std::vector<Vec3> const corners{
    {0.055, 0.19, -0.03}, {0.055, -0.19, -0.03}, {-0.055, 0.19, -0.03}, {-0.055, -0.19, -0.03}};
BumpCourse const course({{.x = 0.3, .length = 2.0, .height = 0.2, .y = 0.1, .width = 1.5},
                         {.x = -0.5, .length = 1.5, .height = -0.1}});

LinkGroundContact<> const flat{.pad = corners};
LinkGroundContact<BumpCourse> const rough{.terrain = course, .pad = corners};
LinkGroundContact<FlatGround, MarkerKind::axis> const cable{.pad = {{0.055, 0, -0.03}, {-0.055, 0, -0.03}}};
LinkGroundContact<BumpCourse, MarkerKind::axis> const rough_cable{.terrain = course, .pad = cable.pad};

static_assert(ContactGeometry<LinkGroundContact<>> && ContactGeometry<LinkGroundContact<BumpCourse>> &&
              ContactGeometry<LinkGroundContact<RoadProfile, MarkerKind::axis>>);
template <class G>
concept Drivable = requires { typename LinkGroundContact<G>; };
static_assert(Drivable<Washboard> && !Drivable<double> && !Drivable<Bump>);

Frame<double> at(Vec3 const& r, Vec3 const& turn = Vec3::Zero()) { return {.r = r, .A = exp_so3<double>(turn)}; }

TEST(LinkGroundContact, StandsOnItsFourCorners) {
  Frame<double> const link = at({2.0, -1.0, 0.03 - 0.001}, {0, 0, 0.7});
  auto const found = contact_points(flat, link, {});
  ASSERT_EQ(found.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    held({"M113 contact", "depths of the four corners of a pad on flat ground [m]", By::closed_form,
          "thickness less height", "LinkGroundContact"},
         found[i].depth, 0.001, 1e-16, {equals("corner", double(i + 1))});
    EXPECT_EQ(found[i].normal, Vec3(0, 0, 1));
    EXPECT_EQ(found[i].handover.share, 1.0);
    EXPECT_LT((found[i].place - (link.r + link.A * corners[i])).norm(), 1e-15);
  }
  EXPECT_TRUE(contact_points(flat, at({0, 0, 0.03 + 1e-9}), {}).empty());
}

// Inclined nose down by α, the link rests on its front corners: 0.055 sin α lower.
TEST(LinkGroundContact, StandsOnTheCornersThatAreLow) {
  double const alpha = 0.1, low = 0.03 * std::cos(alpha) + 0.055 * std::sin(alpha);
  auto const found = contact_points(flat, at({0, 0, low - 0.002}, {0, alpha, 0}), {});
  ASSERT_EQ(found.size(), 2u);
  for (auto const& p : found) {
    held({"M113 contact", "penetration of a pad that touches the ground with its front corners [m]", By::closed_form,
          "h cos α + l sin α less height", "LinkGroundContact"},
         p.depth, 0.002, 1e-16);
    EXPECT_GT(p.place[0], 0.0);
  }
}

TEST(LinkGroundContact, KnowsHowHighTheGroundIs) {
  LinkGroundContact<> raised = flat;
  raised.terrain.z = 0.4;
  auto const found = contact_points(raised, at({0, 0, 0.425}), {});
  ASSERT_EQ(found.size(), 4u);
  EXPECT_NEAR(found[0].depth, 0.005, 1e-15);
}

/// A link at a random position over the course, near its surface and inclined by up to about `tilt`, in the ground's
/// axes.
Frame<double> near_ground(Numbers& number, double tilt) {
  double const x = number(1.5), y = number(1.0), z = course.height<double>(x, y).z;
  return at({x, y, z + 0.03 + number(0.03)}, number.vec<3>(tilt));
}

// On slopes: at the vertical depth e below h, the distance to the tangent plane of the surface is e n_z. n is
// perpendicular to both tangents of the surface.
TEST(LinkGroundContact, PressesAcrossTheSlope) {
  Numbers number;
  int compared = 0;
  for (int k = 0; k < 500; ++k) {
    Frame<double> const link = near_ground(number, 0.3);
    std::size_t i = 0;
    auto const found = contact_points(rough, link, {});
    for (Vec3 const& corner : corners) {
      Vec3 const p = link.r + link.A * corner;
      double const z = course.height<double>(p[0], p[1]).z;
      if (z <= p[2]) continue;
      ASSERT_LT(i, found.size());
      double const hx = slope_at_zero([&](double h) { return course.height<double>(p[0] + h, p[1]).z; }, 1e-5);
      double const hy = slope_at_zero([&](double h) { return course.height<double>(p[0], p[1] + h).z; }, 1e-5);
      Vec3 const& n = found[i].normal;
      EXPECT_NEAR(n.norm(), 1.0, 1e-15);
      EXPECT_GT(n[2], 0.0);
      // Finite differences across the foot of a bump have an error of h/5 times the jump of the curvature, 2π²H/L² <
      // 2 per metre.
      EXPECT_NEAR(n.dot(Vec3(1, 0, hx)), 0.0, 5e-6);
      EXPECT_NEAR(n.dot(Vec3(0, 1, hy)), 0.0, 5e-6);
      held_within({"M113 contact", "depths of pads on bumps [m]", By::closed_form, "(h − z) n_z",
                   "LinkGroundContact<BumpCourse>"},
                  std::abs(found[i].depth - (z - p[2]) * n[2]), 1e-15, {.scale = 0.03});
      EXPECT_LT((found[i].place - p).norm(), 1e-15);
      ++i;
    }
    EXPECT_EQ(i, found.size());
    compared += int(i);
  }
  EXPECT_GT(compared, 300);
}

// A tilted and displaced marker of the ground moves the terrain with it: the contact is the same in any axes.
TEST(LinkGroundContact, IsTheSameOnGroundThatIsTilted) {
  Numbers number;
  int compared = 0;
  auto const expect_same = [&](auto const& geometry) {
    for (int k = 0; k < 300; ++k) {
      Frame<double> const link = near_ground(number, 0.3);
      Frame<double> const ground = number.frame();
      auto const expected = contact_points(geometry, link, {}),
                 found = contact_points(geometry, carried(link, ground.A, ground.r), ground);
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t i = 0; i < found.size(); ++i, ++compared) {
        EXPECT_NEAR(found[i].depth, expected[i].depth, 1e-14);
        EXPECT_LT((found[i].normal - ground.A * expected[i].normal).norm(), 1e-13);
        EXPECT_LT((found[i].place - (ground.A * expected[i].place + ground.r)).norm(), 1e-14);
      }
    }
  };
  expect_same(flat);
  expect_same(rough);
  expect_same(cable);
  expect_same(rough_cable);
  EXPECT_GT(compared, 500);
}

// On a plane ∂d/∂r = −n exactly. On a curved surface the error is up to d times the curvature (|h″| ≤ 2π²H/L² + … <
// 2.5 per metre here, d ≤ 0.05 m).
TEST(LinkGroundContact, NormalIsTheSlopeOfTheDepth) {
  Numbers number;
  int compared = 0;
  auto const expect_slope = [&](auto const& geometry, double tolerance) {
    for (int k = 0; k < 200; ++k) {
      Frame<double> const link = near_ground(number, 0.1);
      auto const found = contact_points(geometry, link, {});
      for (std::size_t i = 0; i < found.size(); ++i, ++compared)
        for (int j = 0; j < 3; ++j) {
          double const slope = slope_at_zero(
              [&](double h) {
                Frame<double> shifted = link;
                shifted.r[j] += h;
                auto const p = contact_points(geometry, shifted, {});
                return p.size() == found.size() ? p[i].depth : nan;
              },
              1e-8);
          EXPECT_NEAR(slope, -found[i].normal[j], 1e-7 + tolerance * found[i].depth);
        }
    }
  };
  expect_slope(flat, 0.0);
  expect_slope(rough, 2.5);
  EXPECT_GT(compared, 200);
}

TEST(LinkGroundContact, PassesDualNumbersOn) {
  Numbers number;
  int compared = 0;
  for (int k = 0; k < 200; ++k) {
    Frame<double> const link = near_ground(number, 0.3), ground = number.frame();
    Vec6 const motion = number.vec<6>();
    compared += expect_contact_duals(rough, carried(link, ground.A, ground.r), ground, motion);
    compared += expect_contact_duals(rough_cable, carried(link, ground.A, ground.r), ground, motion);
  }
  EXPECT_GT(compared, 100);
}

// A cable has no z axis: its pad is below the tangent, for any direction of the tangent and any roll of the cable's
// frame.
TEST(LinkGroundContact, HangsThePadOfACableBelowIt) {
  Numbers number;
  for (int k = 0; k < 200; ++k) {
    double const heading = number(3.0), rise = number(0.5), d = 0.003;
    Vec3 const x(std::cos(heading) * std::cos(rise), std::sin(heading) * std::cos(rise), std::sin(rise));
    Vec3 const z = (Vec3::UnitZ() - x * x[2]).normalized();
    double const low = 0.03 * z[2] + 0.055 * std::abs(x[2]);
    for (double const way : {-1.0, 1.0}) {
      Frame<double> link{.r = {number(), number(), low - d}};
      Vec3 const across = Vec3(number.vec<3>()).cross(x).normalized();
      link.A << way * x, across, way * x.cross(across);
      auto const found = contact_points(cable, link, {});
      ASSERT_GE(found.size(), 1u);
      double deepest = 0.0;
      for (auto const& p : found) {
        Vec3 const arm = p.place - link.r;
        EXPECT_NEAR(arm.dot(z), -0.03, 1e-14);
        EXPECT_NEAR(std::abs(arm.dot(x)), 0.055, 1e-14);
        EXPECT_NEAR(arm.dot(x.cross(z)), 0.0, 1e-14);
        EXPECT_EQ(p.normal, Vec3(0, 0, 1));
        deepest = std::max(deepest, p.depth);
      }
      held_within({"M113 contact", "depth of the pad of a cable [m]", By::closed_form,
                   "0.03 z_z + 0.055 abs x_z less height", "LinkGroundContact, cable"},
                  std::abs(deepest - d), 1e-14, {.scale = d});
    }
  }
}

TEST(LinkGroundContact, OnACableIsThatOnALinkThatDoesNotRoll) {
  Numbers number;
  LinkGroundContact<BumpCourse> middle = rough;
  middle.pad = cable.pad;
  int compared = 0;
  for (int k = 0; k < 500; ++k) {
    Frame<double> const twisted = near_ground(number, 0.5);
    Frame<double> link = twisted;
    Vec3 const x = link.A.col(0), z = (Vec3::UnitZ() - x * x[2]).normalized();
    link.A << x, z.cross(x), z;
    auto const expected = contact_points(middle, link, {}), found = contact_points(rough_cable, twisted, {});
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i, ++compared) {
      EXPECT_NEAR(found[i].depth, expected[i].depth, 1e-14);
      EXPECT_LT((found[i].normal - expected[i].normal).norm(), 1e-14);
      EXPECT_LT((found[i].place - expected[i].place).norm(), 1e-14);
    }
  }
  EXPECT_GT(compared, 200);
}

// The z direction of an upright cable is undefined: there is no contact point, instead of one with NaN.
TEST(LinkGroundContact, OfACableThatStandsUprightIsNone) {
  Frame<double> link = at({0, 0, 0.05});
  link.A << Vec3::UnitZ(), Vec3::UnitY(), -Vec3::UnitX();
  EXPECT_TRUE(contact_points(cable, link, {}).empty());
}

TEST(LinkGroundContact, IsNeverMissedByItsBound) {
  Numbers number;
  auto const missed = [&](auto const& geometry) {
    int touching = 0, far = 0, found = 0, beyond = 0;
    for (int k = 0; k < 20000; ++k) {
      Frame<double> const ground = number.frame();
      Frame<double> link = near_ground(number, 3.0);
      link.r[2] += std::abs(number(0.6));
      link = carried(link, ground.A, ground.r);
      bool const touches = !contact_points(geometry, link, ground).empty(), may = geometry.may_touch(link, ground);
      touching += touches;
      far += !may;
      bool const within = geometry.reach(ground).holds(link.r);
      found += (touches && !may) || (may && !within);
      beyond += !within;
    }
    EXPECT_GT(touching, 500);
    EXPECT_GT(far, 500);  // the bound excludes many poses
    EXPECT_GT(beyond, 500);
    return found;
  };
  EXPECT_EQ(missed(flat), 0);
  EXPECT_EQ(missed(rough), 0);
  EXPECT_EQ(missed(cable), 0);
  EXPECT_EQ(missed(rough_cable), 0);
}

TEST(LinkGroundContact, RefusesNumbersThatCannotBeMeantByName) {
  LinkGroundContact<> bad = flat;
  bad.terrain.z = nan;
  EXPECT_TRUE(has(refusal([&] { bad.check("\"ground\""); }), "\"ground\": the height of the ground"));
  EXPECT_TRUE(has(refusal([&] { LinkGroundContact<>{}.check("\"ground\""); }),
                  "\"ground\": the pad of a link needs at least one point"));
  bad = flat;
  bad.pad[2][1] = nan;
  EXPECT_TRUE(has(refusal([&] { bad.check("\"ground\""); }), "\"ground\": a point of the pad"));
  LinkGroundContact<Washboard> const waves{.terrain = {.amplitude = -1.0, .wavelength = 1.0}, .pad = corners};
  EXPECT_TRUE(has(refusal([&] { waves.check("\"ground\""); }), "\"ground\": the amplitude"));
  EXPECT_NO_THROW(rough_cable.check("\"ground\""));
}

}  // namespace link_on_ground_test
}  // namespace polybody
