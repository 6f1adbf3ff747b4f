// Law tests of scalar forces on each coordinate, and their application to joints.
#include <polybody/forces/scalar_force.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/spring_laws.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/applied_wrenches.hpp>
#include <polybody/run/joint_position.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/testing/force_laws.hpp>

#include "support/refusal.hpp"

namespace polybody {
using namespace laws;
namespace scalar_force_test {

double const turn = 2.0 * std::numbers::pi;

/// Maxwell element on a coordinate: Q = −k (x − z), ż = k (x − z)/c.
struct SpringAndDashpot {
  static constexpr int states = 1;
  double stiffness = 80.0, damping = 3.0;
  void check(std::string const&, ScalarUnits const&) const {}
  std::array<double, 1> initial_states() const { return {0.25}; }
  template <StateScalar T>
  T force(T const& x, T const&, std::array<T, 1> const& z, double) const {
    return (z[0] - x) * stiffness;
  }
  template <StateScalar T>
  std::array<T, 1> rates(T const& x, T const&, std::array<T, 1> const& z, double) const {
    return {(x - z[0]) * (stiffness / damping)};
  }
  double potential(double x, std::array<double, 1> const& z, double) const {
    return 0.5 * stiffness * (x - z[0]) * (x - z[0]);
  }
  double dissipation(double x, double, std::array<double, 1> const& z, double) const {
    return stiffness * stiffness * (x - z[0]) * (x - z[0]) / damping;
  }
};
static_assert(ScalarLaw<LinearSpring> && ScalarLaw<SpringAndDashpot> && !ScalarLaw<SpringAndDashpot const*>);
static_assert(HasPotential<OnAngle<LinearSpring>> && HasStatePotential<OnTurns<LinearSpring>>);
static_assert(OnTurns<SpringAndDashpot>::states == 2 && HasStatePotential<OnTurns<SpringAndDashpot>>);

LinearSpring const spring{.stiffness = 80.0, .damping = 3.0, .free = 0.2};
struct AngleCase {
  static auto force() { return on_angle(spring); }
};
struct TurnsCase {
  static auto force() { return on_turns(spring); }
};
struct TranslationCase {
  static auto force() { return on_translation(spring); }
};
struct DistanceCase {
  static auto force() { return on_distance(spring); }
};
struct AngleWithStateCase {
  static auto force() { return on_angle(SpringAndDashpot{}); }
};
struct TurnsWithStateCase {
  static auto force() { return on_turns(SpringAndDashpot{}); }
};
bool const forces_obey[] = {obeys<AngleCase, ForceLaws>("OnAngle"),
                            obeys<TurnsCase, ForceLaws>("OnTurns"),
                            obeys<TranslationCase, ForceLaws>("OnTranslation"),
                            obeys<DistanceCase, ForceLaws>("OnDistance"),
                            obeys<AngleWithStateCase, ForceLaws>("OnAngleWithState"),
                            obeys<TurnsWithStateCase, ForceLaws>("OnTurnsWithState")};

/// Frames of two markers with a common third axis; b is turned by `angle` and displaced by s along the axis.
std::array<Frame<double>, 2> turned_about_common_axis(double angle, double s) {
  Frame<double> const a{.r = {1, 2, 3}, .A = exp_so3<double>(Vec3(0.3, -0.8, 0.5)), .w = {0.1, 0.2, 0.3}};
  Frame<double> b = a;
  b.A = a.A * exp_so3<double>(Vec3(0, 0, angle));
  b.r += a.A.col(2) * s;
  b.w += a.A.col(2) * 0.7;
  return {a, b};
}

TEST(ScalarForce, ActsAboutTheThirdAxis) {
  auto const f = turned_about_common_axis(0.5, 0.0);
  auto const w = on_angle(spring).wrenches<double>(f, 0.0);
  EXPECT_LT((w[1].m + f[0].A.col(2) * (80.0 * 0.3 + 3.0 * 0.7)).norm(), 1e-12);
  EXPECT_EQ(w[0].m, -w[1].m);
  EXPECT_EQ(w[0].f.norm() + w[1].f.norm(), 0.0);
}

// The state selects the number of turns: an angle of 0.5 rad with the state 2π n + 0.4 rad is 0.5 + 2π n.
TEST(ScalarForce, CountsTurnsByItsState) {
  auto const f = turned_about_common_axis(0.5, 0.0);
  for (int const n : {-3, 0, 7}) {
    auto const w = on_turns(spring).wrenches<double>(f, {turn * n + 0.4}, 0.0);
    EXPECT_NEAR(w[1].m.dot(f[0].A.col(2)), -(80.0 * (0.3 + turn * n) + 2.1), 1e-10 * (1 + std::abs(n))) << n;
  }
}

TEST(ScalarForce, ActsAlongTheThirdAxis) {
  auto const f = turned_about_common_axis(0.5, -0.6);
  auto const w = on_translation(spring).wrenches<double>(f, 0.0);
  EXPECT_LT((w[1].f - f[0].A.col(2) * 64.0).norm(), 1e-12);
  EXPECT_LT((w[0].f + w[1].f).norm(), 1e-12);
}

template <class Policy>
struct Disc {
  using Pin = Joint<Revolute, Policy>;
  Model<Bodies<Rigid<>>, Joints<Pin>, Forces<OnTurns<LinearSpring>, OnTurns<SpringAndDashpot>>> model;
  BodyHandle<Rigid<>> body = model.add(Rigid<>(1.0, Mat3(Vec3(1, 1, 2).asDiagonal()), Placement{}), "disc");
  ElementHandle<Pin> pin;
  explicit Disc(Policy const& policy = {})
      : pin(model.connect(Pin{Revolute{.axis = Vec3(0, 0, 1)}, policy}, model.ground().at({0, 0, 0}),
                          body.at(Vec3(0, 0, 0)), "pin")) {}
};

// J θ̈ + k θ = 0 with J = 2 kg m², k = 8 N m/rad: θ = (ω₀/2) sin 2t, which is ±10 rad for ω₀ = 20 rad/s.
template <class Policy>
void oscillates_over_several_turns(Policy const& policy = {}) {
  Disc<Policy> disc(policy);
  disc.model.apply(OnTurns<LinearSpring>{{.stiffness = 8.0}}, disc.pin, "spring");
  State x = disc.model.reference_state();
  disc.model.set_velocity(x, disc.body, Vec3::Zero(), Vec3(0, 0, 20.0));
  TurnCounter turns(disc.model, disc.pin);
  double most = 0.0, off = 0.0;
  for (State const& now : simulate(disc.model, x, GeneralisedAlpha{.rho_inf = 1.0}, {.end_time = 3.2, .step = 1e-3})) {
    double const angle = turns.record(now);
    most = std::max(most, std::abs(angle));
    off = std::max(off, std::abs(angle - 10.0 * std::sin(2.0 * now.t)));
  }
  EXPECT_GT(most, 9.99);
  EXPECT_LT(off, 5e-5);  // the period of the trapezoidal rule is longer by (ω h)²/12: 3.3e-7 · 6.4 rad · 10
}
TEST(ScalarForce, TorsionalPendulumTurnsSeveralTimes) {
  oscillates_over_several_turns<Constraint>();
  oscillates_over_several_turns<JointCoordinates>();
  oscillates_over_several_turns<Penalty>({.stiffness = 1e6, .damping = 1e3});
}

TEST(ScalarForce, BeginsWithTheStatesOfItsLaw) {
  Disc<Constraint> disc;
  auto const force = disc.model.apply(OnTurns<SpringAndDashpot>{}, disc.pin);
  State const x = disc.model.reference_state();
  EXPECT_EQ(disc.model.states(x, force)[0], 0.0);
  EXPECT_EQ(disc.model.states(x, force)[1], 0.25);
}

// The axis of a planar slide is the first axis of its markers: the force along the handle's joint is −k s along it.
TEST(ScalarForce, FollowsTheAxisOfAPlanarSlide) {
  using Slide = Joint<planar::Prismatic, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Slide>, Forces<OnTranslation<LinearSpring>>> model;
  auto const block = model.add(planar::Rigid(1.0, 1.0, Placement::planar(0.6, 0.8)), "block");
  auto const slide =
      model.connect(Slide{{.axis = Vec3(0.6, 0.8, 0)}}, model.ground().at({0, 0, 0}), block.at(Vec2(0, 0)), "slide");
  auto const force = model.apply(OnTranslation<LinearSpring>{{.stiffness = 5.0}}, slide, "spring");
  State const x = model.reference_state();
  EXPECT_LT((applied_wrenches(model, x, force)[1].f - Vec3(-3.0, -4.0, 0.0)).norm(), 1e-14);
  EXPECT_LT((applied_wrenches(model, x, force)[0].f - Vec3(3.0, 4.0, 0.0)).norm(), 1e-14);
}

TEST(ScalarForce, RefusesWrongUse) {
  Disc<Constraint> disc, other;
  OnTurns<LinearSpring> const good{{.stiffness = 1.0}}, bad{{.stiffness = -2.0}};
  disc.model.apply(good, disc.pin, "spring");
  EXPECT_TRUE(has(refusal([&] { disc.model.apply(good, disc.pin, "spring"); }), "Duplicate name of a force"));
  EXPECT_TRUE(has(refusal([&] { disc.model.apply(good, other.pin, "far"); }), "another model"));
  EXPECT_TRUE(has(refusal([&] { disc.model.apply(good, ElementHandle<Disc<Constraint>::Pin>{}); }), "default-constr"));
  EXPECT_EQ(refusal([&] { disc.model.apply(bad, disc.pin, "weak"); }),
            "\"weak\": the spring stiffness must be zero or positive, and finite, but is -2 N m/rad.");
}

TEST(ScalarForce, RefusesAJointWithTwoRotations) {
  using Cross = Joint<Universal, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Cross>, Forces<OnAngle<LinearSpring>>> model;
  auto const body = model.add(Rigid<>(1.0, Mat3::Identity(), Placement{}), "shaft");
  auto const cross = model.connect(Cross{{.first = Vec3(1, 0, 0), .second = Vec3(0, 1, 0)}},
                                   model.ground().at({0, 0, 0}), body.at(Vec3(0, 0, 0)), "cross");
  EXPECT_TRUE(has(refusal([&] { model.apply(OnAngle<LinearSpring>{{.stiffness = 1.0}}, cross, "spring"); }),
                  "\"spring\": joint \"cross\" does not permit exactly one rotation"));
}

}  // namespace scalar_force_test
}  // namespace polybody
