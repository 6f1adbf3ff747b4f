// Bristle friction of contacts: laws, sticking, sliding and energy.
#include <polybody/forces/bristle_friction.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/force_laws.hpp>

using namespace polybody;
using namespace polybody::laws;

namespace bristle_friction_test {

using OnFloor = Contact<SphereOnPlane, SpringDamperContact, BristleFriction>;
using OnDrum = Contact<SphereOnCylinder, HuntCrossleyContact, BristleFriction>;

/// Frames of a body at `place` in the axes of b, and of b.
std::array<Frame<double>, 2> touching(Numbers& number, Vec3 const& place) {
  Frame<double> const b = number.frame();
  Frame<double> a = number.frame();
  a.r = b.r + b.A * place;
  return {a, b};
}
/// Ball that penetrates the floor by 0.3 m. The normal force is about 60 N, and the ball sticks at velocities of about
/// 1 m/s.
struct StickingBall {
  static OnFloor force() {
    return {
        {.radius = 0.8}, {.stiffness = 200.0, .damping = 3.0}, {.coefficient = 2.0, .stiffness = 20.0, .damping = 1.5}};
  }
  static std::array<Frame<double>, 2> frames(Numbers& number) { return touching(number, {number(), number(), 0.5}); }
};
/// Points, which need no axes.
struct StickingPoint : StickingBall {
  static OnFloor force() {
    OnFloor law = StickingBall::force();
    law.geometry.radius = 0.0;
    return law;
  }
  static std::array<Frame<double>, 2> frames(Numbers& number) { return touching(number, {number(), number(), -0.3}); }
};
struct PointOnDrum {
  static OnDrum force() {
    return {{.radius = 0.0, .cylinder = 0.7},
            {.stiffness = 300.0, .damping = 0.1},
            {.coefficient = 2.0, .stiffness = 20.0, .damping = 1.5}};
  }
  static std::array<Frame<double>, 2> frames(Numbers& number) { return touching(number, {0.3, -0.2, number()}); }
};
bool const obeyed[] = {obeys<StickingPoint, ForceLaws>("BristleFrictionOnAPlane"),
                       obeys<PointOnDrum, ForceLaws>("BristleFrictionOnACylinder")};

/// Ball that slips.
struct SlippingBall : StickingBall {
  static OnFloor force() {
    OnFloor law = StickingBall::force();
    law.friction = {.coefficient = 0.1, .stiffness = 20.0, .damping = 9.0};
    return law;
  }
};
TEST(BristleFriction, OfABallHasTheExactTangentAndLosesPower) {
  auto const holds_for = [](auto& laws) {
    laws.gradient_is_the_derivative_of_the_wrenches();
    laws.action_is_reaction();
    laws.rigid_motion_turns_the_wrenches();
    laws.gives_back_no_more_than_its_potential();
    laws.dissipation_is_the_lost_power();
  };
  ForceLaws<StickingBall> sticking;
  ForceLaws<SlippingBall> slipping;
  holds_for(sticking);
  holds_for(slipping);
}

/// Ball of radius 0.5 m at the height `height`, which moves at `v`; the floor presses with 1000 N/m.
struct Ball {
  OnFloor const law{{.radius = 0.5}, {.stiffness = 1000.0}, {.coefficient = 0.4, .stiffness = 50.0, .damping = 10.0}};
  std::array<Frame<double>, 2> f;

  Ball(double height, Vec3 const& v) {
    f[0].r = {0, 0, height};
    f[0].v = v;
    for (Frame<double>& x : f) x.A = Mat3::Identity();
  }
};
// N = 100 N and μN = 40 N. With z = (0.3, 0.4, 0) m and v = (1, 0, 0) m/s, σ₀z + σ₁v = (25, 20, 0) N is below the limit
// and ż = v. With three times z and v, it is (75, 60, 0) N, so that R = 40 N along (75, 60) and σ₁ż = R − (45, 60).
TEST(BristleFriction, HoldsUpToTheLimitAndSlipsAtTheLimit) {
  Ball const holds(0.4, {1, 0, 0});
  std::array<double, 3> const z{0.3, 0.4, 0.0};
  EXPECT_LT((holds.law.wrenches(holds.f, z, 0.0)[0].f - Vec3(-25, -20, 100)).norm(), 1e-12);
  EXPECT_LT((holds.law.wrenches(holds.f, z, 0.0)[0].m - Vec3(-20 * 0.5, 25 * 0.5, 0)).norm(), 1e-12);
  EXPECT_EQ(holds.law.rates(holds.f, z, 0.0), (std::array<double, 3>{1, 0, 0}));

  Ball const slips(0.4, {3, 0, 0});
  std::array<double, 3> const more{0.9, 1.2, 0.0};
  double const length = std::hypot(75.0, 60.0);
  Vec3 const r(40.0 * 75.0 / length, 40.0 * 60.0 / length, 0);
  EXPECT_LT((slips.law.wrenches(slips.f, more, 0.0)[0].f - Vec3(-r.x(), -r.y(), 100)).norm(), 1e-12);
  auto const rates = slips.law.rates(slips.f, more, 0.0);
  EXPECT_NEAR(rates[0], (r.x() - 45.0) / 10.0, 1e-13);
  EXPECT_NEAR(rates[1], (r.y() - 60.0) / 10.0, 1e-13);
  EXPECT_EQ(rates[2], 0.0);
}
// Without contact, and at a contact point without normal force, ż = −σ₀/σ₁ z.
TEST(BristleFriction, RelaxesWithoutContact) {
  for (double const height : {0.6, 0.5}) {
    Ball const free(height, {1, 2, 3});
    std::array<double, 3> const z{0.3, 0.4, 0.1};
    auto const rates = free.law.rates(free.f, z, 0.0);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_DOUBLE_EQ(rates[i], -5.0 * z[i]);
    for (Wrench<double> const& w : free.law.wrenches(free.f, z, 0.0)) EXPECT_EQ(w.f.norm() + w.m.norm(), 0.0);
    EXPECT_NEAR(free.law.dissipation(free.f, z, 0.0), 50.0 * 5.0 * 0.26, 1e-12);
  }
}

}  // namespace bristle_friction_test
