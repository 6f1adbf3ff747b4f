// Islands: separation of a model, and steps that solve its islands apart.
#include <gtest/gtest.h>

#include <cmath>
#include <polybody/polybody.hpp>

using namespace polybody;

namespace island_steps_test {

using OnFloor = Contact<SphereOnPlane>;
using Group = ContactGroup<OnFloor>;

constexpr double radius = 0.1, mass = 1.0;
OnFloor floor_with(double mu, double onset, double damping = 100.0) {
  return {{radius}, {.stiffness = 1e5, .damping = damping, .onset = onset}, {.coefficient = mu, .slip_speed = 0.01}};
}
Rigid<> ball_at(Vec3 const& r) { return {mass, 0.4 * mass * radius * radius * Mat3::Identity(), Placement::at(r)}; }

/// Nine islands with every kind of part: two links with pins, a cable, a body with a first-order state, two bodies with
/// a force between them, three balls of a group, and two balls with their own contacts.
struct Mixed {
  using Pin = Joint<Revolute, Constraint>;
  using Ball = Joint<Spherical, Constraint>;
  Model<Bodies<Rigid<>, AncfCable<>>, Joints<Pin, Ball>, Forces<MaxwellElement, Group, OnFloor>> model{
      Gravity{0, 0, -9.81}};

