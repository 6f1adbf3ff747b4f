// Friction laws of joints: derivatives, steady sliding, break-away and presliding loops.
#include <polybody/forces/friction_laws.hpp>
#include <polybody/forces/spherical_friction.hpp>

#include <gtest/gtest.h>

#include <numbers>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/testing/force_laws.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace friction_laws_test {

FrictionCurve const stribeck{.sliding = 2.0, .break_away = 3.0, .stribeck_speed = 0.7, .viscous = 0.4};
LuGreFriction const lugre{.curve = stribeck, .stiffness = 5.0, .damping = 0.3};
LuGreFriction const elasto_plastic{.curve = stribeck, .stiffness = 5.0, .damping = 0.3, .elastic_share = 0.8};

struct DryOnAngle {
  static OnAngle<DryFriction> force() { return {{stribeck, 0.1}}; }
};
struct DryOnTranslation {
  static OnTranslation<DryFriction> force() { return {{stribeck, 0.1}}; }
};
/// The bristle is elastic: |z| is less than z_ba = 0.32.
struct ElastoPlasticOnTranslation {
  static OnTranslation<LuGreFriction> force() { return {elasto_plastic}; }
  static std::array<double, 1> states(Numbers& number) { return {0.3 * number()}; }
};
struct Ball {
  static SphericalFriction force() { return {stribeck, 0.1}; }
};
struct StickingBall {
  static SphericalBristleFriction force() { return {.sliding = 9.0, .stiffness = 5.0, .damping = 0.3}; }
};
bool const obeyed[] = {
    obeys<DryOnAngle, ForceLaws>("DryFrictionOnAngle"), obeys<DryOnTranslation, ForceLaws>("DryFrictionOnTranslation"),
    obeys<ElastoPlasticOnTranslation, ForceLaws>("ElastoPlasticFriction"), obeys<Ball, ForceLaws>("SphericalFriction"),
    obeys<StickingBall, ForceLaws>("SphericalBristleFriction")};

template <LuGreFriction const& law, int hundredths>
struct BristleAt {
  static OnAngle<LuGreFriction> force() { return {law}; }
  static std::array<double, 1> states(Numbers&) { return {0.01 * hundredths}; }
};
template <class Case>
void expect_exact_tangent_and_losses() {
  ForceLaws<Case> laws;
  laws.gradient_is_the_derivative_of_the_wrenches();
  laws.action_is_reaction();
  laws.rigid_motion_turns_the_wrenches();
  laws.gives_back_no_more_than_its_potential();
  laws.dissipation_is_the_lost_power();
}
// z_ba = 0.32, and z_ss between 0.4 and 0.6.
TEST(BristleOfAJoint, HasTheExactTangentInEachRegion) {
  expect_exact_tangent_and_losses<BristleAt<lugre, 30>>();
  expect_exact_tangent_and_losses<BristleAt<lugre, -70>>();
  expect_exact_tangent_and_losses<BristleAt<elasto_plastic, 30>>();
  expect_exact_tangent_and_losses<BristleAt<elasto_plastic, 38>>();
  expect_exact_tangent_and_losses<BristleAt<elasto_plastic, -70>>();
}

// Stribeck curve at v = 0.7, the Stribeck speed: g = 2 + e⁻¹, and the viscous part 0.28.
TEST(FrictionCurve, IsTheSteadyFriction) {
  double const expected = 2.0 + std::exp(-1.0) + 0.28, steady = (2.0 + std::exp(-1.0)) / 5.0;
  for (LuGreFriction const& law : {lugre, elasto_plastic})
    for (double const way : {1.0, -1.0}) {
      EXPECT_NEAR(law.rates<double>(0.0, 0.7 * way, {steady * way}, 0.0)[0], 0.0, 1e-15);
      EXPECT_NEAR(law.force<double>(0.0, 0.7 * way, {steady * way}, 0.0), -expected * way, 1e-14);
    }
  DryFriction const dry{stribeck, 1e-9};
  EXPECT_NEAR(dry.force<double>(0.0, 0.7, 0.0), -expected, 1e-14);
  EXPECT_NEAR(dry.force<double>(0.0, -0.7, 0.0), expected, 1e-14);
  EXPECT_EQ(dry.force<double>(0.0, 0.0, 0.0), 0.0);
}

