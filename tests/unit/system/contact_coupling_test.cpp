// Blocks between the bodies of contacts: coupled solutions against the Jacobian of the residual by finite differences,
// and the number of iterations of piles.
#include <polybody/system/contact_coupling.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/contact_set.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/step_tangent.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/solvers/default_solver.hpp>

using namespace polybody;

namespace contact_coupling_test {

using Set = ContactSet<Shapes<Sphere, Box, Plane>>;

/// Balls and boxes of 1 kg in columns of 2 × 2 bodies, slightly out of line, on a plane.
struct Pile {
  Model<Bodies<Rigid<>>, Joints<>, Forces<Set>> model{Gravity{0, 0, -9.81}};

  /// \param distance height of a layer [m]; less than 0.2 m if the bodies shall overlap
  Pile(int bodies, double slip_speed, double distance, double friction = 0.4) {
    auto const set = model.apply(
        Set{{.stiffness = 1e4, .damping = 60.0, .onset = 1e-3}, {.coefficient = friction, .slip_speed = slip_speed}},
        "pile");
    model.add_member(set, Plane{}, model.ground().at({0, 0, 0}), "floor");
    for (int i = 0; i < bodies; ++i) {
      Vec3 const at(0.195 * (i % 2) + 0.005 * std::sin(i), 0.195 * (i / 2 % 2) + 0.005 * std::cos(3.0 * i),
                    0.098 + distance * (i / 4));
      Vec3 const turn(0.1 * std::sin(2.0 * i), 0.1 * std::cos(5.0 * i), 0.3 * std::sin(7.0 * i));
      auto const centre = model.add(Rigid<>(1.0, 0.004 * Mat3::Identity(), Placement::at(at, turn))).centre();
      if (i % 7 == 2 || i % 7 == 5)
        model.add_member(set, Box{.size = {0.18, 0.17, 0.16}, .rounding = 0.02, .taper = 1e-4}, centre);
      else
        model.add_member(set, Sphere{.radius = 0.1}, centre);
    }
  }
};

/// Equations of a step of a pile, with a smooth motion as accelerations and velocities.
struct Step {
  Pile pile;
  State x = pile.model.reference_state();
  System system{pile.model, with<Capabilities::implicit_step>};
  StepTangent<BlockSolver> tangent;
  Index n = system.velocities();
  VecX rhs = VecX::Zero(n), y = rhs;

