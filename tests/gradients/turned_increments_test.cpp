// The derivative of a step's equations by the unknowns, ⊞ among it, beside differences of these equations.
#include <polybody/gradients/turned_increments.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/polybody.hpp>
#include <polybody/testing/differences.hpp>

using namespace polybody;

namespace turned_increments_test {

/// Blocks added up in a dense matrix.
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

/// Sizes of speeds [m/s], [rad/s] and accelerations.
struct Motion {
  double speed = 2.0, acceleration = 20.0;
};
/// A step of h from q₀ by y = (a, λ), with v̇ = a, v = v₀ + γh a, δ = δ₀ + βh² a: what its equations leave, velocity
/// rows over γh, others over βh².
struct Step {
  System& system;
  VecX q, v, delta, a, lambda;
  double h = 0.05, gamma = 0.6, beta = 0.3;

  Step(System& s, State const& x, Motion const& motion) : system(s), q(x.q), lambda(numbers(s.rows(), 30.0, 0.3)) {
    Index const nv = s.speeds();
    v = numbers(nv, motion.speed, 0.7);
    delta = numbers(nv, 0.2, 0.4);
    a = numbers(nv, motion.acceleration, 0.9);
  }
  VecX operator()(VecX const& dy) const {
    Index const nv = system.speeds(), rows = system.rows();
    VecX const da = dy.head(nv), there = delta + beta * h * h * da, speeds = v + gamma * h * da, a1 = a + da,
               lambda1 = lambda + dy.tail(rows);
    VecX q1 = q, r(nv), phi(rows), rate(rows), all(nv + rows);
    system.plus(q, there, q1);
    system.evaluate(q1, speeds, 0.0);
    system.residual(a1, lambda1, r);
    system.violation(phi);
    system.violation_rate(rate);
    all << r, phi / (beta * h * h);
    for (Index const i : system.velocity_rows()) all[nv + i] = rate[i] / (gamma * h);
    return all;
  }
  TangentCoefficients coefficients() const { return {1.0, gamma * h, beta * h * h}; }
};

struct Matrices {
  MatX by_differences;  // of the step's equations by its unknowns
  MatX plain, turned;   // tangent with second-order terms; with what ⊞ does, in the same unknowns
};
Matrices matrices_of(System& system, State const& x, Motion const& motion) {
  Step const step(system, x, motion);
  Index const n = system.size();
  Matrices out{MatX(n, n), MatX(n, n), MatX(n, n)};
  for (Index j = 0; j < n; ++j) {
    VecX one = VecX::Zero(n);
    one[j] = 1.0;
    out.by_differences.col(j) = laws::slope_at_zero([&](double e) -> VecX { return step(e * one); }, 0.05);
  }
  (void)step(VecX::Zero(n));
  TurnedIncrements turned(system);
  turned.set(system, step.delta);
  DenseSink sink{MatX::Zero(n, n)};
  system.tangent(step.coefficients(), SecondOrder::included, step.lambda, sink);
  out.plain = sink.m;
  turned.write(system, step.coefficients(), sink);
  // sink.m has columns by u, y = u + W u
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
  System system(model, with<Entries::implicit_step>);
  Matrices const m = matrices_of(system, model.reference_state(), motion);
  EXPECT_LT(apart(m.turned, m.by_differences), 1e-8);
  EXPECT_GT(apart(m.plain, m.by_differences), 1e-4);
}

TEST(TurnedIncrements, CompleteTheTangentOfRigidBodies) {
  expect_exact(pair_of(Rigid<>::from(bar()), Rigid<>::from(bar())));
}
TEST(TurnedIncrements, CompleteTheTangentOfNodesWithRotationVectors) {
  expect_exact(pair_of(Lrvf<>::from(bar(), 2), Lrvf<>::from(bar(), 2)));
}
// Their tangent leaves out how inertia forces and weight change with the coordinates.
TEST(TurnedIncrements, CompleteTheTangentOfFloatingFrames) {
  expect_exact(pair_of(Ffr::from(bar(), 2), Ffr::from(bar(), 2)), {0.0, 0.0});
}

// A velocity row, at rest, as tangents leave out ∂Φ̇/∂q.
TEST(TurnedIncrements, CompleteVelocityRows) {
  Model<Bodies<Rigid<>>, Joints<Joint<KnifeEdge, Constraint>>> model;
  auto const sledge = model.add(Rigid<>::from(bar()), "sledge");
  model.connect(Joint<KnifeEdge, Constraint>{{.across = Vec3::UnitY()}}, model.ground().at({0, 0, 0}), sledge.at(0.0));
  expect_exact(model, {.speed = 0.0});
}

TEST(TurnedIncrements, AreNoneWhereNothingTurns) {
  auto const model = pair_of(AncfCable<>::from(bar(), 1), AncfCable<>::from(bar(), 1));
  System system(model, with<Entries::tangent>);
  TurnedIncrements turned(system);
  EXPECT_FALSE(turned.any());
  VecX const u = numbers(system.size(), 1.0, 0.3);
  VecX same = u;
  turned.to_increments(same);
  turned.transpose_to_increments(same);
  EXPECT_EQ(same, u);
}

// yᵀ (T⁻¹ u) = (T⁻ᵀ y)ᵀ u
TEST(TurnedIncrements, AreTransposed) {
  auto const model = pair_of(Rigid<>::from(bar()), Rigid<>::from(bar()));
  System system(model, with<Entries::tangent>);
  TurnedIncrements turned(system);
  ASSERT_TRUE(turned.any());
  turned.set(system, numbers(system.speeds(), 0.8, 0.4));
  VecX const u = numbers(system.size(), 1.0, 0.3), y = numbers(system.size(), 1.0, 0.7);
  VecX to = u, back = y;
  turned.to_increments(to);
  turned.transpose_to_increments(back);
  EXPECT_GT((to - u).norm(), 0.1);
  EXPECT_NEAR(y.dot(to), back.dot(u), 1e-14);
}

}  // namespace turned_increments_test