/// Parameters of the stick-slip example [Canudas de Wit, Olsson, Åström & Lischinsky 1995].
LuGreFriction example(double elastic_share) {
  return {.curve = {.sliding = 1.0, .break_away = 1.5, .stribeck_speed = 1e-3, .viscous = 0.4},
          .stiffness = 1e5,
          .damping = std::sqrt(1e5),
          .elastic_share = elastic_share};
}

// Presliding loop: friction in the motion x = A sin t with A = 1.2e-5 m, at multiples of π/4 over two periods. The
// reference is tests/cases/friction_laws_reference.py.
TEST(LuGreFriction, HasThePreslidingLoopOfTheReference) {
  struct Loop {
    double share;
    std::vector<double> friction;
  };
  for (Loop const& loop : {Loop{0.0,
                                {0.6495654328, 0.8260000605, 0.3368322074, -0.457507345, -0.9074437936, -1.030375962,
                                 -0.4982269069, 0.3659100068, 0.8553817158, 0.9891152913, 0.4656435469, -0.3844022438,
                                 -0.86589233, -0.9974452507, -0.4722216772, 0.3806689166}},
                           Loop{0.8,
                                {0.8510905261, 1.14409112, 0.7899325865, -0.05970840847, -0.905945287, -1.177286522,
                                 -0.8231279888, 0.02651300608, 0.8735476286, 1.158044444, 0.803885905, -0.04575508996,
                                 -0.8923999432, -1.169361615, -0.8152030766, 0.03443791829}}}) {
    LuGreFriction const law = example(loop.share);
    auto const speed = [](double t) { return 1.2e-5 * std::cos(t); };
    auto const rate = [&](double t, double z) { return law.rates<double>(0.0, speed(t), {z}, t)[0]; };
    double z = 0.0;
    int const each = 20000;
    double const h = 0.25 * std::numbers::pi / each;
    for (std::size_t k = 0; k < 16; ++k) {
      for (int i = 0; i < each; ++i) {  // classical Runge–Kutta method
        double const t = (double(k) * each + i) * h, k1 = rate(t, z), k2 = rate(t + 0.5 * h, z + 0.5 * h * k1),
                     k3 = rate(t + 0.5 * h, z + 0.5 * h * k2), k4 = rate(t + h, z + h * k3);
        z += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
      }
      double const t = double(k + 1) * each * h;
      EXPECT_NEAR(-law.force<double>(0.0, speed(t), {z}, t), loop.friction[k], 1e-7) << loop.share << ' ' << k;
    }
  }
}

/// Force of a spring whose other end moves at `speed`, and a force that grows from zero to `load` within ten
/// seconds.
struct Pull {
  static constexpr bool is_load = true;
  double stiffness = 0.0, speed = 0.0, load = 0.0;
  void check(std::string const&, ScalarUnits const&) const {}
  template <StateScalar T>
  T force(T const& x, T const&, double t) const {
    return (x * -1.0 + speed * t) * stiffness + load * std::min(0.1 * t, 1.0);
  }
};
/// Mass of 1 kg on a slide.
template <class Friction>
struct PulledMass {
  using Slide = Joint<Prismatic, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Slide>, Forces<OnTranslation<Friction>, OnTranslation<Pull>>> model;
  BodyHandle<Rigid<>> body = model.add(Rigid<>(1.0, Mat3(Mat3::Identity()), Placement{}));

