// Wrenches of force elements, and powers of force elements and drives.
#include <polybody/run/probe.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/contact.hpp>
#include <polybody/forces/contact_group.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/run/accelerations.hpp>
#include <polybody/run/simulate.hpp>

#include "support/refusal.hpp"

using namespace polybody;

namespace applied_wrenches_test {

// Spring–damper between the ground and a moving point: N = k (l − l₀) + c l̇, along d/l, opposite on the ends.
TEST(AppliedWrenches, OfASpringDamperAreThoseOfTheHandCalculation) {
  Model<Bodies<planar::Rigid>, Joints<>, Forces<SpringDamper, PointMoment<>>> model;
  auto const body = model.add(planar::Rigid(1.0, 1.0, Placement::planar(3.0, 4.0)), "body");
  auto const first = model.apply(SpringDamper{.stiffness = 1.0, .free_length = 5.0}, model.ground().at({0, 0, 0}),
                                 body.centre(), "relaxed");
  auto const spring = model.apply(SpringDamper{.stiffness = 20.0, .damping = 2.0, .free_length = 4.5},
                                  model.ground().at({0, 0, 0}), body.centre(), "spring");
  auto const motor = model.apply(PointMoment<>{.moment = {0, 0, 7.0}}, body.at(Vec2(0.1, 0)), "motor");
  State x = model.reference_state();
  x.v << 1.0, 2.0, 3.0;  // l̇ = 0.6 + 1.6 = 2.2 m/s
  double const tension = 20.0 * 0.5 + 2.0 * 2.2;
  auto const w = applied_wrenches(model, x, spring);
  EXPECT_LT((w[0].f - tension * Vec3(0.6, 0.8, 0)).norm(), 1e-14);
  EXPECT_LT((w[1].f + w[0].f).norm(), 1e-14);
  EXPECT_EQ(w[0].m.norm() + w[1].m.norm(), 0.0);
  EXPECT_NEAR(power(model, x, spring), -tension * 2.2, 1e-13);
  EXPECT_EQ(applied_wrenches(model, x, first)[1].f.norm(), 0.0);
  EXPECT_EQ(power(model, x, first), 0.0);
  EXPECT_EQ(applied_wrenches(model, x, motor)[0].m, Vec3(0, 0, 7.0));
  EXPECT_EQ(power(model, x, motor), 21.0);
}

// The elongation of the damper of a Maxwell element is a state: N = k (l − l₀ − z).
TEST(AppliedWrenches, OfAnElementWithStatesUseThem) {
  Model<Bodies<planar::Rigid>, Joints<>, Forces<MaxwellElement>> model;
  auto const body = model.add(planar::Rigid(1.0, 1.0, Placement::planar(2.0, 0.0)), "body");
  auto const element = model.apply(MaxwellElement{.stiffness = 10.0, .damping = 5.0, .free_length = 2.0},
                                   model.ground().at({0, 0, 0}), body.centre(), "strut");
  State x = model.reference_state();
  x.q[0] = 2.5;
  model.states(x, element)[0] = 0.2;
  auto const w = applied_wrenches(model, x, element);
  EXPECT_LT((w[0].f - Vec3(10.0 * (2.5 - 2.0 - 0.2), 0, 0)).norm(), 1e-14);
  EXPECT_LT((w[1].f + w[0].f).norm(), 1e-14);
}

// A contact group has one wrench for each marker: the balls, then the floor, with the sum of their forces.
TEST(AppliedWrenches, OfAContactGroupAreTheSumsOfItsPairs) {
  using OnPlane = Contact<SphereOnPlane>;
  Model<Bodies<Rigid<>>, Joints<>, Forces<ContactGroup<OnPlane>>> model;
  Mat3 const inertia = Mat3::Identity();
  auto const a = model.add(Rigid<>(1.0, inertia, Placement::at({0, 0, 0.09})), "a");
  auto const b = model.add(Rigid<>(1.0, inertia, Placement::at({2, 0, 0.07})), "b");
  auto const group = model.apply(ContactGroup<OnPlane>{}, std::vector{a.centre(), b.centre()}, "balls");
  model.add_partner(group, OnPlane{{.radius = 0.1}, {.stiffness = 2e4, .damping = 15.0}, {}},
                    model.ground().at({1, 0, 0}), "floor");
  auto const w = applied_wrenches(model, model.reference_state(), group);
  ASSERT_EQ(w.size(), 3u);
  EXPECT_LT((w[0].f - Vec3(0, 0, 2e4 * 0.01)).norm(), 1e-9);
  EXPECT_LT((w[1].f - Vec3(0, 0, 2e4 * 0.03)).norm(), 1e-9);
  EXPECT_LT((w[2].f + w[0].f + w[1].f).norm(), 1e-9);
  EXPECT_NEAR(w[2].m[1], 200.0 * -1.0 + 600.0 * 1.0, 1e-9);  // r × (−f) about (1, 0, 0): −(x − 1) (−f)
}

TEST(AppliedWrenches, RefuseHandlesOfOtherModels) {
  Model<Bodies<planar::Rigid>, Joints<>, Forces<SpringDamper>> model, other;
  auto const body = other.add(planar::Rigid(1.0, 1.0), "body");
  auto const spring = other.apply(SpringDamper{.stiffness = 1.0, .free_length = 5.0}, other.ground().at({0, 0, 0}),
                                  body.centre(), "spring");
  model.add(planar::Rigid(1.0, 1.0), "body");
  State const x = model.reference_state();
  EXPECT_TRUE(has(refusal([&] { (void)applied_wrenches(model, x, spring); }), "handle of another model"));
  EXPECT_TRUE(has(refusal([&] { (void)power(model, x, spring); }), "handle of another model"));
  model.add(planar::Rigid(1.0, 1.0), "second");
  State const longer = model.reference_state();
  EXPECT_TRUE(has(refusal([&] { (void)applied_wrenches(other, longer, spring); }), "does not fit"));
}

/// Rod on a pin that a drive turns at constant rate under gravity.
template <class Policy>
struct DrivenRod {
  struct Law {
    Motion operator()(double t) const { return {5.0 * t, 5.0, 0.0}; }
  };
  using Pin = Joint<planar::Revolute, Constraint>;
  using Drive = Joint<PrescribedAngle<Law>, Policy>;
  Model<Bodies<planar::Rigid>, Joints<Pin, Drive>> model{Gravity{0, -9.81, 0}};
  BodyHandle<planar::Rigid> rod = model.add(planar::Rigid(2.0, 0.4, Placement::planar(0.6, 0)), "rod");
  ElementHandle<Pin> pin = model.connect(Pin{}, model.ground().at({0, 0, 0}), rod.at(Vec2(-0.6, 0)), "pin");
  ElementHandle<Drive> drive;
  State x;

