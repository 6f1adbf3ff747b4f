#include <polybody/forces/contact_set.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/run/applied_wrenches.hpp>
#include <polybody/run/energy_audit.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/system/contact_coupling.hpp>
#include <polybody/testing/differences.hpp>

#include "support/refusal.hpp"

using namespace polybody;

namespace contact_set_test {

using Balls = ContactSet<Shapes<Sphere, Plane>>;
using Mixture = ContactSet<Shapes<Plane, Sphere, Capsule, Box>, HertzContact>;
static_assert(SearchingForceGroup<Balls> && SearchingForceGroup<Mixture> && !PartitionedForceGroup<Balls>);
static_assert(BoundedShape<Sphere> && BoundedShape<Capsule> && BoundedShape<Box> && !BoundedShape<Plane>);

constexpr double radius = 0.1, mass = 1.0, g = 9.81;
SpringDamperContact const elastic{.stiffness = 1e4}, damped{.stiffness = 1e4, .damping = 20.0};
Friction const rubber{.coefficient = 0.4, .slip_speed = 0.05};

Rigid<> ball(Vec3 const& at, double r = radius) {
  return Rigid<>(mass, Mat3(0.4 * mass * r * r * Mat3::Identity()), Placement::at(at));
}

// --- search ---------------------------------------------------------------------------------------------------

using Pairs = std::vector<std::pair<Index, Index>>;
/// Members of all shapes with random sizes: each size class has ten times the size of the last. Two planes.
Mixture random_mixture(int count, laws::Numbers& number) {
  Mixture set{HertzContact{.modulus = 1e6, .radius = 0.1}};
  auto const size = [&](int i) { return (0.05 + 0.04 * number()) * (i % 40 == 0 ? 10.0 : 1.0); };
  for (int i = 0; i < count; ++i) {
    int const body = i / 2 + 1, group = i % 7 == 0 ? 1 : 0;
    if (i % 3 == 0) set.add_member(Sphere{.radius = size(i)}, body, group, "sphere");
    if (i % 3 == 1) set.add_member(Capsule{.radius = size(i), .length = size(i), .taper = 1e-4}, body, group, "rod");
    if (i % 3 == 2) {
      double const s = size(i);
      set.add_member(Box{.size = {s, 2.0 * s, 3.0 * s}, .rounding = 0.2 * s, .taper = 1e-4}, body, group, "box");
    }
    if (i % 50 == 10) set.add_member(Plane{}, -1, 0, "plane");
  }
  for (Index i = 0; i + 3 < set.members(); i += 5) set.exclude(i + 3, i);
  return set;
}
/// Calls visit(i, j) for a pair with a contact point. `may_touch` can also be true for other pairs.
template <class FrameOf, class Visit>
auto if_touching(FrameOf const& frame, Visit const& visit) {
  return [&](Index i, Index j, auto const& law) {
    bool touches = false;
    law.geometry.template for_each_point<double>(frame(i), frame(j), [&](auto const&) { touches = true; });
    if (touches) visit(i, j);
  };
}

// Random walks with short and long steps: within the margin, across many cells, and from one end to the other.
TEST(ContactSet, FindsThePairsOfBruteForce) {
  laws::Numbers number;
  for (int const count : {0, 1, 2, 30, 250}) {
    Mixture const set = random_mixture(count, number);
    std::vector<Frame<double>> frames(std::size_t(set.members()));
    for (auto& f : frames) f = number.frame();
    auto const frame = [&](Index k) -> Frame<double> const& { return frames[std::size_t(k)]; };
    PairSearch search;
    std::size_t found_in_all = 0;
    int evaluations = 0;
    for (double const way : {0.0, 1e-4, 1e-3, 1e-2, 1e-1, 1.0, 30.0})
      for (int k = 0; k < 10; ++k, ++evaluations) {
        for (auto& f : frames) f = laws::moved<double>(f, number.motion(false, way));
        if (way == 30.0)
          for (auto& f : frames) f.r *= 1.0 / 30.0;
        Pairs found, of_all;
        set.for_each_pair(search, frame, if_touching(frame, [&](Index i, Index j) { found.emplace_back(i, j); }));
        set.for_each_candidate(if_touching(frame, [&](Index i, Index j) { of_all.emplace_back(i, j); }));
        ASSERT_EQ(found, of_all) << count << " members, way " << way;
        found_in_all += found.size();
      }
    if (count >= 30) {
      EXPECT_GT(found_in_all, std::size_t(10 * count));
      EXPECT_LT(search.searches(), evaluations - 15);  // steps of 1e-4 are within the margin
      EXPECT_GT(search.searches(), 30);
    }
  }
}

// A member at infinity or with a NaN leaves the pairs of the others unchanged.
TEST(ContactSet, FindsThePairsBesideMembersThatAreNoNumbers) {
  Balls set{elastic};
  for (int i = 0; i < 20; ++i) set.add_member(Sphere{.radius = 0.6}, i, 0, "ball");
  std::vector<Frame<double>> frames(20);
  for (int i = 0; i < 20; ++i) frames[std::size_t(i)].r = Vec3(1.0 * i, 0, 0);
  auto const frame = [&](Index k) -> Frame<double> const& { return frames[std::size_t(k)]; };
  PairSearch search;
  for (double const far : {0.0, 1e30, std::numeric_limits<double>::infinity(), std::nan("")}) {
    frames[19].r = Vec3(19.0, far, 0);
    Pairs found;
    set.for_each_pair(search, frame, [&](Index i, Index j, auto const&) { found.emplace_back(i, j); });
    EXPECT_EQ(found.size(), far == 0.0 ? 19u : 18u) << far;
  }
}

// --- forces ---------------------------------------------------------------------------------------------------

/// Balls of different sizes that fly towards each other.
template <class Set>
struct Swarm {
  Model<Bodies<Rigid<>>, Joints<>, Forces<Set>> model;
  std::vector<BodyHandle<Rigid<>>> balls;
  ElementHandle<Set> set;