  PulledMass(Friction const& friction, Pull const& pull) {
    auto const slide = model.connect(Slide{{.axis = Vec3(1, 0, 0)}, {}}, model.ground().at({0, 0, 0}),
                                     body.at(Vec3(0, 0, 0)), "slide");
    model.apply(OnTranslation<Friction>{friction}, slide, "friction");
    model.apply(OnTranslation<Pull>{pull}, slide, "pull");
  }
};
// Stick-slip: positions at multiples of 5 s, from tests/cases/friction_laws_reference.py.
TEST(LuGreFriction, HasTheStickSlipOfTheReference) {
  struct Run {
    double share;
    std::vector<double> positions;
  };
  for (Run const& run : {Run{0.0, {1.645918713e-05, 0.6275831289, 0.918279706, 1.272596412}},
                         Run{0.8, {1.008087347e-05, 0.6286058064, 0.9106940805, 1.275882806}}}) {
    PulledMass<LuGreFriction> const mass(example(run.share), {.stiffness = 2.0, .speed = 0.1});
    State x = mass.model.reference_state();
    for (std::size_t k = 0; k < 4; ++k) {
      simulate(mass.model, x, Radau{}, {.end_time = 5.0 * double(k + 1), .step = 1e-3}).run();
      EXPECT_NEAR(x.q[0], run.positions[k], 1e-5) << run.share << ' ' << k;
    }
  }
}
// The break-away force is F_s = 1.5 N. Below it, the displacement is that of the bristle, of the order of F_s/σ₀.
TEST(LuGreFriction, BreaksAwayAtTheStaticFriction) {
  for (double const share : {0.0, 0.8})
    for (double const load : {1.45, 1.55}) {
      PulledMass<LuGreFriction> const mass(example(share), {.load = load});
      State x = mass.model.reference_state();
      simulate(mass.model, x, Radau{}, {.end_time = 12.0, .step = 2e-3}).run();
      EXPECT_EQ(x.q[0] < 1e-3, load < 1.5) << share << ' ' << load << ' ' << x.q[0];
      EXPECT_EQ(x.q[0] > 0.1, load > 1.5) << share << ' ' << load << ' ' << x.q[0];
    }
}
// Load of 0.7 + 0.09 sin t N below the elastic limit 0.8 F_c = 0.8 N: the elasto-plastic bristle returns to the same
// position. LuGre friction drifts by more than 1e-6 m.
struct Oscillating {
  static constexpr bool is_load = true;
  void check(std::string const&, ScalarUnits const&) const {}
  template <StateScalar T>
  T force(T const& x, T const&, double t) const {
    return x * 0.0 + 0.7 * std::min(t, 1.0) + 0.09 * std::sin(20.0 * std::numbers::pi * t);
  }
};
TEST(LuGreFriction, DriftsUnlessItIsElastoPlastic) {
  for (double const share : {0.0, 0.8}) {
    using Slide = Joint<Prismatic, Constraint>;
    Model<Bodies<Rigid<>>, Joints<Slide>, Forces<OnTranslation<LuGreFriction>, OnTranslation<Oscillating>>> model;
    auto const body = model.add(Rigid<>(1.0, Mat3(Mat3::Identity()), Placement{}));
    auto const slide = model.connect(Slide{{.axis = Vec3(1, 0, 0)}, {}}, model.ground().at({0, 0, 0}),
                                     body.at(Vec3(0, 0, 0)), "slide");
    model.apply(OnTranslation<LuGreFriction>{example(share)}, slide, "friction");
    model.apply(OnTranslation<Oscillating>{}, slide, "load");
    State x = model.reference_state();
    simulate(model, x, Radau{}, {.end_time = 3.0, .step = 2e-3}).run();
    double const loaded = x.q[0];
    simulate(model, x, Radau{}, {.end_time = 13.0, .step = 2e-3}).run();
    EXPECT_EQ(std::abs(x.q[0] - loaded) < 1e-9, share > 0.0) << x.q[0] - loaded;
    EXPECT_EQ(x.q[0] - loaded > 1e-6, share == 0.0) << x.q[0] - loaded;
  }
}