  explicit DrivenRod(Policy const& policy)
      : drive(model.connect(Drive{{.law = Law{}}, policy}, model.ground().at({0, 0, 0}), rod.at(Vec2(-0.6, 0)),
                            "motor")) {
    x = model.reference_state();
    model.set_velocity(x, rod, Vec3::Zero(), {0, 0, 5.0});
  }
};

// At constant rate the drive supplies the power of the weight: P = m g c ω cos ωt, M = P/ω.
TEST(Power, OfADriveAtConstantRateIsThatOfTheWeight) {
  DrivenRod<Constraint> d({});
  for (State const& now : simulate(d.model, d.x, RungeKutta4<Projection>{}, {.end_time = 1.0, .step = 2e-3})) {
    double const exact = 2.0 * 9.81 * 0.6 * 5.0 * std::cos(5.0 * now.t);
    EXPECT_NEAR(power(d.model, now, d.drive), exact, 1e-6);
    EXPECT_NEAR(5.0 * reaction(d.model, now, d.drive).m[2], exact, 1e-6);
    EXPECT_EQ(power(d.model, now, d.pin), 0.0);
  }
}

// A compliant drive supplies λ ψ̇. Its damper takes c times the square of the slip, and the rest is stored.
TEST(Power, OfACompliantDriveIncludesItsSpringAndDamper) {
  DrivenRod<Penalty> d({.stiffness = 1e4, .damping = 50.0});
  double const h = 1e-4;
  std::vector<double> energies, powers;
  for (State const& now : simulate(d.model, d.x, RungeKutta4<Projection>{}, {.end_time = 0.05, .step = h})) {
    double const slip = now.v[2] - 5.0;
    energies.push_back(energy(d.model, now).total());
    powers.push_back(power(d.model, now, d.drive) - 50.0 * slip * slip);
  }
  for (std::size_t i = 1; i + 1 < energies.size(); ++i)
    EXPECT_NEAR(powers[i], (energies[i + 1] - energies[i - 1]) / (2 * h), 0.02) << i;
}

// Slider-crank with a crank of 0.1 m and a rod of 0.4 m, driven with increasing speed against a damped spring: drive
// and spring supply the rate of the kinetic energy and of the potential of gravity.
TEST(Power, OfADrivenSliderCrankIsTheRateOfItsEnergy) {
  struct Law {
    Motion operator()(double t) const { return {20.0 * t + 10.0 * t * t, 20.0 + 20.0 * t, 20.0}; }
  };
  struct Still {
    Motion operator()(double) const { return {}; }
  };
  using Pin = Joint<planar::Revolute, Constraint>;
  using Drive = Joint<PrescribedAngle<Law>, Constraint>;
  using Guide = Joint<PrescribedTranslation<Still>, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Pin, Drive, Guide>, Forces<SpringDamper>> model{Gravity{0, -9.81, 0}};
  auto const crank = model.add(planar::Rigid(0.5, 1e-3, Placement::planar(0.05, 0)), "crank");
  auto const rod = model.add(planar::Rigid(0.8, 1e-2, Placement::planar(0.3, 0)), "rod");
  auto const ground = model.ground().at({0, 0, 0});
  model.connect(Pin{}, ground, crank.at(Vec2(-0.05, 0)), "bearing");
  model.connect(Pin{}, crank.at(Vec2(0.05, 0)), rod.at(Vec2(-0.2, 0)), "crank pin");
  auto const guide = model.connect(Guide{{.law = Still{}, .axis = {0, 1, 0}}, {}}, ground, rod.at(Vec2(0.2, 0)));
  auto const drive = model.connect(Drive{{.law = Law{}}, {}}, ground, crank.at(Vec2(-0.05, 0)), "motor");
  auto const spring = model.apply(SpringDamper{.stiffness = 300.0, .damping = 30.0, .free_length = 0.4},
                                  model.ground().at({1, 0, 0}), rod.at(Vec2(0.2, 0)), "load");
  State x = model.reference_state();
  model.set_velocity(x, crank, Vec3::Zero(), {0, 0, 20.0});
  double const h = 1e-4;
  std::vector<double> kinetic, powers;
  double largest = 0.0;
  for (State const& now : simulate(model, x, RungeKutta4<Projection>{}, {.end_time = 0.2, .step = h})) {
    Energy const e = energy(model, now);
    kinetic.push_back(e.kinetic + e.gravity);
    powers.push_back(power(model, now, drive) + power(model, now, spring));
    EXPECT_EQ(power(model, now, guide), 0.0);
    largest = std::max(largest, std::abs(powers.back()));
  }
  EXPECT_GT(largest, 20.0);
  for (std::size_t i = 1; i + 1 < kinetic.size(); ++i)
    EXPECT_NEAR(powers[i], (kinetic[i + 1] - kinetic[i - 1]) / (2 * h), 1e-4 * largest) << i;
}

}  // namespace applied_wrenches_test