  /// \param speed magnitude of the velocities [m/s] and [rad/s]
  Step(double slip_speed, double speed, SecondOrder terms = SecondOrder::omitted) : pile(8, slip_speed, 0.195) {
    for (Index i = 0; i < n; ++i) {
      x.v[i] = speed * std::sin(1.7 * double(i) + 0.3);
      x.a[i] = speed * std::cos(2.3 * double(i));
      rhs[i] = std::sin(0.9 * double(i));
    }
    system.evaluate(x.q, x.v, x.t);
    tangent.analyse(system, terms, x.lambda);
  }
  StepPosition place() const { return {{x.q, x.v, x.t}, x.a, x.lambda}; }
  /// Solves with the tangent for the factors `k`.
  VecX const& solve(TangentCoefficients const& k) {
    system.evaluate(x.q, x.v, x.t);
    tangent.begin_step();
    EXPECT_EQ(tangent.factor(system, place(), k), -1);
    tangent.correct(rhs, y);
    return y;
  }
  /// Residual with the factors `k` of the motion along s d (nv).
  VecX residual(TangentCoefficients const& k, VecX const& d, double s) {
    VecX const dq = s * k.stiffness * d, v = x.v + s * k.damping * d, a = x.a + s * k.mass * d;
    VecX q = x.q, r = VecX::Zero(n);
    system.plus(x.q, dq, q);
    system.evaluate(q, v, x.t);
    system.residual(a, x.lambda, r);
    return r;
  }
  /// Dense Jacobian of the residual by central differences over 2e-6 times the factors.
  MatX jacobian(TangentCoefficients const& k) {
    MatX out(n, n);
    for (Index j = 0; j < n; ++j) {
      VecX const unit = VecX::Unit(n, j);
      out.col(j) = (residual(k, unit, 1e-6) - residual(k, unit, -1e-6)) / 2e-6;
    }
    return out;
  }
};

// Coupled solutions satisfy the dense equations to the relative residual 1e-3 of `StepTangent`. The differences add
// less than 1e-6. Bodies slide with up to twice the slip speed.
TEST(ContactCoupling, SolvesTheEquationsOfAllBodiesInMotion) {
  Step step(0.05, 0.1);
  TangentCoefficients const k{.mass = 1.0, .damping = 1e-3};
  MatX const jacobian = step.jacobian(k);
  EXPECT_LT((jacobian * step.solve(k) - step.rhs).norm(), 1.001e-3 * step.rhs.norm());
  // without the blocks between bodies, the same solver misses this bound by far
  VecX apart = step.y;
  step.tangent.solver().solve(step.rhs, apart);
  EXPECT_GT((jacobian * apart - step.rhs).norm(), 0.05 * step.rhs.norm());
  EXPECT_GT((jacobian - jacobian.transpose()).norm(), 1e-3 * jacobian.norm());
}

// At rest, the derivative with respect to the positions is exact too, with second-order terms and with the derivatives
// of contacts.
TEST(ContactCoupling, SolvesTheEquationsOfAllBodiesAtRest) {
  Step step(0.05, 0.0, SecondOrder::included);
  TangentCoefficients k{.mass = 1.0, .damping = 1e-3, .stiffness = 1e-4, .surrogate_friction = false};
  MatX const jacobian = step.jacobian(k);
  EXPECT_LT((jacobian * step.solve(k) - step.rhs).norm(), 1.01e-3 * step.rhs.norm());
}

// A block of 1 kg with the velocity 1 m/s comes to rest in a step of 1 s under the friction 2 N and the force 1.5 N:
// v + 2 v/√(v² + v_s²) = 1.5. Newton's method for v alone alternates between both signs of v. With the friction ratio,
// the number of iterations hardly depends on v_s.
TEST(FrictionRatios, ConvergeFromFarSlipVelocities) {
  for (double const slip_speed : {1e-2, 1e-4, 1e-6, 1e-8}) {
    FrictionRatios ratios;
    double v = 1.0, change = 1.0;
    int count = 0;
    while (std::abs(change) > 1e-9 * slip_speed && count < 30) {
      double const s = std::hypot(v, slip_speed);
      ratios.begin();
      double const w = ratios.ratio({0, 1, 0}, Vec3(v, 0, 0), s)[0];
      change = (1.5 - v - 2.0 * v / s) / (1.0 + 2.0 / s * (1.0 - w * v / s));
      v += change;
      ++count;
    }
    EXPECT_LE(count, 12) << slip_speed;
    EXPECT_NEAR(v + 2.0 * v / std::hypot(v, slip_speed), 1.5, 1e-12);
  }
}

// The ratios belong to contact points, and not to the order of their evaluation.
TEST(FrictionRatios, FollowTheirContactPoints) {
  FrictionRatios ratios;
  Vec3 const x(1, 0, 0), y(0, 1, 0);
  ratios.begin();
  ratios.ratio({4, 2, 0}, x, 2.0);
  ratios.ratio({1, 2, 7}, y, 2.0);
  ratios.begin_step();
  ratios.begin();
  EXPECT_EQ(ratios.ratio({1, 2, 7}, x, 4.0), Vec3(0.5 * y));
  EXPECT_EQ(ratios.ratio({1, 2, 8}, x, 4.0), Vec3(0.25 * x));  // a new contact point
  EXPECT_EQ(ratios.ratio({4, 2, 0}, y, 4.0), Vec3(0.5 * x));
  ratios.forget();
  ratios.begin();
  EXPECT_EQ(ratios.ratio({4, 2, 0}, y, 4.0), Vec3(0.25 * y));
}

// 28 bodies collapse within 0.3 s. The limits exceed the numbers of 4.6 and 5.9 iterations per step by a tenth.
TEST(ContactCoupling, PilesNeedFewIterations) {
  struct {
    double slip_speed, most;
  } const limits[] = {{1e-2, 5.0}, {1e-3, 6.5}};
  for (auto const& limit : limits) {
    Pile const pile(28, limit.slip_speed, 0.22);
    State x = pile.model.reference_state();
    RunReport const report = simulate(pile.model, x, GeneralisedAlpha{}, {.end_time = 0.3, .step = 1e-3}).run();
    double const mean = double(report.iterations) / double(report.steps);
    std::printf("v_s = %g m/s: %.2f iterations per step\n", limit.slip_speed, mean);
    EXPECT_LT(mean, limit.most);
    EXPECT_EQ(report.halved, 0);
  }
}

}  // namespace contact_coupling_test