  Mixed() {
    Vec3 const o = Vec3::Zero();
    auto const ground = model.ground();
    auto const first_ball = model.add(ball_at({5, 0, 0.09}));
    auto const link = model.add(ball_at({0.5, 0, 1})), next = model.add(ball_at({1.5, 0, 1}));
    Bar const bar{.length = 1.0, .constants = BarConstants{.EA = 1e4, .EI = 5, .mass_per_length = 1.0}};
    auto const cable = model.add(AncfCable<>::from(bar, 3));
    auto const creeping = model.add(ball_at({0, 3, 1})), a = model.add(ball_at({0, 4, 1})),
               b = model.add(ball_at({0, 5, 1}));
    model.connect(Pin{{.axis = Vec3::UnitY()}, {}}, link.at(Vec3(0.5, 0, 0)), next.at(Vec3(-0.5, 0, 0)));
    model.connect(Ball{}, ground.at({0, 0, 0}), cable.at(0.0));
    model.connect(Pin{{.axis = Vec3::UnitY()}, {}}, ground.at({0, 0, 1}), link.at(Vec3(-0.5, 0, 0)));
    MaxwellElement const law{.stiffness = 100.0, .damping = 10.0, .free_length = 0.5};
    model.apply(law, a.at(o), b.at(o));
    model.apply(law, ground.at({0, 3, 0}), creeping.at(o));
    std::vector<Marker<Rigid<>>> middles;
    for (double const y : {1.0, 2.0, 3.0}) middles.push_back(model.add(ball_at({5, y, 0.08})).at(o));
    auto const group = model.apply(Group{}, middles);
    model.add_partner(group, floor_with(0.5, 0.0), ground.at({0, 0, 0}));
    model.add_partner(group, floor_with(0.1, 0.0), ground.at({0, 0, -0.01}));
    model.apply(floor_with(0.8, 0.0), first_ball.at(o), ground.at({0, 0, 0}));
    model.apply(floor_with(0.2, 0.0), model.add(ball_at({5, 5, 0.05})).at(o), ground.at({0, 0, 0}));
  }
};

/// Numbers between −1 and 1.
VecX scattered(Index n, int seed) {
  VecX x(n);
  for (Index i = 0; i < n; ++i) x[i] = std::sin(12.9898 * double(i + 1) + double(seed));
  return x;
}
VecX part_of(VecX const& x, Sequence<IslandPlaces::Range> const& places, Index n) {
  VecX out(n);
  for (auto const& r : places) out.segment(r.own, r.count) = x.segment(r.model, r.count);
  return out;
}

TEST(IslandSteps, SeparateAModelIntoIslandsWithTheSameEquations) {
  Mixed const mixed;
  System system(mixed.model, with<Capabilities::implicit_step>);
  auto islands = system.operations().islands();
  ASSERT_EQ(islands.size(), 9u);
  State x = mixed.model.reference_state();
  x.q += 1e-3 * scattered(x.q.size(), 1);
  x.v = scattered(x.v.size(), 2);
  VecX const a = scattered(x.v.size(), 3), lambda = scattered(x.lambda.size(), 4);
  VecX r(x.v.size()), phi(x.lambda.size()), rate = phi;
  system.evaluate(x.q, x.v, 0.1);
  system.residual(a, lambda, r);
  system.violation(phi);
  system.violation_rate(rate);
  Index q = 0, v = 0, rows = 0;
  for (ModelIsland& from : islands) {
    System own(from.operations, std::move(from.layout), std::move(from.data), {});
    IslandPlaces const& at = from.places;
    VecX own_r(own.velocities()), own_phi(own.rows()), own_rate = own_phi;
    own.evaluate(part_of(x.q, at.q, own.coordinates()), part_of(x.v, at.v, own.velocities()), 0.1);
    own.residual(part_of(a, at.v, own.velocities()), part_of(lambda, at.rows, own.rows()), own_r);
    own.violation(own_phi);
    own.violation_rate(own_rate);
    EXPECT_EQ(own_r, part_of(r, at.v, own.velocities()));
    EXPECT_EQ(own_phi, part_of(phi, at.rows, own.rows()));
    EXPECT_EQ(own_rate, part_of(rate, at.rows, own.rows()));
    q += own.coordinates();
    v += own.velocities();
    rows += own.rows();
  }
  EXPECT_EQ(q, x.q.size());
  EXPECT_EQ(v, x.v.size());
  EXPECT_EQ(rows, x.lambda.size());
}

TEST(IslandSteps, DoNotSeparateBodiesThatAForceConnects) {
  Model<Bodies<Rigid<>>, Joints<>, Forces<SpringDamper>> model;
  auto const a = model.add(ball_at({0, 0, 0})), b = model.add(ball_at({1, 0, 0}));
  model.apply(SpringDamper{.stiffness = 1.0, .free_length = 1.0}, a.at(Vec3(0, 0, 0)), b.at(Vec3(0, 0, 0)));
  System const system(model, with<Capabilities::implicit_step>);
  EXPECT_TRUE(system.operations().islands().empty());
}

/// Balls that land on a floor with friction, and a pendulum of two links.
struct Landing {
  using Pin = Joint<Revolute, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Pin>, Forces<OnFloor>> model{Gravity{0, 0, -9.81}};
  State x;