// A cylindrical joint has two laws: v = v₀ − F t/m and ω = ω₀ − M t/J. The part below the slip speeds is omitted.
TEST(DryFriction, BrakesBothMotionsOfACylindricalJoint) {
  using Sleeve = Joint<Cylindrical, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Sleeve>, Forces<OnAngle<DryFriction>, OnTranslation<DryFriction>>> model;
  auto const body = model.add(Rigid<>(2.0, Mat3(0.5 * Mat3::Identity()), Placement{}));
  auto const sleeve = model.connect(Sleeve{{.axis = Vec3(0, 1, 0)}, {}}, model.ground().at({0, 0, 0}),
                                    body.at(Vec3(0, 0, 0)), "sleeve");
  model.apply(OnAngle<DryFriction>{{{.sliding = 0.3}, 1e-6}}, sleeve, "moment");
  model.apply(OnTranslation<DryFriction>{{{.sliding = 0.8}, 1e-6}}, sleeve, "force");
  State x = model.reference_state();
  model.set_velocity(x, body, {0, 3, 0}, {0, -2, 0});
  simulate(model, x, Radau{}, {.end_time = 1.0, .step = 1e-2}).run();
  EXPECT_NEAR(x.v[1], 3.0 - 0.8 / 2.0, 1e-9);
  EXPECT_NEAR(x.v[4], -2.0 + 0.3 / 0.5, 1e-9);
}
// A ball in a spherical joint stops after J ω₀/M along a fixed axis. The bristle then holds it.
TEST(SphericalFriction, StopsABallAlongItsAngularVelocity) {
  auto const rate_at = [](auto const& friction, double end) {
    using Ball = Joint<Spherical, Constraint>;
    Model<Bodies<Rigid<>>, Joints<Ball>, Forces<std::decay_t<decltype(friction)>>> model;
    auto const body = model.add(Rigid<>(2.0, Mat3(0.5 * Mat3::Identity()), Placement{}));
    auto const a = model.ground().at({0, 0, 0});
    auto const b = body.at(Vec3(0, 0, 0));
    model.connect(Ball{}, a, b);
    model.apply(friction, a, b, "friction");
    State x = model.reference_state();
    model.set_velocity(x, body, {0, 0, 0}, {2, -1, 2});
    simulate(model, x, Radau{}, {.end_time = end, .step = 1e-2}).run();
    return Vec3(x.v.segment<3>(3));
  };
  Vec3 const expected = Vec3(2, -1, 2) * (1.0 - 0.6 / 0.5 * 1.0 / 3.0);
  EXPECT_LT((rate_at(SphericalFriction{{.sliding = 0.6}, 1e-6}, 1.0) - expected).norm(), 1e-8);
  SphericalBristleFriction const bristle{.sliding = 0.6, .stiffness = 100.0, .damping = 10.0};
  EXPECT_LT((rate_at(bristle, 1.0) - expected).norm(), 1e-8);
  EXPECT_LT(rate_at(bristle, 6.0).norm(), 1e-6);
}

TEST(FrictionLaws, RefuseInvalidParameters) {
  ScalarUnits const& units = detail::TranslationBetween::units;
  auto const message = [&](auto const& law) { return refusal([&] { law.check("\"f\"", units); }); };
  EXPECT_EQ(message(FrictionCurve{.sliding = -1.0}),
            "\"f\": the sliding friction must be zero or positive, and finite, but is -1 N.");
  EXPECT_EQ(message(FrictionCurve{.sliding = 1.0, .break_away = 0.5, .stribeck_speed = 1.0}),
            "\"f\": the break-away friction must be at least the sliding friction, 1 N, but is 0.5 N.");
  EXPECT_EQ(message(FrictionCurve{.sliding = 1.0, .break_away = 2.0}),
            "\"f\": the Stribeck speed of the friction must be positive and finite, but is 0 m/s.");
  EXPECT_EQ(message(FrictionCurve{.sliding = 1.0, .viscous = -2.0}),
            "\"f\": the viscous friction must be zero or positive, and finite, but is -2 N s/m.");
  EXPECT_EQ(message(DryFriction{{.sliding = 1.0}, 0.0}),
            "\"f\": the slip speed of the friction must be positive and finite, but is 0 m/s.");
  EXPECT_EQ(message(LuGreFriction{.curve = {.sliding = 0.0}, .stiffness = 1.0, .damping = 1.0}),
            "\"f\": the sliding friction must be positive and finite, but is 0 N.");
  EXPECT_EQ(message(LuGreFriction{.curve = {.sliding = 1.0}, .stiffness = 0.0, .damping = 1.0}),
            "\"f\": the bristle stiffness of the friction must be positive and finite, but is 0 N/m.");
  EXPECT_EQ(message(LuGreFriction{.curve = {.sliding = 1.0}, .stiffness = 1.0, .damping = -1.0}),
            "\"f\": the bristle damping of the friction must be zero or positive, and finite, but is -1 N s/m.");
  EXPECT_EQ(message(LuGreFriction{.curve = {.sliding = 1.0}, .stiffness = 1.0, .damping = 1.0, .elastic_share = 1.0}),
            "\"f\": the elastic share of the friction must lie in [0, 1), but is 1.");
  EXPECT_EQ(refusal([] { SphericalBristleFriction{.sliding = 1.0, .stiffness = -1.0, .damping = 1.0}.check("\"f\""); }),
            "\"f\": the bristle stiffness of the friction must be positive and finite, but is -1 N m/rad.");
}
}  // namespace friction_laws_test
