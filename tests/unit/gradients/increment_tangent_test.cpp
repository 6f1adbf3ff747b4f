// The derivative of the equations of a step with respect to the unknowns, including ⊞, against finite differences of
// these equations.
#include <polybody/gradients/increment_tangent.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/forces/contact_set.hpp>
#include <polybody/polybody.hpp>
#include <polybody/system/active_contact_pairs.hpp>
#include <polybody/testing/differences.hpp>

using namespace polybody;

namespace turned_increments_test {

/// Sink that adds blocks to a dense matrix.
struct DenseSink {
  MatX m;
  void add(Index row, Index col, BlockView const& b) {
    for (Index i = 0; i < b.rows; ++i)
      for (Index j = 0; j < b.cols; ++j) m(row + i, col + j) += b(i, j);
  }
};
VecX numbers(Index n, double size, double seed) {
  VecX x(n);
  for (Index i = 0; i < n; ++i) x[i] = size * std::sin(seed * double(i + 1) * double(i + 2));
  return x;
}

/// Magnitudes of velocities [m/s], [rad/s] and of accelerations.
struct Motion {
  double speed = 2.0, acceleration = 20.0;
};
/// A step of length h from q₀ with the unknowns y = (a, λ): v̇ = a, v = v₀ + γh a, δ = δ₀ + βh² a. The residual has
/// nonholonomic constraints over γh and other constraints over βh².
struct Step {
  System& system;
  VecX q, v, delta, a, lambda;
  double h = 0.05, gamma = 0.6, beta = 0.3;

  Step(System& s, State const& x, Motion const& motion) : system(s), q(x.q), lambda(numbers(s.rows(), 30.0, 0.3)) {
    Index const nv = s.velocities();
    v = numbers(nv, motion.speed, 0.7);
    delta = numbers(nv, 0.2, 0.4);
    a = numbers(nv, motion.acceleration, 0.9);
  }
  VecX operator()(VecX const& dy) const {
    Index const nv = system.velocities(), rows = system.rows();
    VecX const da = dy.head(nv), there = delta + beta * h * h * da, velocities = v + gamma * h * da, a1 = a + da,
               lambda1 = lambda + dy.tail(rows);
    VecX q1 = q, r(nv), phi(rows), rate(rows), all(nv + rows);
    system.plus(q, there, q1);
    system.evaluate(q1, velocities, 0.0);
    system.residual(a1, lambda1, r);
    system.violation(phi);
    system.violation_rate(rate);
    all << r, phi / (beta * h * h);
    for (Index const i : system.nonholonomic_equations()) all[nv + i] = rate[i] / (gamma * h);
    return all;
  }
  TangentCoefficients coefficients(bool exact) const {
    return {.mass = 1.0, .damping = gamma * h, .stiffness = beta * h * h, .exact = exact};
  }
};

struct Matrices {
  MatX by_differences;  // derivative of the equations of the step with respect to its unknowns
  MatX plain, turned;   // tangent with second-order terms; tangent with the derivative of ⊞, in the same unknowns
};
Matrices matrices_of(System& system, State const& x, Motion const& motion, bool exact) {
  Step const step(system, x, motion);
  Index const n = system.size();
  Matrices out{MatX(n, n), MatX(n, n), MatX(n, n)};
  for (Index j = 0; j < n; ++j) {
    VecX one = VecX::Zero(n);
    one[j] = 1.0;
    out.by_differences.col(j) = laws::slope_at_zero([&](double e) -> VecX { return step(e * one); }, 0.05);
  }
  (void)step(VecX::Zero(n));
  IncrementTangent turned(system);
  turned.set(system, step.delta);
  DenseSink sink{MatX::Zero(n, n)};
  system.tangent(step.coefficients(exact), SecondOrder::included, step.lambda, sink);
  out.plain = sink.m;
  turned.write(system, step.coefficients(exact), sink);
  // columns of sink.m belong to u, with y = u + W u
  MatX to_y(n, n);
  for (Index j = 0; j < n; ++j) {
    VecX u = VecX::Zero(n);
    u[j] = 1.0;
    turned.to_increments(u);
    to_y.col(j) = u;
  }
  out.turned = sink.m * to_y.inverse();
  return out;
}
double apart(MatX const& a, MatX const& b) { return (a - b).norm() / b.norm(); }

Bar bar() {
  return {.length = 0.4, .section = Circle{.radius = 0.02}, .material = Material{.density = 2000.0, .young = 1e7}};
}
template <class Body>
auto pair_of(Body const& one, Body const& other) {
  Model<Bodies<Body>, Joints<Joint<Spherical, Constraint>>> model;
  auto const a = model.add(one, "a"), b = model.add(other, "b");
  model.connect(Joint<Spherical, Constraint>{}, model.ground().at({0, 0, 0}), a.at(0.0));
  model.connect(Joint<Spherical, Constraint>{}, a.at(0.4), b.at(0.0));
  return model;
}

template <class M>
void expect_exact(M const& model, Motion const& motion = {}) {
  System system(model, with<Capabilities::implicit_step>);
  Matrices const m = matrices_of(system, model.reference_state(), motion, false);
  EXPECT_LT(apart(m.turned, m.by_differences), 1e-8);
  EXPECT_GT(apart(m.plain, m.by_differences), 1e-4);
}

TEST(IncrementTangent, CompleteTheTangentOfRigidBodies) {
  expect_exact(pair_of(Rigid<>::from(bar()), Rigid<>::from(bar())));
}
TEST(IncrementTangent, CompleteTheTangentOfNodesWithRotationVectors) {
  expect_exact(pair_of(Lrvf<>::from(bar(), 2), Lrvf<>::from(bar(), 2)));
}
// The tangent of these bodies omits the derivatives of inertia forces and weight with respect to the coordinates.
TEST(IncrementTangent, CompleteTheTangentOfFloatingFrames) {
  expect_exact(pair_of(Ffr::from(bar(), 2), Ffr::from(bar(), 2)), {0.0, 0.0});
}

/// Two rotating bodies, and force elements between points away from their mass centres.
template <class M>
struct TwoThatTurn {
  M model{Gravity{0, 0, -9.81}};
  BodyHandle<Rigid<>> a, b;

