#include <polybody/vehicle/link_roller_contact.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/differences.hpp>

#include "support/contact_points.hpp"
#include "support/held.hpp"
#include "support/refusal.hpp"

namespace polybody {
using namespace laws;
namespace link_on_roller_test {

double const nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();

constexpr double pitch = 0.15, thick = 0.03, radius = 0.3, play = 0.02;
LinkRollerContact<> const one_rim{.pitch = pitch, .half_thickness = thick, .half_width = 0.19, .radius = radius};
LinkRollerContact<> const two_rims{
    .pitch = pitch, .half_thickness = thick, .half_width = 0.19, .radius = radius, .rims = {-0.06, 0.06}};
LinkRollerContact<MarkerKind::axis> const on_cable{
    .pitch = pitch, .half_thickness = thick, .half_width = 0.19, .radius = radius, .rims = {-0.06, 0.06}};
GuideHornContact<> const horn{.tip = Vec3(0.045, 0.0, 0.075), .play = play, .radius = radius};

Frame<double> at(Vec3 const& r, Vec3 const& turn = Vec3::Zero()) { return {.r = r, .A = exp_so3<double>(turn)}; }

/// A roller with its middle at (s, y, R + h − d) in the axes of a link, and its axle rotated from the link's y by
/// `turn`.
Frame<double> over(Frame<double> const& link, double s, double y, double d, Vec3 const& turn = Vec3::Zero()) {
  return {.r = link.r + link.A * Vec3(s, y, radius + thick - d), .A = link.A * exp_so3<double>(turn)};
}

/// A link at random and a roller near it, mostly in contact.
std::pair<Frame<double>, Frame<double>> near_pose(Numbers& number) {
  Frame<double> const link = number.frame();
  return {link, over(link, number(0.1), number(0.25), 0.04 + number(0.06), number.vec<3>(0.4))};
}

TEST(LinkRollerContact, PressesOnAFlatLinkUnderItsMiddle) {
  auto const found = contact_points(one_rim, at({0, 0, 0}), at({0.02, 0.05, radius + thick - 0.001}));
  ASSERT_EQ(found.size(), 1u);
  held({"M113 contact", "depth of a rim in a link that lies flat [m]", By::closed_form, "R + h less the axle's height",
        "LinkRollerContact"},
       found[0].depth, 0.001, 1e-15);
  EXPECT_LT((found[0].normal - Vec3(0, 0, -1)).norm(), 1e-15);
  EXPECT_LT((found[0].place - Vec3(0.02, 0.05, thick)).norm(), 1e-15);
  EXPECT_EQ(found[0].handover.share, 1.0);
}

// The contact law: if the rim's centre is at (s, y, R + h − d) in the link's axes, it touches the face at (s, y, h)
// with the depth d along the face's normal. This holds in any axes.
TEST(LinkRollerContact, FollowsALinkThatIsTilted) {
  Numbers number;
  for (int k = 0; k < 20; ++k) {
    Frame<double> const link = number.frame();
    double const s = number(0.06), y = number(0.1), d = 0.005 + number(0.004);
    auto const found = contact_points(
        one_rim, link, over(link, s, y, d, Vec3(0, number(3.0), 0)));  // a rotated roller gives the same contact
    ASSERT_EQ(found.size(), 1u);
    Claim const tilted{"M113 contact", "depth, normal and place of a rim on a link that is tilted", By::closed_form,
                       "those of the link's axes, carried along", "LinkRollerContact"};
    held_within(tilted, std::abs(found[0].depth - d), 1e-14, {"depth", d});
    held_within(tilted, (found[0].normal + link.A.col(2)).norm(), 1e-14, {"normal", 1.0});
    held_within(tilted, (found[0].place - (link.r + link.A * Vec3(s, y, thick))).norm(), 1e-14, {"place", 1.0});
  }
}

// A roller whose axle is inclined by α about x: its rims at ±b along the axle are b sin α higher and lower.
TEST(LinkRollerContact, TouchesWithBothRims) {
  double const alpha = 0.01, b = 0.06, d = 0.002;
  auto const found = contact_points(two_rims, at({0, 0, 0}), over(at({0, 0, 0}), 0.0, 0.0, d, Vec3(alpha, 0, 0)));
  ASSERT_EQ(found.size(), 2u);
  for (std::size_t k : {0u, 1u}) {
    double const y = k == 0 ? -b : b;
    held({"M113 contact", "depths of the rims of a roller that leans [m]", By::closed_form, "d ∓ b sin α",
          "LinkRollerContact, two rims"},
         found[k].depth, d - y * std::sin(alpha), 1e-15, {equals("y", y)});
    EXPECT_LT((found[k].place - Vec3(0, y * std::cos(alpha), thick)).norm(), 1e-15);
  }
  auto const beside = contact_points(two_rims, at({0, 0, 0}),
                                     over(at({0, 0, 0}), 0.0, 0.15, d));  // one rim is outside the face, at y = 0.21
  ASSERT_EQ(beside.size(), 1u);
  EXPECT_NEAR(beside[0].place[1], 0.09, 1e-15);
}

TEST(LinkRollerContact, LeavesAloneWhatIsAboveBelowAndBeside) {
  Frame<double> const link = at({0, 0, 0});
  double const end = 0.5 * pitch + one_rim.handover;
  EXPECT_EQ(contact_points(one_rim, link, over(link, 0, 0, 1e-9)).size(), 1u);
  EXPECT_EQ(contact_points(one_rim, link, over(link, 0, 0, -1e-9)).size(), 0u);          // just above
  EXPECT_EQ(contact_points(one_rim, link, over(link, 0, 0, radius - 1e-9)).size(), 1u);  // the axle just above the face
  EXPECT_EQ(contact_points(one_rim, link, over(link, 0, 0, radius + 1e-9)).size(), 0u);  // just below it
  // below the link, 1 mm deep in its outer face
  EXPECT_EQ(contact_points(one_rim, link, at({0, 0, -radius - thick + 0.001})).size(), 0u);
  for (double const side : {-1.0, 1.0}) {
    EXPECT_EQ(contact_points(one_rim, link, over(link, side * (end - 1e-9), 0, 0.001)).size(), 1u);
    EXPECT_EQ(contact_points(one_rim, link, over(link, side * (end + 1e-9), 0, 0.001)).size(), 0u);
    EXPECT_EQ(contact_points(one_rim, link, over(link, 0, side * (0.19 - 1e-9), 0.001)).size(), 1u);
    EXPECT_EQ(contact_points(one_rim, link, over(link, 0, side * (0.19 + 1e-9), 0.001)).size(), 0u);
  }
}

// Across the seam between two aligned links the force on a wheel is exactly k d, without a moment about its axle.
// Both links have a share over a length of 2ε.
TEST(LinkRollerContact, HandsOverToTheNextLinkWithoutABump) {
  Contact<LinkRollerContact<>> const law{one_rim, {.stiffness = 2e6}};
  Numbers number;
  Frame<double> const first = number.frame();
  Frame<double> next = first;
  next.r = first.r + first.A.col(0) * pitch;
  double const d = 0.0013, e = one_rim.handover;
  int both = 0;
  for (int i = 0; i <= 400; ++i) {
    double const s = pitch * i / 400.0;  // position from the middle of one link to the middle of the next
    Frame<double> const wheel = over(first, s, 0.0, d);
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    double shares = 0.0;
    std::size_t touching = 0;
    for (Frame<double> const& link : {first, next}) {
      auto const w = law.wrenches<double>({link, wheel}, 0.0);
      force += w[1].f;
      moment += w[1].m;
      auto const found = contact_points(one_rim, link, wheel);
      touching += found.size();
      for (auto const& p : found) {
        EXPECT_GE(p.handover.share, 0.0);
        shares += p.handover.share;
      }
    }
    held({"M113 contact", "shares of two links in a wheel between them", By::closed_form, "1", "LinkRollerContact"},
         shares, 1.0, 1e-13, {equals("s", s)});
    held_within({"M113 contact", "force on a wheel between two links, of k R", By::closed_form, "k d across the links",
                 "LinkRollerContact"},
                (force - first.A.col(2) * (2e6 * d)).norm() / (2e6 * radius), 1e-12, {equals("s", s), 1.0});
    EXPECT_LT(moment.norm(), 1e-12 * 2e6 * radius * radius) << s;
    if (std::abs(s - 0.5 * pitch) < e - 1e-9) {
      EXPECT_EQ(touching, 2u) << s;
    }
    if (std::abs(s - 0.5 * pitch) > e + 1e-9) {
      EXPECT_EQ(touching, 1u) << s;
    }
    both += touching == 2;
  }
  EXPECT_GT(both, 20);
}

// Without damper and friction the wrenches are the gradient of the contact's energy, also if two faces share the
// contact. Hence a wheel that crosses a bend gains no energy.
TEST(LinkRollerContact, IsConservativeAlsoInTheHandover) {
  Contact<LinkRollerContact<>> const law{one_rim, {.stiffness = 2e6}};
  Numbers number;
  int handing_over = 0;
  for (int k = 0; k < 60; ++k) {
    Frame<double> const link = number.frame();
    double const side = k % 2 ? 1.0 : -1.0, s = side * 0.5 * pitch + number(0.9 * one_rim.handover);
    std::array<Frame<double>, 2> const pair{link,
                                            over(link, s, number(0.1), 0.003 + number(0.002), number.vec<3>(0.1))};
    auto const w = law.wrenches<double>(pair, 0.0);
    for (auto const& p : contact_points(one_rim, pair[0], pair[1])) handing_over += p.handover.share < 1.0;
    for (std::size_t j = 0; j < 12; ++j) {
      double const slope = slope_at_zero(
          [&](double h) {
            auto shifted = pair;
            shifted[j / 6] = moved<double>(pair[j / 6], Vec6(Vec6::Unit(Index(j % 6)) * h));
            return law.potential(shifted, 0.0);
          },
          1e-6);
      double const found = j % 6 < 3 ? w[j / 6].f[Index(j % 3)] : w[j / 6].m[Index(j % 3)];
      EXPECT_NEAR(found, -slope, 1e-6 * 2e6 * 0.003) << j;
    }
  }
  EXPECT_GT(handing_over, 30);
}

// Beyond a face its chamfered edge touches the rim in radial direction. The depth increases continuously from zero at
// the end of the face.
TEST(LinkRollerContact, EdgeMeetsTheRimBeyondTheFace) {
  Frame<double> const link = at({0, 0, 0});
  double const reach = radius - one_rim.chamfer, e = 0.1;
  for (double const side : {-1.0, 1.0}) {
    double const height = std::sqrt((reach - 0.002) * (reach - 0.002) - e * e);  // 2 mm deep
    Vec3 const axle(side * (0.5 * pitch + e), 0.03, thick + height), edge(side * 0.5 * pitch, 0.03, thick);
    auto const found = contact_points(one_rim, link, at(axle));
    ASSERT_EQ(found.size(), 1u);
    held({"M113 contact", "depth of a link's edge in a rim [m]", By::closed_form, "along the radius",
          "LinkRollerContact"},
         found[0].depth, 0.002, 1e-13, {equals("side", side)});
    EXPECT_LT((found[0].place - edge).norm(), 1e-15);
    EXPECT_LT((found[0].normal - (edge - axle).normalized()).norm(), 1e-13);
    // 20 mm deep in the extension of the rim, but just beyond the face: the depth is at most the distance from the
    // face
    auto const just = [&](double beyond) {
      return contact_points(one_rim, link, at({side * (0.5 * pitch + beyond), 0, thick + reach - 0.02}));
    };
    double shallow = 1.0;
    for (auto const& p : just(1e-6)) shallow = std::min(shallow, p.depth);
    EXPECT_NEAR(shallow, 1e-6, 1e-12);
    EXPECT_EQ(contact_points(one_rim, link,
                             at({side * (0.5 * pitch + e), 0, thick + std::sqrt(reach * reach - e * e) + 1e-6}))
                  .size(),
              0u);
  }
}

// At a bend towards the wheel the strips above the faces overlap. The wheel moves from the middle of one link to that
// of the next. Up to the bend 2 atan(p/2/(R + h)) = 0.4523, at which it touches both middles, the nearer face carries
// at least half of the force.
TEST(LinkRollerContact, IsNeverLostInABend) {
  // distance of the axle from the line of either link's pins, 1 mm deep in the face
  double const reach = radius + thick - 0.001;
  for (double const bend : {0.01, 0.1, 0.45}) {
    Vec3 const turn(0, -bend, 0);  // the next link points upwards
    Frame<double> const first = at({-0.5 * pitch, 0, 0}),
                        next = at(exp_so3<double>(turn) * Vec3(0.5 * pitch, 0, 0), turn);
    int both = 0;
    double s = -pitch;
    for (double x = -0.5 * pitch; s < 0.0; x += 1e-4) {
      Frame<double> const wheel = at({x, 0, std::max(reach, (reach + x * std::sin(bend)) / std::cos(bend))});
      s = next.A.col(0).dot(wheel.r - next.r);
      double most = 0.0;
      int touching = 0;
      for (Frame<double> const& link : {first, next})
        for (auto const& p : contact_points(one_rim, link, wheel)) {
          ++touching;
          EXPECT_LT(p.depth, 0.001 + 1e-12);
          if (p.depth > 0.001 - 1e-12) most = std::max(most, p.handover.share);
        }
      EXPECT_GE(most, 0.5) << "bend " << bend << " at " << x;
      both += touching == 2;
    }
    EXPECT_GT(both, 0) << bend;
  }
}

template <class G, class Pose>
void expect_may_touch(G const& geometry, Pose const& pose) {
  Numbers number;
  int touching = 0, far = 0, missed = 0, beyond = 0;
  for (int k = 0; k < 20000; ++k) {
    auto const [link, roller] = pose(number);
    bool const touches = !contact_points(geometry, link, roller).empty(), may = geometry.may_touch(link, roller);
    touching += touches;
    far += !may;
    bool const within = geometry.reach(roller).holds(link.r);
    missed += (touches && !may) || (may && !within);
    beyond += !within;
  }
  EXPECT_EQ(missed, 0);
  EXPECT_GT(touching, 1000);
  EXPECT_GT(far, 1000);  // the bound excludes many poses
  EXPECT_GT(beyond, 1000);
}

/// Both close to each other, or both at random.
std::pair<Frame<double>, Frame<double>> any_pose(Numbers& number) {
  if (number() > 0.0) return near_pose(number);
  return {number.frame(), number.frame()};
}

TEST(LinkRollerContact, IsNeverMissedByItsBound) {
  expect_may_touch(one_rim, any_pose);
  expect_may_touch(two_rims, any_pose);
  expect_may_touch(on_cable, any_pose);
}

// The bound is also valid for rims far from the roller's middle, and for a wide transition zone.
TEST(LinkRollerContact, IsNeverMissedByItsBoundWhateverItsNumbers) {
  LinkRollerContact<> wide = one_rim;
  wide.handover = 0.07;
  expect_may_touch(wide, any_pose);
  LinkRollerContact<> far = one_rim;
  far.rims = {-0.9, 0.9};
  expect_may_touch(far, [](Numbers& number) {
    auto [link, roller] = any_pose(number);
    roller.r += roller.A.col(1) * (number() > 0.0 ? 0.9 : -0.9);
    return std::pair(link, roller);
  });
}

/// Compares ∂d/∂r of the link with −n, in a pose with a contact point.
template <class G>
void expect_normal_is_slope(G const& geometry, Frame<double> const& link, Frame<double> const& roller) {
  auto const found = contact_points(geometry, link, roller);
  for (std::size_t k = 0; k < found.size(); ++k)
    for (int i = 0; i < 3; ++i) {
      double const slope = slope_at_zero(
          [&](double h) {
            Frame<double> shifted = link;
            shifted.r[i] += h;
            auto const p = contact_points(geometry, shifted, roller);
            return p.size() == found.size() ? p[k].depth : nan;
          },
          1e-5);
      EXPECT_NEAR(slope, -found[k].normal[i], 1e-9) << i;
    }
}

TEST(LinkRollerContact, NormalIsTheSlopeOfTheDepth) {
  Numbers number;
  int compared = 0;
  for (int k = 0; k < 200; ++k) {
    Frame<double> const link = number.frame();
    Frame<double> const roller =
        over(link, number(0.06), number(0.1), 0.01 + number(0.005), Vec3(number(0.01), number(3.0), number(0.1)));
    compared += contact_points(two_rims, link, roller).size() == 2;
    expect_normal_is_slope(two_rims, link, roller);
  }
  EXPECT_EQ(compared, 200);
}

TEST(LinkRollerContact, PassesDualNumbersOn) {
  Numbers number;
  int compared = 0;
  for (int k = 0; k < 200; ++k) {
    auto const [link, roller] = near_pose(number);
    Vec6 const motion = number.vec<6>();
    compared += expect_contact_duals(two_rims, link, roller, motion);
    compared += expect_contact_duals(on_cable, link, roller, motion);
    compared += expect_contact_duals(horn, link, roller, motion);
  }
  EXPECT_GT(compared, 100);
}

/// A frame of a link with this tangent and without roll relative to the axle: y is as close to the axle as possible.
Frame<double> upright(Frame<double> link, Vec3 const& axle) {
  Vec3 const x = link.A.col(0), y = (axle - x * x.dot(axle)).normalized();
  link.A << x, y, x.cross(y);
  return link;
}

// A cable provides its tangent only. A link with the same tangent and without roll about it has the same contact
// points.
TEST(LinkRollerContact, OnACableIsThatOnALinkThatDoesNotRoll) {
  Numbers number;
  int compared = 0;
  for (int k = 0; k < 2000; ++k) {
    auto const [twisted, roller] = near_pose(number);
    Frame<double> const link = upright(twisted, roller.A.col(1));
    auto const expected = contact_points(two_rims, link, roller), found = contact_points(on_cable, twisted, roller);
    ASSERT_EQ(found.size(), expected.size()) << k;
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_NEAR(found[i].depth, expected[i].depth, 1e-13);
      EXPECT_NEAR(found[i].handover.share, expected[i].handover.share, 1e-11);
      EXPECT_LT((found[i].normal - expected[i].normal).norm(), 1e-13);
      EXPECT_LT((found[i].place - expected[i].place).norm(), 1e-13);
      ++compared;
    }
  }
  EXPECT_GT(compared, 500);
}

TEST(LinkRollerContact, RefusesNumbersThatCannotBeMeantByName) {
  auto const told = [](auto const& change) {
    LinkRollerContact<> bad = one_rim;
    change(bad);
    return refusal([&] { bad.check("\"wheel 1\""); });
  };
  for (double const x : {0.0, -1.0, nan, infinity}) {
    EXPECT_TRUE(has(told([&](auto& g) { g.pitch = x; }), "\"wheel 1\": the pitch of the link"));
    EXPECT_TRUE(has(told([&](auto& g) { g.half_width = x; }), "\"wheel 1\": the link's half width"));
    EXPECT_TRUE(has(told([&](auto& g) { g.radius = x; }), "\"wheel 1\": the radius of the roller"));
    EXPECT_TRUE(has(told([&](auto& g) { g.handover = x; }), "\"wheel 1\": the handover distance"));
  }
  EXPECT_TRUE(has(told([&](auto& g) { g.handover = 0.5 * pitch; }), "below half the pitch"));
  EXPECT_TRUE(has(told([&](auto& g) { g.half_thickness = -1.0; }), "\"wheel 1\": the link's half thickness"));
  EXPECT_TRUE(
      has(told([&](auto& g) { g.chamfer = radius; }), "\"wheel 1\": the chamfer must be smaller than the radius"));
  EXPECT_TRUE(has(told([&](auto& g) { g.rims.clear(); }), "\"wheel 1\": a roller needs at least one rim"));
  EXPECT_TRUE(has(told([&](auto& g) { g.rims.push_back(nan); }), "\"wheel 1\": the position of a rim must be finite"));
  EXPECT_NO_THROW(two_rims.check("\"wheel 1\""));
}

/// A link rotated about the line of its pins by `bow`. The tip of its horn is `within` the rims of a roller at the
/// origin, and `across` its middle.
std::pair<Frame<double>, Frame<double>> guided(double across, double within) {
  Frame<double> const roller = at({0, 0, 0});
  Frame<double> link = at({0, 0, 0}, Vec3(0, 0.4, 0));
  link.r = Vec3(0, across, 0) - exp_so3<double>(Vec3(0, 1.1, 0)) * Vec3(0, 0, radius - within) - link.A * horn.tip;
  return {link, roller};
}

double depth_of(double across, double within) {
  auto const [link, roller] = guided(across, within);
  auto const found = contact_points(horn, link, roller);
  return found.empty() ? 0.0 : found[0].depth;
}

TEST(GuideHornContact, IsPushedBackAlongTheAxle) {
  for (double const side : {-1.0, 1.0}) {
    auto const [link, roller] = guided(side * (play + 0.003), 0.04);
    auto const found = contact_points(horn, link, roller);
    ASSERT_EQ(found.size(), 1u);
    held({"M113 contact", "depth of a horn between rims [m]", By::closed_form, "what it is beyond its play",
          "GuideHornContact"},
         found[0].depth, 0.003, 1e-14, {equals("side", side)});
    EXPECT_LT((found[0].normal - Vec3(0, -side, 0)).norm(), 1e-14);
    EXPECT_LT((found[0].place - (link.r + link.A * horn.tip)).norm(), 1e-14);
    auto const [free_link, same] = guided(side * (play - 1e-9), 0.04);
    EXPECT_TRUE(contact_points(horn, free_link, same).empty());
    expect_normal_is_slope(horn, link, roller);
  }
}

// The penetration is the displacement beyond the play, limited by the depth of the tip within the rims.
TEST(GuideHornContact, ComesInContinuouslyFromTheGapAndFromOutside) {
  for (double within = -0.01; within <= 0.05; within += 0.001)
    for (double across = -0.06; across <= 0.06; across += 0.001)
      EXPECT_NEAR(depth_of(across, within), std::max(0.0, std::min(std::abs(across) - play, within)), 1e-14)
          << across << ", " << within;
}

TEST(GuideHornContact, IsSymmetric) {
  Numbers number;
  for (int k = 0; k < 200; ++k) {
    double const across = number(0.06), within = 0.02 + number(0.03);
    EXPECT_NEAR(depth_of(across, within), depth_of(-across, within), 1e-15);
  }
}

TEST(GuideHornContact, OnACableIsThatOnALinkThatDoesNotRoll) {
  Numbers number;
  GuideHornContact<MarkerKind::axis> const cable{.tip = horn.tip, .play = play, .radius = radius};
  int compared = 0;
  for (int k = 0; k < 2000; ++k) {
    auto const [twisted, roller] = near_pose(number);
    auto const expected = contact_points(horn, upright(twisted, roller.A.col(1)), roller),
               found = contact_points(cable, twisted, roller);
    ASSERT_EQ(found.size(), expected.size()) << k;
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_NEAR(found[i].depth, expected[i].depth, 1e-13);
      EXPECT_LT((found[i].normal - expected[i].normal).norm(), 1e-13);
      EXPECT_LT((found[i].place - expected[i].place).norm(), 1e-13);
      ++compared;
    }
  }
  EXPECT_GT(compared, 500);
}

// A horn beside its rims is pushed back at any distance, so the bound excludes none along the axle.
TEST(GuideHornContact, IsNeverMissedByItsBound) {
  expect_may_touch(horn, any_pose);
  expect_may_touch(horn, [](Numbers& number) {
    auto [link, roller] = any_pose(number);
    roller.r += roller.A.col(1) * number(1.0);
    return std::pair(link, roller);
  });
}

TEST(GuideHornContact, RefusesNumbersThatCannotBeMeantByName) {
  auto const told = [](auto const& change) {
    GuideHornContact<> bad = horn;
    change(bad);
    return refusal([&] { bad.check("\"wheel 1 (horn)\""); });
  };
  EXPECT_TRUE(has(told([](auto& g) { g.tip[1] = nan; }), "\"wheel 1 (horn)\": the tip of the horn"));
  EXPECT_TRUE(has(told([](auto& g) { g.play = -1.0; }), "\"wheel 1 (horn)\": the play of the horn"));
  EXPECT_TRUE(has(told([](auto& g) { g.radius = 0.0; }), "\"wheel 1 (horn)\": the radius of the rims"));
  EXPECT_NO_THROW(horn.check("\"wheel 1 (horn)\""));
}

}  // namespace link_on_roller_test
}  // namespace polybody
