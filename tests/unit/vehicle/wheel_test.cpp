// Contact point of a wheel, its forces at given frames, and the laws of force elements.
#include <polybody/vehicle/wheel.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/force_laws.hpp>

#include "support/held.hpp"
#include "support/refusal.hpp"
#include "support/tyres.hpp"

namespace polybody {
using namespace laws;
namespace wheel_test {

double const nan = std::numeric_limits<double>::quiet_NaN();
using Frames = std::array<Frame<double>, 2>;
using States = std::array<double, 2>;

BumpCourse const bumps({{.x = 0.3, .length = 6.0, .height = 0.2, .y = 0.1, .width = 5.0}});

template <class G = FlatGround>
Wheel<LinearTyre, G> wheel(double crown = 0.0, G const& ground = {}) {
  return {.radius = 0.35,
          .crown = crown,
          .axle = Vec3::UnitY(),
          .normal = {.stiffness = 2e5, .damping = 500.0, .onset = 1e-3},
          .tyre = linear_tyre,
          .relaxation = {.longitudinal = 0.2, .lateral = 0.4, .damping_time = 2e-3},
          .rolling = {.coefficient = 0.012, .speed = 0.05},
          .terrain = ground};
}
Frames at(Vec3 const& centre, Vec3 const& turn = Vec3::Zero()) {
  return {Frame<double>{.r = centre, .A = exp_so3<double>(turn)}, Frame<double>{}};
}

// The lowest point of a circle of radius ρ whose axle has the inclination γ is ρ cos γ below its centre, and that of a
// sphere about this point is c lower.
TEST(WheelContact, IsTheLowestPointOfDiscAndTorus) {
  for (double const gamma : {0.0, 0.3, -0.8})
    for (double const crown : {0.0, 0.1}) {
      auto const c = wheel(crown).contact<double>(at({1.0, 2.0, 0.3}, {gamma, 0.0, 0.0}));
      double const low = (0.35 - crown) * std::cos(gamma) + crown;
      EXPECT_NEAR(c.depth, low - 0.3, 1e-15);
      EXPECT_LT((c.forward - Vec3::UnitX()).norm() + (c.left - Vec3::UnitY()).norm(), 1e-15);
      EXPECT_NEAR(c.camber, std::sin(gamma), 1e-15);
      EXPECT_LT((c.place - Vec3(1.0, 2.0 + (0.35 - crown) * std::sin(gamma), 0.0)).norm(), 1e-15) << gamma;
      EXPECT_LT((c.arm - (c.place - Vec3(1.0, 2.0, 0.3))).norm(), 1e-15);
    }
}

// Points of the torus, sampled: none is lower than the contact point.
TEST(WheelContact, NoPointOfTheTorusIsLower) {
  double const crown = 0.12;
  Frames const f = at({0.0, 0.0, 0.3}, {0.5, 0.4, -0.9});
  auto const c = wheel(crown).contact<double>(f);
  double lowest = 1.0;
  for (int i = 0; i < 600; ++i)
    for (int k = 0; k < 600; ++k) {
      double const u = i * std::numbers::pi / 300.0, v = k * std::numbers::pi / 300.0;
      double const across = 0.35 - crown + crown * std::cos(v);
      Vec3 const point(across * std::cos(u), crown * std::sin(v), across * std::sin(u));
      lowest = std::min(lowest, (f[0].r + f[0].A * point)[2]);
    }
  EXPECT_NEAR(-c.depth, lowest, 2e-5);
  EXPECT_LE(-c.depth, lowest + 1e-15);
}

// On an inclined plane, given as a terrain, the contact equals that on a flat ground with an inclined marker.
TEST(WheelContact, InclinedTerrainEqualsInclinedMarker) {
  MatX heights(2, 2);
  double const slope = 0.2, side = -0.1;
  heights << 0.0, 40.0 * side, 40.0 * slope, 40.0 * (slope + side);
  HeightField const plane({.x0 = -20.0, .y0 = -20.0, .dx = 40.0, .dy = 40.0, .heights = heights});
  Frames const on_field = at({1.0, -2.0, 5.0}, {0.1, 0.4, 0.7});
  auto const c = wheel(0.1, plane).contact<double>(on_field);
  Vec3 const n = Vec3(-slope, -side, 1.0).normalized(), x = Vec3::UnitY().cross(n).normalized();
  Frames on_plane = on_field;
  on_plane[1].r = Vec3(0.0, 0.0, 20.0 * (slope + side));
  on_plane[1].A << x, n.cross(x), n;
  auto const p = wheel(0.1).contact<double>(on_plane);
  EXPECT_NEAR(c.depth, p.depth, 1e-13);
  EXPECT_NEAR(c.camber, p.camber, 1e-14);
  EXPECT_LT((c.place - (on_plane[1].r + on_plane[1].A * p.place)).norm(), 1e-12);
  EXPECT_LT((c.forward - on_plane[1].A * p.forward).norm(), 1e-13);
}

// The contact point on a cylindrical crest of radius r is on the line between the centres of crest and wheel. A sine
// has the radius of curvature λ²/(4π² a) at its crest.
TEST(WheelContact, PlaneIsTangentAtTheContactPoint) {
  auto const w = wheel(0.0, bumps);
  for (double const x : {-2.0, -0.7, 0.1, 1.3}) {
    auto const c = w.contact<double>(at({x, 0.4, 0.45}, {0.1, 0.0, 0.3}));
    Height<double> const h = bumps.height<double>(c.place[0], c.place[1]);
    EXPECT_NEAR(c.place[2], h.z, 1e-12);
    EXPECT_LT((c.normal - Vec3(-h.slope_x, -h.slope_y, 1.0).normalized()).norm(), 1e-12);
    EXPECT_LT(std::abs(c.forward.dot(c.normal)) + std::abs(c.left.dot(c.normal)), 1e-14);
  }
}

TEST(WheelContact, FlatWheelIsFinite) {
  auto const w = wheel();
  Frames f = at({0.0, 0.0, -0.01}, {0.5 * std::numbers::pi, 0.0, 0.0});
  f[0].v = {1.0, 2.0, 0.0};
  auto const of = w.wrenches<double>(f, {0.01, 0.02}, 0.0);
  EXPECT_TRUE(of[0].f.allFinite() && of[0].m.allFinite());
  EXPECT_NEAR(of[0].f[2], 0.01 * 2e5, 1e-6);
}

// Steady rolling at 10 m/s: without slip velocity no force but the load. Signs of each slip.
TEST(Wheel, SignsOfTheForces) {
  auto w = wheel();
  w.rolling = {};
  Frames f = at({0.0, 0.0, 0.34});
  f[0].v = Vec3(10.0, 0.0, 0.0);
  f[0].w = Vec3(0.0, 10.0 / 0.34, 0.0);
  auto const free = w.wrenches<double>(f, {0.0, 0.0}, 0.0);
  EXPECT_LT((free[0].f - Vec3(0.0, 0.0, 2000.0)).norm(), 1e-9);
  EXPECT_LT(free[0].m.norm(), 1e-9);
  auto const rate = w.rates<double>(f, {0.0, 0.0}, 0.0);
  EXPECT_LT(std::hypot(rate[0], rate[1]), 1e-13);
  // 1 % faster rotation drives: at rest of u̇, u = σ κ and F_x = C κ
  f[0].w *= 1.01;
  auto const driven = w.wrenches<double>(f, {0.2 * 0.01, 0.0}, 0.0);
  EXPECT_NEAR(w.rates<double>(f, {0.2 * 0.01, 0.0}, 0.0)[0], 0.0, 1e-12);
  EXPECT_NEAR(driven[0].f[0], 600.0, 1e-9);
  EXPECT_NEAR(driven[0].m[1], -600.0 * 0.34, 1e-9);
  // a side velocity to the left is resisted by a force to the right behind the contact point
  f[0].w /= 1.01;
  f[0].v[1] = 0.1;
  EXPECT_NEAR(w.rates<double>(f, {0.0, -0.4 * 0.01}, 0.0)[1], 0.0, 1e-12);
  auto const side = w.wrenches<double>(f, {0.0, -0.4 * 0.01}, 0.0);
  EXPECT_NEAR(side[0].f[1], -400.0, 1e-9);
  EXPECT_NEAR(side[0].m[2], 400.0 * 0.03, 1e-9);
  EXPECT_NEAR(side[0].m[0], -400.0 * 0.34, 1e-9);  // ρ × F
}

// A wheel whose top leans to the right (γ > 0) is pushed to the right, with −C_γ sin γ; to the left for γ < 0.
TEST(Wheel, CamberThrust) {
  for (double const gamma : {-0.1, 0.0, 0.05}) {
    Frames f = at({0.0, 0.0, 0.34 * std::cos(gamma)}, {gamma, 0.0, 0.0});
    f[0].v = Vec3(10.0, 0.0, 0.0);
    f[0].w = 10.0 / 0.34 * f[0].A.col(1);
    auto const of = wheel().wrenches<double>(f, {0.0, 0.0}, 0.0);
    double const load = of[0].f[2];
    EXPECT_NEAR(load, 2e5 * 0.01 * std::cos(gamma), 1e-9);
    held({"Wheel", "camber thrust of a wheel with linear tyre [N]", By::closed_form, "−C_γ sin γ", "Wheel<LinearTyre>"},
         of[0].f[1], -2e3 * std::sin(gamma), 1e-12, {equals("camber", gamma), 200.0});
  }
}

TEST(Wheel, RollingResistanceOpposesTheRotation) {
  Frames f = at({0.0, 0.0, 0.34});
  f[0].v = Vec3(10.0, 0.0, 0.0);
  f[0].w = Vec3(0.0, 10.0 / 0.34, 0.0);
  auto const of = wheel().wrenches<double>(f, {0.0, 0.0}, 0.0);
  EXPECT_NEAR(of[0].m[1], -0.012 * 2000.0 * 0.35, 1e-3);
  EXPECT_NEAR(of[0].f[0], 0.0, 1e-12);
}

TEST(Wheel, HasNoForceInTheAir) {
  auto const of = wheel().wrenches<double>(at({0.0, 0.0, 0.3501}), {0.05, 0.05}, 0.0);
  EXPECT_EQ(of[0].f.norm() + of[0].m.norm() + of[1].f.norm() + of[1].m.norm(), 0.0);
}

// Forces are continuous as the wheel touches down while it slides.
TEST(Wheel, TouchesDownWithoutAJump) {
  Frames f = at({0.0, 0.0, 0.35 - 1e-9});
  f[0].v = Vec3(3.0, 1.0, -2.0);
  EXPECT_LT(wheel().wrenches<double>(f, {0.1, 0.1}, 0.0)[0].f.norm(), 0.01);
}

// The deflection of a sliding wheel is bounded: by the parked slip at low speed, by 2 at high speed.
TEST(TyreRelaxation, BoundsTheDeflection) {
  TyreRelaxation const tyre{.longitudinal = 0.3, .lateral = 0.3, .parked_slip = 0.15, .low_speed = 1.0};
  auto const after = [&](double speed, double along, double across) {
    States u{};
    double const step = 5e-4 / speed;
    for (int k = 0; k < 10000; ++k) {  // 5 m; the wheel does not rotate
      auto const rate = tyre.rates<double>(u, along * speed, along * speed, across * speed);
      for (std::size_t i = 0; i < 2; ++i) u[i] += step * rate[i];
    }
    EXPECT_NEAR(u[0] * across, u[1] * along, 1e-12);  // opposite to the slip velocity
    return std::hypot(u[0], u[1]) / 0.3;
  };
  EXPECT_NEAR(after(1e-3, 0.6, 0.8), 0.15, 1e-5);
  EXPECT_NEAR(after(1e3, 0.0, 1.0), 2.0, 1e-5);
  double const x = (1.5 * 1.5 - 1.0) / 3.0, p = x * x * (3.0 - 2.0 * x);
  EXPECT_NEAR(after(1.5, 0.0, 1.0), 2.0 * p + 0.15 * (1.0 - p), 1e-5);
  EXPECT_NEAR(after(1e3, 1.0, 0.0), 1.0, 1e-5);  // κ = −1 of a locked wheel
}

// A locked wheel at low speed is a spring, u = −x, also under motions that oscillate.
TEST(TyreRelaxation, LockedWheelIsASpringAtLowSpeed) {
  TyreRelaxation const tyre{.longitudinal = 0.3, .lateral = 0.3};
  auto const rate = tyre.rates<double>({0.03, -0.02}, 1e-6, 1e-6, 2e-6);
  EXPECT_NEAR(rate[0], -1e-6, 1e-17);
  EXPECT_NEAR(rate[1], -2e-6, 1e-17);
}

// The slip follows κ = −V_sx/V_x over the distance σ: κ (1 − e^{−x/σ}).
TEST(TyreRelaxation, FollowsTheSlipOverItsLength) {
  TyreRelaxation const tyre{.longitudinal = 0.3, .lateral = 0.6};
  States u{};
  double const v = 20.0, h = 1e-6;
  int const n = 30000;  // 0.6 m
  for (int k = 0; k < n; ++k) {
    States const first = tyre.rates<double>(u, v, -0.02 * v, 0.01 * v);
    States const half{u[0] + 0.5 * h * first[0], u[1] + 0.5 * h * first[1]};
    auto const rate = tyre.rates<double>(half, v, -0.02 * v, 0.01 * v);
    for (std::size_t i = 0; i < 2; ++i) u[i] += h * rate[i];
  }
  EXPECT_NEAR(u[0] / 0.3, 0.02 * (1.0 - std::exp(-2.0)), 1e-10);
  EXPECT_NEAR(u[1] / 0.6, -0.01 * (1.0 - std::exp(-1.0)), 1e-10);
}

// Frames of a wheel on the ground, both moving, and states beyond and below saturation.
template <class G, class L>
struct WheelCase {
  static Frames frames(Numbers& number) {
    Frames f{number.frame(), number.frame()};
    f[1].A = exp_so3<double>(number.vec<3>(0.4));
    Vec3 const up = f[1].A.col(2);
    f[0].A = f[1].A * exp_so3<double>(Vec3(0.2 * number(), number(), 2.0 * number()));
    f[0].r =
        f[1].r + f[1].A * Vec3(0.4 * number(), 0.4 * number(), 0.33 + (std::is_same_v<G, BumpCourse> ? 0.15 : 0.0));
    f[0].v += 6.0 * f[1].A.col(0) - 0.3 * up;
    f[0].w += 18.0 * f[0].A.col(1);
    return f;
  }
  static Wheel<L, G> force() {
    auto const w = wheel(0.06, [] {
      if constexpr (std::is_same_v<G, BumpCourse>)
        return bumps;
      else
        return G{};
    }());
    Wheel<L, G> out{.radius = w.radius,
                    .crown = w.crown,
                    .axle = w.axle,
                    .normal = w.normal,
                    .tyre =
                        [] {
                          if constexpr (std::is_same_v<L, LinearTyre>)
                            return linear_tyre;
                          else
                            return magic_tyre;
                        }(),
                    .relaxation = w.relaxation,
                    .rolling = w.rolling,
                    .terrain = w.terrain};
    return out;
  }
  static States states(Numbers&) { return {}; }
};
/// Wheel without camber thrust and without deflection: at rest the normal force alone acts.
template <class G, class L>
struct UndeflectedCase : WheelCase<G, L> {
  static Wheel<L, G> force() {
    auto w = WheelCase<G, L>::force();
    if constexpr (std::is_same_v<L, LinearTyre>)
      w.tyre.camber_stiffness = 0.0;
    else
      w.tyre.camber_factor = 0.0;
    return w;
  }
};
/// Element without a potential: its deflections hold tyre forces that have none.
template <class G, class L>
struct Deflected : Wheel<L, G> {
  void potential(Frames const&, States const&, double) const = delete;
};
template <class G, class L>
struct DeflectedCase : WheelCase<G, L> {
  static Deflected<G, L> force() { return {WheelCase<G, L>::force()}; }
  static States states(Numbers& number) { return {0.02 * number(), 0.03 * number()}; }
};
struct SlidingCase : DeflectedCase<FlatGround, MagicFormula> {
  static States states(Numbers&) { return {0.3, -0.5}; }
};
bool const wheels_obey[] = {obeys<UndeflectedCase<FlatGround, LinearTyre>, ForceLaws>("Wheel"),
                            obeys<UndeflectedCase<BumpCourse, MagicFormula>, ForceLaws>("MagicWheelOnBumps"),
                            obeys<DeflectedCase<FlatGround, MagicFormula>, ForceLaws>("DeflectedMagicWheel"),
                            obeys<DeflectedCase<BumpCourse, LinearTyre>, ForceLaws>("DeflectedWheelOnBumps"),
                            obeys<SlidingCase, ForceLaws>("SlidingWheel")};

TEST(Wheel, RefusesInvalidParameters) {
  auto const refused = [](auto const& change, char const* sentence) {
    auto w = wheel();
    change(w);
    EXPECT_TRUE(has(refusal([&] { w.check("left"); }), sentence));
  };
  using W = Wheel<LinearTyre>;
  refused([](W& w) { w.radius = 0.0; }, "left: the radius of the wheel must be positive and finite, but is 0");
  refused([](W& w) { w.crown = 0.35; },
          "left: the crown must be at least zero and less than the radius 0.35 m, but is 0.35 m");
  refused([](W& w) { w.crown = -0.1; }, "the crown must be at least zero");
  refused([](W& w) { w.axle = Vec3(1, 1, 0); }, "left: the axle");
  refused([](W& w) { w.normal.stiffness = 0.0; }, "left: the contact stiffness");
  refused([](W& w) { w.tyre.cornering_stiffness = 0.0; }, "left: the cornering stiffness of the tyre");
  refused([](W& w) { w.relaxation.longitudinal = 0.0; }, "the longitudinal relaxation length must be positive");
  refused([](W& w) { w.relaxation.lateral = -0.1; }, "the lateral relaxation length must be positive");
  refused([](W& w) { w.relaxation.damping_time = -1.0; }, "the damping time of the tyre must be zero or positive");
  refused([](W& w) { w.relaxation.parked_slip = 0.0; }, "the parked slip must lie in (0, 2], but is 0");
  refused([](W& w) { w.relaxation.parked_slip = 2.5; }, "the parked slip must lie in (0, 2], but is 2.5");
  refused([](W& w) { w.relaxation.low_speed = 0.0; }, "the low speed of the tyre must be positive");
  refused([](W& w) { w.rolling.coefficient = -0.1; }, "the coefficient of the rolling resistance must be zero or pos");
  refused([](W& w) { w.rolling.speed = 0.0; }, "the speed of the rolling resistance must be positive");
  refused([](W& w) { w.terrain.z = nan; }, "the height of the ground must be finite");
}

}  // namespace wheel_test
}  // namespace polybody