  /// \param first,end the balls have the numbers [first, end) \param onset of the damping [m] \param damping [N s/m]
  Landing(int first, int end, bool pendulum, double onset, double damping = 100.0) {
    if (pendulum) {
      auto const a = model.add(ball_at({0.5, 0, 1})), b = model.add(ball_at({1.5, 0, 1}));
      Pin const pin{{.axis = Vec3::UnitY()}, {}};
      model.connect(pin, model.ground().at({0, 0, 1}), a.at(Vec3(-0.5, 0, 0)));
      model.connect(pin, a.at(Vec3(0.5, 0, 0)), b.at(Vec3(-0.5, 0, 0)));
    }
    Index const before = model.velocities();
    for (int i = first; i < end; ++i)
      model.apply(floor_with(0.8, onset, damping),
                  model.add(ball_at({0, double(i), radius + 0.02 + 0.1 * std::fmod(0.618 * i, 1.0)})).at(Vec3(0, 0, 0)),
                  model.ground().at({0, 0, 0}));
    x = model.reference_state();
    for (int i = first; i < end; ++i) {
      Index const v = before + 6 * (i - first);
      x.v[v] = 1.0 + std::fmod(0.414 * i, 1.0);
      x.v[v + 1] = 0.3;
    }
  }
  RunReport run(double end_time = 0.3) {
    return simulate(model, x, GeneralisedAlpha{}, {.end_time = end_time, .step = 1e-3}).run();
  }
};

TEST(IslandSteps, GiveTheResultOfSeparateModels) {
  int const balls = 20;
  Landing all(0, balls, true, 1e-3), pendulum(0, 0, true, 1e-3);
  EXPECT_EQ(all.run().halved, 0);
  pendulum.run();
  // The Newton tolerance 1e-8 is relative to accelerations up to 1e3 m/s²; over 0.3 s it changes positions by 1e-6 m.
  EXPECT_LT((all.x.q.head(14) - pendulum.x.q).cwiseAbs().maxCoeff(), 1e-6);
  for (int i = 0; i < balls; ++i) {
    Landing one(i, i + 1, false, 1e-3);
    one.run();
    EXPECT_LT((all.x.q.segment(14 + 7 * i, 7) - one.x.q).cwiseAbs().maxCoeff(), 1e-6) << i;
    EXPECT_LT((all.x.v.segment(12 + 6 * i, 6) - one.x.v).cwiseAbs().maxCoeff(), 1e-4) << i;
  }
}

TEST(IslandSteps, HalveOnlyTheIslandThatFails) {
  int const balls = 60;  // their forces jump to c v at the contact, so that some steps have no solution
  Landing all(0, balls, true, 0.0, 2000.0), pendulum(0, 0, true, 0.0);
  EXPECT_GT(all.run().halved, 0);
  pendulum.run();
  // halved steps of the pendulum would change its error, which is of the order h² = 1e-6
  EXPECT_LT((all.x.q.head(14) - pendulum.x.q).cwiseAbs().maxCoeff(), 1e-7);
}

TEST(IslandSteps, RepeatBitwiseAlsoFromASnapshot) {
  Landing one(0, 20, true, 0.0), two(0, 20, true, 0.0);
  RunOptions const options{.end_time = 0.3, .step = 1e-3};
  auto run = simulate(one.model, one.x, GeneralisedAlpha{}, options);
  auto again = simulate(two.model, two.x, GeneralisedAlpha{}, options);
  for (int i = 0; i < 150; ++i) {
    run.advance();
    again.advance();
  }
  EXPECT_EQ(one.x.q, two.x.q);
  RunSnapshot const half = run.snapshot();
  State y = two.model.reference_state();
  resume(two.model, y, GeneralisedAlpha{}, options, half).run();
  run.run();
  EXPECT_EQ(one.x.q, y.q);
  EXPECT_EQ(one.x.v, y.v);
}

TEST(IslandSteps, BeginAfterAnExpensiveStepAndEnd) {
  Landing all(0, 20, true, 1e-3);
  System system(all.model, with<Capabilities::implicit_step>);
  AlphaMethod const method = GeneralisedAlpha{}.method();
  auto w = method.workspace<DefaultSolver>(system);
  method.start(system, all.x, 1e-3, w);
  EXPECT_EQ(w.islands.count(), 0u);
  int apart = 0, ended = 0;
  bool before = false;
  for (int i = 0; i < 300; ++i) {
    (void)method.step(system, all.x, 1e-3, w);
    apart += w.islands.active();
    ended += before && !w.islands.active();
    before = w.islands.active();
  }
  EXPECT_EQ(w.islands.count(), 21u);
  EXPECT_GT(apart, 15);
  EXPECT_GT(ended, 0);
}

TEST(IslandSteps, ConvergeWithoutHalvingsIfSlidingEnds) {
  long iterations = 0;
  for (int i = 0; i < 20; ++i) {
    Landing one(i, i + 1, false, 1e-3);
    RunReport const report = one.run();
    EXPECT_EQ(report.halved, 0) << i;
    iterations += report.iterations;
  }
  EXPECT_LT(iterations, 10000);  // of 6000 steps
}

}  // namespace island_steps_test