  TwoThatTurn() {
    a = model.add(Rigid<>::from(bar()), "a");
    Bar other = bar();
    other.placement = Placement::at({0.5, 0.1, 0.2});
    b = model.add(Rigid<>::from(other), "b");
  }
  Marker<Rigid<>> of_a() const { return a.at(Vec3(0.1, 0.05, -0.02)); }
  Marker<Rigid<>> of_b() const { return b.at(Vec3(-0.15, 0.02, 0.04)); }
};
/// Tangents of steps omit the dependence of constraint rates on positions; exact tangents include it.
template <class M>
void expect_exact_with_rates(M const& model) {
  System system(model, with<Capabilities::implicit_step>);
  Matrices const exact = matrices_of(system, model.reference_state(), {}, true),
                 as_in_steps = matrices_of(system, model.reference_state(), {}, false);
  EXPECT_LT(apart(exact.turned, exact.by_differences), 1e-8);
  EXPECT_GT(apart(as_in_steps.turned, exact.by_differences), 1e-5);
}

TEST(ExactTangents, AreThoseOfSpringsBetweenBodiesThatTurn) {
  TwoThatTurn<Model<Bodies<Rigid<>>, Joints<>, Forces<SpringDamper>>> two;
  two.model.apply(SpringDamper{.stiffness = 2e3, .damping = 400.0, .free_length = 0.4}, two.of_a(), two.of_b());
  expect_exact_with_rates(two.model);
}
TEST(ExactTangents, AreThoseOfForcesWithStates) {
  TwoThatTurn<Model<Bodies<Rigid<>>, Joints<>, Forces<MaxwellElement>>> two;
  two.model.apply(MaxwellElement{.stiffness = 5e3, .damping = 300.0, .free_length = 0.4}, two.of_a(), two.of_b());
  System system(two.model, with<Capabilities::implicit_step>);
  Matrices const m = matrices_of(system, two.model.reference_state(), {}, true);
  EXPECT_LT(apart(m.turned, m.by_differences), 1e-8);
}
TEST(ExactTangents, AreThoseOfCompliantJoints) {
  using Soft = Joint<Spherical, Penalty>;
  TwoThatTurn<Model<Bodies<Rigid<>>, Joints<Soft>>> ball;
  ball.model.connect(Soft{{}, Penalty{.stiffness = 2e4, .damping = 800.0}}, ball.of_a(), ball.of_b());
  expect_exact_with_rates(ball.model);
  using Rubber = Joint<Weld, Bushing>;
  TwoThatTurn<Model<Bodies<Rigid<>>, Joints<Rubber>>> weld;
  weld.model.connect(Rubber{{},
                            Bushing{.stiffness = Bushing::diagonal(Vec3(1e3, 2e3, 3e3), Vec3(10, 20, 30)),
                                    .damping = Bushing::diagonal(Vec3(300, 200, 100), Vec3(3, 2, 1))}},
                     weld.of_a(), weld.of_b());
  expect_exact_with_rates(weld.model);
}
TEST(ExactTangents, AreThoseOfRowsOfSpeeds) {
  using Blade = Joint<KnifeEdge, Constraint>;
  TwoThatTurn<Model<Bodies<Rigid<>>, Joints<Blade>>> glides;
  glides.model.connect(Blade{{.across = Vec3::UnitY()}}, glides.of_a(), glides.of_b());
  expect_exact_with_rates(glides.model);
  using Disc = Joint<RollingDisc, Constraint>;
  TwoThatTurn<Model<Bodies<Rigid<>>, Joints<Disc>>> rolls;
  rolls.model.connect(Disc{{.radius = 0.3, .axis = Vec3::UnitX(), .normal = Vec3::UnitZ()}},
                      rolls.model.ground().at({0, 0, 0}), rolls.b.at(Vec3(0, 0, 0)));
  expect_exact_with_rates(rolls.model);
}
// Tangents of a contact group that steps write without the blocks between two bodies.
TEST(ExactTangents, AreThoseOfGroupsWithBlocksBetweenTheirBodies) {
  using OnBall = Contact<SphereOnSphere>;
  using Group = ContactGroup<OnBall>;
  TwoThatTurn<Model<Bodies<Rigid<>>, Joints<>, Forces<Group>>> two;
  auto const group = two.model.apply(Group{}, std::vector{two.of_a()}, "balls");
  two.model.add_partner(group,
                        OnBall{{.radius_a = 0.5, .radius_b = 0.6},
                               {.stiffness = 1e4, .damping = 300.0},
                               Friction{.coefficient = 0.4, .slip_speed = 0.5}},
                        two.of_b(), "other ball");
  expect_exact_with_rates(two.model);
}

TEST(ExactTangents, AreThoseOfContactSets) {
  using Set = ContactSet<Shapes<Sphere, Capsule>, HuntCrossleyContact>;
  TwoThatTurn<Model<Bodies<Rigid<>>, Joints<>, Forces<Set>>> two;
  auto const set =
      two.model.apply(Set{{.stiffness = 1e4, .damping = 0.3}, Friction{.coefficient = 0.4, .slip_speed = 0.5}}, "set");
  two.model.add_member(set, Sphere{.radius = 0.5}, two.of_a());
  two.model.add_member(set, Capsule{.radius = 0.6, .length = 0.3, .taper = 0.01}, two.of_b());
  expect_exact_with_rates(two.model);
}

/// Springs between consecutive markers: a force group whose law does not report when it acts.
struct Net {
  static constexpr int markers = any_number;
  static constexpr bool is_load = false;
  static constexpr MarkerKind needs = SpringDamper::needs;
  SpringDamper spring;
  Index many = 0;

