// Energies, momenta and other observations of a single state.
#include <polybody/run/probe.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/rigid/rigid_euler_parameters.hpp>
#include <polybody/run/problem_size.hpp>

#include "support/mixed_models.hpp"
#include "support/refusal.hpp"

using namespace polybody;

namespace observe_test {

/// Rod of 3 kg and 2 m, 0.5 m from the origin, between two springs.
struct Rod {
  using M = Model<Bodies<planar::Rigid>, Joints<>, Forces<SpringDamper>>;
  M model{Gravity{0, -10.0, 0}};
  BodyHandle<planar::Rigid> rod = model.add(planar::Rigid(3.0, 1.0, Placement::planar(0.5, 0.25)), "rod");
  State x;

  Rod() {
    model.apply(SpringDamper{.stiffness = 8.0, .free_length = 0.25}, model.ground().at({0.5, -0.75, 0}),
                rod.at(Vec2(0, 0)), "spring");
    x = model.reference_state();
    model.set_velocity(x, rod, {1.0, 2.0, 0}, {0, 0, -4.0});
  }
};

// Velocity of the middle: (1, 2) + ω × (0.5, 0.25) = (1 + 1, 2 − 2).
TEST(Energy, IsThatOfTheHandCalculation) {
  Rod const r;
  Energy const e = energy(r.model, r.x);
  EXPECT_NEAR(e.kinetic, 0.5 * 3.0 * 4.0 + 0.5 * 1.0 * 16.0, 1e-13);
  EXPECT_NEAR(e.gravity, 3.0 * 10.0 * 0.25, 1e-13);
  EXPECT_NEAR(e.forces, 0.5 * 8.0 * 0.75 * 0.75, 1e-13);
  EXPECT_EQ(e.strain, 0.0);
  EXPECT_EQ(e.joints, 0.0);
  EXPECT_NEAR(e.total(), e.kinetic + e.potential(), 1e-13);
}

TEST(Momentum, IsThatOfTheHandCalculation) {
  Rod const r;
  Momentum const p = momentum(r.model, r.x);
  EXPECT_LT((p.linear - Vec3(6.0, 0.0, 0.0)).norm(), 1e-13);
  // r × m v + I ω = 0.5 · 0 − 0.25 · 6 − 4
  EXPECT_LT((p.angular - Vec3(0, 0, -5.5)).norm(), 1e-13);
}

// The marker at the centre of mass, and mass, position and velocity of the centre of mass of one body and of all.
TEST(CentreOfMass, OfRigidBodiesIsThatOfTheHandCalculation) {
  Model<Bodies<planar::Rigid>, Joints<>> plane;
  auto const a = plane.add(planar::Rigid(3.0, 1.0, Placement::planar(0.5, 0.25, 0.7)), "a");
  auto const b = plane.add(planar::Rigid(1.0, 2.0, Placement::planar(-1.5, 4.25)), "b");
  State x = plane.reference_state();
  x.v << 1.0, 2.0, 5.0, -3.0, 6.0, 7.0;
  EXPECT_LT((position(plane, x, a.centre()) - Vec3(0.5, 0.25, 0)).norm(), 1e-15);
  CentreOfMass const one = centre_of_mass(plane, x, b), all = centre_of_mass(plane, x);
  EXPECT_NEAR(one.mass, 1.0, 1e-14);
  EXPECT_LT((one.position - Vec3(-1.5, 4.25, 0)).norm(), 1e-14);
  EXPECT_LT((one.velocity - Vec3(-3.0, 6.0, 0)).norm(), 1e-14);
  EXPECT_NEAR(all.mass, 4.0, 1e-14);
  EXPECT_LT((all.position - Vec3(0.0, 1.25, 0)).norm(), 1e-14);
  EXPECT_LT((all.velocity - Vec3(0.0, 3.0, 0)).norm(), 1e-14);

  Model<Bodies<Rigid<>, Rigid<EulerParameters>>, Joints<>> space;
  Mat3 const inertia = Vec3(1.0, 2.0, 2.5).asDiagonal();
  auto const c = space.add(Rigid<>(2.0, inertia, Placement::at({1, 2, 3}, {0.3, -0.2, 0.5})), "c");
  auto const d = space.add(Rigid<EulerParameters>(6.0, inertia, Placement::at({-1, 0, 1}, {0.1, 0.4, 0.5})), "d");
  State const y = space.reference_state();
  EXPECT_LT((position(space, y, c.centre()) - Vec3(1, 2, 3)).norm(), 1e-15);
  EXPECT_LT((position(space, y, d.centre()) - Vec3(-1, 0, 1)).norm(), 1e-15);
  EXPECT_NEAR(centre_of_mass(space, y, d).mass, 6.0, 1e-13);
  EXPECT_LT((centre_of_mass(space, y, d).position - Vec3(-1, 0, 1)).norm(), 1e-13);
  EXPECT_LT((centre_of_mass(space, y).position - Vec3(-0.5, 0.5, 1.5)).norm(), 1e-13);
  EXPECT_TRUE(has(refusal([&] { (void)centre_of_mass(space, x); }), "does not fit"));
  EXPECT_TRUE(has(refusal([&] { (void)centre_of_mass(plane, x, Rod().rod); }), "handle of another model"));
}

// The potential of gravity is −m g·r, so three fields give the centre of mass of a deformed body in another way. The
// velocity is the linear momentum divided by the mass.
TEST(CentreOfMass, OfFlexibleBodiesAgreesWithTheirPotential) {
  auto const model_in = [](Vec3 const& g) {
    Model<Bodies<AncfCable<>, Lrvf<>>, Joints<>> model{Gravity{g}};
    Bar bar{.length = 1.0,
            .constants =
                BarConstants{.EA = 90, .EI = 4, .mass_per_length = 2.0, .GA = 30, .GJ = 3, .rotary_inertia = 0.05}};
    auto const cable = model.add(AncfCable<>::from(bar, 2), "cable");
    bar.placement = Placement::at({0.3, -0.4, 0.7}, {0.2, 0.5, -0.3});
    auto const beam = model.add(Lrvf<>::from(bar, 3), "beam");
    return std::tuple(std::move(model), cable, beam);
  };
  auto const [model, cable, beam] = model_in(Vec3::Zero());
  State const x = scrambled(model);
  CentreOfMass const all = centre_of_mass(model, x), one = centre_of_mass(model, x, cable),
                     two = centre_of_mass(model, x, beam);
  EXPECT_NEAR(all.mass, 4.0, 1e-12);
  EXPECT_NEAR(one.mass, 2.0, 1e-12);
  for (int i = 0; i < 3; ++i) {
    auto const [heavy, same_cable, same_beam] = model_in(Vec3::Unit(i));
    EXPECT_NEAR(energy(heavy, x).gravity, -4.0 * all.position[i], 1e-12);
  }
  EXPECT_LT((all.position - 0.5 * (one.position + two.position)).norm(), 1e-13);
  EXPECT_LT((all.velocity - momentum(model, x).linear / 4.0).norm(), 1e-13);
  State const straight = model.reference_state();
  EXPECT_LT((centre_of_mass(model, straight, cable).position - Vec3(0.5, 0, 0)).norm(), 1e-13);
}

// Pin with a violation of 0.25 m on a rotating and moving bar: ‖Φ‖, ‖Φ̇‖ and ‖Φ̈‖ by the largest entry.
TEST(Violation, IsThatOfTheHandCalculation) {
  Model<Bodies<planar::Rigid>, Joints<Joint<planar::Revolute, Constraint>>> model;
  auto const bar = model.add(planar::Rigid(1.0, 1.0), "bar");
  model.connect(Joint<planar::Revolute, Constraint>{}, model.ground().at({-1, 0, 0}), bar.at(Vec2(-1, 0)), "pin");
  State x = model.reference_state();
  x.q[1] = 0.25;
  x.v << 0.5, 0.0, 3.0;  // velocity of its end: (0.5, −3)
  x.a << 1.0, 2.0, 0.0;  // its acceleration: (1 + 9, 2)
  Violation const v = largest_violation(model, x);
  EXPECT_NEAR(v.position, 0.25, 1e-15);
  EXPECT_NEAR(v.velocity, 3.0, 1e-14);
  EXPECT_NEAR(v.acceleration, 10.0, 1e-14);
  State const other = Rod().x;
  EXPECT_TRUE(has(refusal([&] { (void)largest_violation(model, other); }), "does not fit"));
}

// Without damping, drives and dead loads the power of the residual forces is the rate of the potential:
// d(potential)/dt = v·(M a − r)|… = −v·f, by differences along q ⊞ v t.
TEST(Energy, PotentialFallsByThePowerOfTheForces) {
  using M =
      Model<Bodies<planar::Lrvf, planar::AncfCable<>>, Joints<Joint<planar::Weld, Penalty>>, Forces<SpringDamper>>;
  M model{Gravity{0.3, -9.81, 0}};
  Bar const bar{.length = 1.0,
                .constants = BarConstants{.EA = 90, .EI = 4, .mass_per_length = 2.0, .GA = 30, .rotary_inertia = 0.05}};
  auto const beam = model.add(planar::Lrvf::from(bar, 2));
  auto const cable = model.add(planar::AncfCable<>::from(bar, 2));
  model.connect(Joint<planar::Weld, Penalty>{{}, {.stiffness = 50.0, .damping = 0.0}}, beam.at(0.8), cable.at(0.1));
  model.apply(SpringDamper{.stiffness = 40.0, .free_length = 0.6}, cable.at(1.0), model.ground().at({0, 1, 0}));
  State const x = scrambled(model);
  System system(model);
  auto const potential = [&](double s) {
    State y = x;
    system.plus(x.q, s * x.v, y.q);
    return energy(model, y).potential();
  };
  double const h = 1e-4;
  double const rate = (8.0 * (potential(h) - potential(-h)) - (potential(2 * h) - potential(-2 * h))) / (12.0 * h);
  // without velocities and accelerations the residual is minus the force of the potential
  system.evaluate(x.q, VecX::Zero(model.velocities()), 0.0);
  VecX r = VecX::Zero(model.velocities());
  system.residual(VecX::Zero(model.velocities()), VecX::Zero(0), r);
  EXPECT_NEAR(r.dot(x.v), rate, 1e-8 * std::abs(rate));
}

TEST(Reaction, TurnsIntoTheAxesOfTheJoint) {
  auto const model = MixedSpace::model(1.0);
  State const x = scrambled(model);
  ElementHandle<MixedSpace::Pin> const pin{model.serial(), 0, "pin"};
  Wrench<> const world = reaction(model, x, pin), local = reaction(model, x, pin, ReactionAxes::joint);
  EXPECT_NEAR(world.f.norm(), local.f.norm(), 1e-12);
  EXPECT_NEAR(world.m.norm(), local.m.norm(), 1e-12);
  EXPECT_GT((world.f - local.f).norm(), 1e-3);
}

TEST(Observe, ReadsPartsOfTheState) {
  Rod const r;
  auto const q = coordinates_of(r.model, r.x, r.rod), v = velocities_of(r.model, r.x, r.rod);
  ASSERT_EQ(q.size(), 3u);
  EXPECT_EQ(q[0], 0.5);
  EXPECT_EQ(q[1], 0.25);
  EXPECT_NEAR(v[0], 2.0, 1e-15);
  EXPECT_NEAR(v[2], -4.0, 1e-15);
  EXPECT_EQ(position(r.model, r.x, r.model.ground().at({1, 2, 3})), Vec3(1, 2, 3));
}

// Wallin 2016, Table 3.4: a unit quaternion counts as four coordinates and one constraint.
TEST(ProblemSize, CountsAsTheThesisDoes) {
  auto const space = problem_size(MixedSpace::model(0.0));
  EXPECT_EQ(space.coordinates, 14);
  EXPECT_EQ(space.velocities, 12);
  EXPECT_EQ(space.rows, 5);
  EXPECT_EQ(space.constraints, 7);
  EXPECT_EQ(space.degrees_of_freedom, 7);
  auto const plane = problem_size(MixedPlane::model(0.0));
  EXPECT_EQ(plane.coordinates, 3 + 9 + 12);
  EXPECT_EQ(plane.rows, 2 + 3 + 1);
  EXPECT_EQ(plane.degrees_of_freedom, 24 - 6);
}

}  // namespace observe_test