  Swarm(int count, SpringDamperContact const& normal, Friction const& friction, double spread = 0.4) {
    set = model.apply(Set{normal, friction}, "swarm");
    laws::Numbers number;
    for (int i = 0; i < count; ++i) {
      double const r = radius * (1.0 + 0.3 * number());
      balls.push_back(model.add(ball(number.vec<3>(spread), r)));
      model.add_member(set, Sphere{.radius = r}, balls.back().centre());
    }
  }
  State start() const {
    State x = model.reference_state();
    laws::Numbers number;
    for (auto const& b : balls) {
      Vec3 const r = frame(model, x, b.centre()).r, spin = number.vec<3>(3.0);
      model.set_velocity(x, b, Vec3(-2.0 * r - spin.cross(r)), spin);
    }
    return x;
  }
};

// Laws of the set, of single contacts between all pairs, and of a set whose members were added in another order.
TEST(ContactSet, IsTheSumOfItsContacts) {
  Swarm<Balls> const swarm(12, damped, rubber);
  State x = swarm.start(), one_by_one = x;
  Model<Bodies<Rigid<>>, Joints<>, Forces<Contact<SphereOnSphere>>> single;
  std::vector<BodyHandle<Rigid<>>> balls;
  laws::Numbers number;
  std::vector<double> radii;
  for (int i = 0; i < 12; ++i) {
    radii.push_back(radius * (1.0 + 0.3 * number()));
    balls.push_back(single.add(ball(number.vec<3>(0.4), radii.back())));
    for (std::size_t k = 0; k < std::size_t(i); ++k)
      single.apply(Contact<SphereOnSphere>{{.radius_a = radii[k], .radius_b = radii.back()}, damped, rubber},
                   balls[k].centre(), balls.back().centre());
  }
  State const start = x;
  simulate(swarm.model, x, RungeKutta4<>{}, {.end_time = 0.3, .step = 5e-4}).run();
  simulate(single, one_by_one, RungeKutta4<>{}, {.end_time = 0.3, .step = 5e-4}).run();
  EXPECT_LT((x.q - one_by_one.q).norm(), 1e-11);  // round-off; the order of the sums differs
  EXPECT_GT((x.v - start.v).norm(), 1.0);         // contacts have acted
}

// Internal forces: the sums of forces and of moments about the origin vanish, so momentum is conserved.
TEST(ContactSet, ConservesMomentum) {
  Swarm<Balls> const swarm(60, damped, rubber);
  State x = swarm.start();
  Momentum const before = momentum(swarm.model, x);
  double transferred = 0.0;
  for (auto const& now : simulate(swarm.model, x, RungeKutta4<>{}, {.end_time = 0.2, .step = 5e-4})) {
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    auto const wrenches = now.applied_wrenches(swarm.set);
    for (std::size_t i = 0; i < wrenches.size(); ++i) {
      force += wrenches[i].f;
      moment += wrenches[i].m + now.position(swarm.balls[i].centre()).cross(wrenches[i].f);
      transferred += wrenches[i].f.norm() * 5e-4;
    }
    ASSERT_LT(force.norm(), 1e-10);  // of forces up to 1 kN
    ASSERT_LT(moment.norm(), 1e-10);
  }
  Momentum const after = momentum(swarm.model, x);
  EXPECT_GT(transferred, 50.0);
  EXPECT_LT((after.linear - before.linear).norm(), 1e-11 * transferred);
  EXPECT_LT((after.angular - before.angular).norm(), 2e-6 * transferred);  // error of the integrator at corners
}

TEST(ContactSet, EnergyAuditOfElasticAndOfDampedContacts) {
  for (bool const loses : {false, true}) {
    Swarm<Balls> const swarm(40, loses ? damped : elastic, loses ? rubber : Friction{});
    State x = swarm.start();
    EnergyAudit audit(swarm.model);
    double most = 0.0;
    for (State const& now : simulate(swarm.model, x, RungeKutta4<>{}, {.end_time = 0.2, .step = 1e-4})) {
      audit.record(now);
      most = std::max(most, audit.stored());
    }
    EXPECT_GT(most, 0.3);
    if (loses)
      EXPECT_GT(audit.dissipated(), 5.0);
    else
      EXPECT_EQ(audit.dissipated(), 0.0);
    // elastic: error of the integrator. With dampers, the power jumps as contacts close: at most ½ h c v² each, and 40
    // balls of 2 m/s close some 100 contacts: 100 · ½ · 1e-4 · 20 · 4 = 0.4 J of 80 J, with both signs
    EXPECT_LT(audit.relative(), loses ? 5e-3 : 1e-4);
  }
}

// A run that resumes from a snapshot has the same bits as the first run, although its search has found no pairs yet.
TEST(ContactSet, RepeatsRunsBitwiseFromSnapshots) {
  Swarm<Balls> const swarm(40, damped, {.coefficient = 0.3, .slip_speed = 0.5}, 0.7);
  GeneralisedAlpha const alpha{};
  State first = swarm.start(), second;
  auto run = simulate(swarm.model, first, alpha, {.end_time = 0.1, .step = 2e-3});
  run.run();
  RunSnapshot const middle = run.snapshot();
  resume(swarm.model, first, alpha, {.end_time = 0.2, .step = 2e-3}, middle).run();
  // another search: the same model in a run that visits other positions between
  State other = swarm.start();
  simulate(swarm.model, other, alpha, {.end_time = 0.15, .step = 2e-3}).run();
  resume(swarm.model, second, alpha, {.end_time = 0.2, .step = 2e-3}, middle).run();
  EXPECT_EQ(first.q, second.q);
  EXPECT_EQ(first.v, second.v);
  // whole runs, of which one has halved steps
  State whole = swarm.start(), again = swarm.start();
  simulate(swarm.model, whole, alpha, {.end_time = 0.2, .step = 2e-2}).run();
  simulate(swarm.model, again, alpha, {.end_time = 0.2, .step = 2e-2}).run();
  EXPECT_EQ(whole.q, again.q);
  EXPECT_EQ(whole.v, again.v);
}

// The forces depend only on the positions, not on the search that found the pairs.
TEST(ContactSet, HasTheSameForcesAfterAnySearch) {
  Swarm<Balls> const swarm(60, damped, rubber);
  State x = swarm.start();
  Probe kept(swarm.model);
  laws::Numbers number;
  for (int k = 0; k < 50; ++k) {
    for (Index i = 0; i < 60; ++i) x.q.segment<3>(7 * i) += number.vec<3>(k % 10 == 0 ? 0.05 : 1e-3);
    auto const with_kept = kept.at(x).applied_wrenches(swarm.set), anew = applied_wrenches(swarm.model, x, swarm.set);
    for (std::size_t i = 0; i < anew.size(); ++i) {
      ASSERT_EQ(with_kept[i].f, anew[i].f);
      ASSERT_EQ(with_kept[i].m, anew[i].m);
    }
  }
}

// --- tangent --------------------------------------------------------------------------------------------------

/// Sum of all blocks as a dense matrix.
struct DenseSum {
  MatX sum;
  void add(Index row, Index col, BlockView const& b) {
    for (Index i = 0; i < b.rows; ++i)
      for (Index j = 0; j < b.cols; ++j) sum(row + i, col + j) += b(i, j);
  }
};

// At rest the blocks of the bodies and the coupling of the contacts are the exact derivative with respect to the
// velocities: the secant of the friction force then equals its derivative.
TEST(ContactSet, BodiesAndCouplingAreTheExactDampingAtRest) {
  Swarm<Balls> const swarm(12, damped, rubber);
  State const x = swarm.model.reference_state();
  System system(swarm.model);
  system.evaluate(x.q, x.v, x.t);
  Index const n = system.velocities();
  DenseSum exact{MatX::Zero(n, n)}, bodies = exact;
  ContactCoupling coupling;
  system.tangent({.mass = 1.0, .damping = 0.1, .exact = true}, SecondOrder::omitted, x.lambda, exact);
  system.tangent({.mass = 1.0, .damping = 0.1, .coupling = &coupling}, SecondOrder::omitted, x.lambda, bodies);
  EXPECT_GT((bodies.sum - exact.sum).norm(), 0.1 * exact.sum.norm());
  for (Index j = 0; j < n; ++j) {
    VecX column = bodies.sum.col(j);
    coupling.add_product(VecX(VecX::Unit(n, j)), column);
    EXPECT_LT((column - exact.sum.col(j)).norm(), 1e-12 * exact.sum.norm()) << j;
  }
}

// --- rest -----------------------------------------------------------------------------------------------------

// 250 columns of two balls fall from different heights. Near columns are candidates of the search. At rest the plane
// carries the weight, with the penetrations 2 m g/k below and m g/k between the balls. Of the slowest motion, ω² =
// (3 − √5)/2 k/m with the decay rate c ω²/(2 k) = 19 1/s, 1e-6 remains at the end.
TEST(ContactSet, FiveHundredBallsSettleOnAPlane) {
  constexpr double k = 1e4;
  Model<Bodies<Rigid<>>, Joints<>, Forces<Balls>> model{Gravity{0, 0, -g}};
  auto const set = model.apply(
      Balls{{.stiffness = k, .damping = 100.0, .onset = 2e-4}, {.coefficient = 0.3, .slip_speed = 0.05}}, "columns");
  for (int i = 0; i < 500; ++i) {
    int const column = i / 2;
    Vec3 const at(0.21 * (column % 16), 0.21 * (column / 16), radius + 1e-5 * (column % 37) + 0.2001 * (i % 2));
    model.add_member(set, Sphere{.radius = radius}, model.add(ball(at)).centre());
  }
  model.add_member(set, Plane{}, model.ground().at({0, 0, 0}), "floor");
  State x = model.reference_state();
  auto const report = simulate(model, x, GeneralisedAlpha{.rho_inf = 0.5}, {.end_time = 0.75, .step = 2.5e-3}).run();
  std::printf("500 balls: %ld steps, %.2f iterations per step\n", long(report.steps),
              double(report.iterations) / double(report.steps));
  EXPECT_NEAR(-applied_wrenches(model, x, set).back().f.z(), 500 * mass * g, 1e-3 * 500 * g);
  for (int i = 0; i < 500; ++i) {
    double const z = i % 2 == 0 ? radius - 2.0 * mass * g / k : 3.0 * radius - 3.0 * mass * g / k;
    ASSERT_NEAR(x.q[7 * i + 2], z, 1e-6) << i;
  }
}

// --- members --------------------------------------------------------------------------------------------------

TEST(ContactSet, ReportsItsContacts) {
  Model<Bodies<Rigid<>>, Joints<>, Forces<Balls>> model;
  auto const a = model.add(ball({0, 0, radius - 0.01})), b = model.add(ball({0, 0, 3.0 * radius - 0.03}));
  auto const set = model.apply(Balls{elastic});
  model.add_member(set, Plane{}, model.ground().at({0, 0, 0}), "floor");
  model.add_member(set, Sphere{.radius = radius}, a.centre(), "lower");
  model.add_member(set, Sphere{.radius = radius}, b.centre(), "upper");
  std::vector<std::string> against;
  State const x = model.reference_state();
  Probe(model).at(x).for_each_contact(set, [&](TouchingPoint const& p) {
    against.push_back(*p.against);
    EXPECT_EQ(p.body, 1);
    EXPECT_NEAR(p.depth, p.normal.z() > 0.0 ? 0.01 : 0.02, 1e-15);
    EXPECT_NEAR(p.force.z(), p.normal.z() > 0.0 ? 100.0 : -200.0, 1e-9);
  });
  EXPECT_EQ(against, (std::vector<std::string>{"upper", "floor"}));
}

TEST(ContactSet, LeavesOutPairsOfOneBodyOfOneGroupAndExcludedOnes) {
  Model<Bodies<Rigid<>>, Joints<>, Forces<Balls>> model;
  auto const set = model.apply(Balls{elastic}, "set");
  std::vector<BodyHandle<Rigid<>>> balls;
  for (int i = 0; i < 5; ++i) balls.push_back(model.add(ball({0.01 * i, 0, 0})));
  auto const add = [&](int i, int group) {
    return model.add_member(set, Sphere{.radius = radius}, balls[std::size_t(i)].centre(), "", group);
  };
  add(0, 1);
  add(1, 1);
  add(2, 2);
  Index const c = add(3, 2), d = add(4, 0);
  add(4, 0);
  add(4, 0);
  model.exclude(set, d, c);
  State const x = model.reference_state();
  int contacts = 0;
  Probe(model).at(x).for_each_contact(set, [&](TouchingPoint const&) { ++contacts; });
  // 21 pairs, without 2 in groups, 3 on one body and 1 excluded pair
  EXPECT_EQ(contacts, 15);
}

TEST(ContactSet, RefusesInvalidShapesAndNumbers) {
  using Set = ContactSet<Shapes<Sphere, Capsule, Box>>;
  Model<Bodies<Rigid<>>, Joints<>, Forces<Set>> model;
  auto const body = model.add(ball({0, 0, 0}));
  EXPECT_TRUE(has(refusal([&] { model.apply(Set{SpringDamperContact{.stiffness = -1.0}}, "pile"); }), "\"pile\""));
  auto const set = model.apply(Set{elastic}, "pile");
  auto const refused = [&](auto const& shape) {
    return refusal([&] { model.add_member(set, shape, body.centre(), "one"); });
  };
  EXPECT_TRUE(has(refused(Sphere{.radius = 0.0}), "\"pile\", \"one\": the radius of the sphere"));
  EXPECT_TRUE(has(refused(Capsule{.radius = 0.1, .length = 1.0, .taper = 0.0}), "the taper of the capsule"));
  EXPECT_TRUE(has(refused(Box{.size = {1, 1, 1}, .rounding = 0.0, .taper = 0.1}), "the rounding of the box"));
  EXPECT_TRUE(has(refusal([&] { model.exclude(set, 0, 1); }), "the number of a member must lie in [0, -1]"));
}

}  // namespace contact_set_test