  void set_many(Index count) { many = count; }
  void check(std::string const& name) const { spring.check(name); }
  template <class FrameOf, class Visit>
  void for_each_pair(FrameOf&&, Visit&& visit) const {
    for_each_candidate(visit);
  }
  template <class Visit>
  void for_each_candidate(Visit&& visit) const {
    for (Index i = 0; i + 1 < many; ++i) visit(i, i + 1, spring);
  }
};
TEST(ExactTangents, AreThoseOfGroupsThatUsersWrite) {
  TwoThatTurn<Model<Bodies<Rigid<>>, Joints<>, Forces<Net>>> two;
  two.model.apply(Net{{.stiffness = 2e3, .damping = 400.0, .free_length = 0.4}}, std::vector{two.of_a(), two.of_b()},
                  "net");
  expect_exact_with_rates(two.model);
}

// A row of balls over two others. Blocks are written for pairs in contact and for their neighbours. The matrix equals
// the one with blocks for all pairs, and it reports a contact pair without a block.
TEST(ActiveContactPairs, HaveAllBlocksThatAct) {
  using OnBall = Contact<SphereOnSphere>;
  using Group = ContactGroup<OnBall>;
  Model<Bodies<Rigid<>>, Joints<>, Forces<Group>> model{Gravity{0, 0, -9.81}};
  auto const ball = [&](double x, double z) {
    return model.add(Rigid<>(1.0, Mat3(0.1 * Mat3::Identity()), Placement::at({x, 0, z})), std::to_string(x));
  };
  std::vector<Marker<Rigid<>>> many;
  for (int i = 0; i < 8; ++i) many.push_back(ball(0.5 * i, 1.0).at(Vec3(0, 0, 0)));
  auto const group = model.apply(Group{}, many, "row");
  OnBall const law{{.radius_a = 0.2, .radius_b = 0.85}, {.stiffness = 1e4, .damping = 300.0}, Friction{}};
  for (double const x : {0.1, 3.4}) model.add_partner(group, law, ball(x, 0.0).at(Vec3(0, 0, 0)), "below");
  System system(model, with<Capabilities::implicit_step>);
  State x = model.reference_state();
  auto const written = [&](ActiveContactPairs* pairs, int& blocks) {
    struct Counting : DenseSink {
      int* count;
      void add(Index row, Index col, BlockView const& b) {
        DenseSink::add(row, col, b);
        ++*count;
      }
    } sink{{MatX::Zero(system.size(), system.size())}, &blocks};
    blocks = 0;
    if (pairs) pairs->begin();
    system.evaluate(x.q, x.v, 0.0);
    system.tangent(TangentCoefficients{.mass = 1.0, .damping = 0.1, .stiffness = 0.01, .exact = true, .pairs = pairs},
                   SecondOrder::included, VecX(), sink);
    return sink.m;
  };
  ActiveContactPairs pairs;
  int of_all = 0, of_some = 0, of_none = 0;
  MatX const all = written(nullptr, of_all);
  EXPECT_NE(written(&pairs, of_none), all);
  EXPECT_TRUE(pairs.lacks());
  pairs.hold();
  EXPECT_EQ(written(&pairs, of_some), all);
  EXPECT_FALSE(pairs.lacks());
  // 0 and 7 touch: 0 to 2 and 5 to 7 are kept, with four blocks per pair, out of 16 pairs
  EXPECT_EQ(of_some - of_none, 4 * 6);
  EXPECT_EQ(of_all - of_none, 4 * 16);
  x.q[7] = 0.15;  // the neighbour of the first ball comes over the same ball below, as predicted
  (void)written(&pairs, of_some);
  EXPECT_FALSE(pairs.lacks());
  x.q[0] = 3.35;  // the first ball over the other ball
  (void)written(&pairs, of_some);
  EXPECT_TRUE(pairs.lacks());
  pairs.hold();
  EXPECT_EQ(written(&pairs, of_some), written(nullptr, of_all));
  // back and forth: blocks of both positions are kept; after fifty assemblies at one position the other position's
  // blocks are dropped
  for (int again = 0; again < 3; ++again) {
    x.q[0] = again % 2 == 0 ? 0.0 : 3.35;
    (void)written(&pairs, of_some);
    EXPECT_FALSE(pairs.lacks());
  }
  pairs.hold();
  int of_both = 0;
  (void)written(&pairs, of_both);
  for (int i = 0; i < 50; ++i) (void)written(&pairs, of_some);
  pairs.hold();
  EXPECT_EQ(written(&pairs, of_some), written(nullptr, of_all));
  EXPECT_LT(of_some, of_both);
}

// A nonholonomic constraint at rest, because tangents of steps omit ∂Φ̇/∂q.
TEST(IncrementTangent, CompleteVelocityRows) {
  Model<Bodies<Rigid<>>, Joints<Joint<KnifeEdge, Constraint>>> model;
  auto const sledge = model.add(Rigid<>::from(bar()), "sledge");
  model.connect(Joint<KnifeEdge, Constraint>{{.across = Vec3::UnitY()}}, model.ground().at({0, 0, 0}), sledge.at(0.0));
  expect_exact(model, {.speed = 0.0});
}

TEST(IncrementTangent, AreNoneWhereNothingTurns) {
  auto const model = pair_of(AncfCable<>::from(bar(), 1), AncfCable<>::from(bar(), 1));
  System system(model, with<Capabilities::tangent>);
  IncrementTangent turned(system);
  EXPECT_FALSE(turned.any());
  VecX const u = numbers(system.size(), 1.0, 0.3);
  VecX same = u;
  turned.to_increments(same);
  turned.transpose_to_increments(same);
  EXPECT_EQ(same, u);
}

// yᵀ (T⁻¹ u) = (T⁻ᵀ y)ᵀ u
TEST(IncrementTangent, AreTransposed) {
  auto const model = pair_of(Rigid<>::from(bar()), Rigid<>::from(bar()));
  System system(model, with<Capabilities::tangent>);
  IncrementTangent turned(system);
  ASSERT_TRUE(turned.any());
  turned.set(system, numbers(system.velocities(), 0.8, 0.4));
  VecX const u = numbers(system.size(), 1.0, 0.3), y = numbers(system.size(), 1.0, 0.7);
  VecX to = u, back = y;
  turned.to_increments(to);
  turned.transpose_to_increments(back);
  EXPECT_GT((to - u).norm(), 0.1);
  EXPECT_NEAR(y.dot(to), back.dot(u), 1e-14);
}

}  // namespace turned_increments_test
