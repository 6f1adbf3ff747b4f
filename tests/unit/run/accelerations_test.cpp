// Accelerations of points and bodies in a state.
#include <polybody/run/accelerations.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/integrators/energy_momentum.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/integrators/symplectic.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/statics/equilibrium.hpp>

#include "support/refusal.hpp"

using namespace polybody;

namespace accelerations_test {

double const g = 9.81;

/// Thin rod of length l along x on a pin at its first end.
template <class Policy = Constraint>
struct Pendulum {
  static constexpr double l = 0.8;
  using Pin = Joint<planar::Revolute, Policy>;
  Model<Bodies<planar::Rigid>, Joints<Pin>> model;
  BodyHandle<planar::Rigid> rod = model.add(planar::Rigid(1.5, 1.5 * l * l / 12, Placement::planar(0.5 * l, 0)), "rod");
  State x;

  explicit Pendulum(double gravity) : model{Gravity{0, -gravity, 0}} {
    model.connect(Pin{}, model.ground().at({0, 0, 0}), rod.at(Vec2(-0.5 * l, 0)), "pin");
    x = model.reference_state();
  }
  Marker<planar::Rigid> tip() const { return rod.at(Vec2(0.5 * l, 0)); }
};

// Released from the horizontal: θ̈ = −3g/2l, so the tip falls with 3g/2 and the centre with 3g/4.
TEST(Acceleration, OfAReleasedPendulumIsThatOfTheHandCalculation) {
  Pendulum p(g);
  compute_accelerations(p.model, p.x);
  EXPECT_LT((acceleration(p.model, p.x, p.tip()) - Vec3(0, -1.5 * g, 0)).norm(), 1e-12);
  EXPECT_LT((acceleration(p.model, p.x, p.rod.centre()) - Vec3(0, -0.75 * g, 0)).norm(), 1e-12);
  EXPECT_LT((angular_acceleration(p.model, p.x, p.tip()) - Vec3(0, 0, -1.5 * g / p.l)).norm(), 1e-12);
  EXPECT_EQ(acceleration(p.model, p.x, p.model.ground().at({1, 2, 3})).norm(), 0.0);
  auto const a = accelerations_of(p.model, p.x, p.rod);
  ASSERT_EQ(a.size(), 3u);
  EXPECT_NEAR(a[2], -1.5 * g / p.l, 1e-12);
  // the multipliers belong to them: the pin carries mg/4
  EXPECT_NEAR(p.x.lambda.norm(), 0.25 * 1.5 * g, 1e-12);
}

/// Largest error of the tip's acceleration in the states of a run, against a = θ̈ e_t l − θ̇² e_r l with θ̈ = −(3g/2l) cos
/// θ.
template <class Policy = Constraint, class I>
double error_over_a_run(I const& integrator, double gravity, double rate, double step) {
  Pendulum<Policy> p(gravity);
  p.model.set_velocity(p.x, p.rod, Vec3::Zero(), {0, 0, rate});
  double worst = 0.0;
  for (State const& now : simulate(p.model, p.x, integrator, {.end_time = 0.5, .step = step})) {
    double const angle = now.q[2], w = now.v[2];
    Vec3 const r(std::cos(angle), std::sin(angle), 0), t(-r[1], r[0], 0);
    Vec3 const exact = p.l * (-1.5 * gravity / p.l * std::cos(angle) * t - w * w * r);
    worst = std::max(worst, (acceleration(p.model, now, p.tip()) - exact).norm());
  }
  return worst;
}

// The states of a run have the accelerations of their own time. The generalised-α method and Rattle satisfy the second
// derivative of the constraint equations to the order of the step only.
TEST(Acceleration, InStatesOfARunIsThatOfTheEquationsOfMotion) {
  EXPECT_LT(error_over_a_run(RungeKutta4<Projection>{}, g, 2.0, 2e-3), 1e-8);
  EXPECT_LT(error_over_a_run(Radau{}, g, 2.0, 2e-3), 1e-6);
  EXPECT_LT(error_over_a_run(Rattle{}, g, 2.0, 2e-3), 5e-3);
  GeneralisedAlpha const alpha{.rho_inf = 0.8, .stabilised = true};
  double const error = error_over_a_run(alpha, g, 2.0, 2e-3);
  EXPECT_LT(error, 1e-3);
  EXPECT_NEAR(error / error_over_a_run(alpha, g, 2.0, 1e-3), 4.0, 0.5);
  EXPECT_LT(error_over_a_run<JointCoordinates>(GeneralisedAlpha{.rho_inf = 0.8}, g, 2.0, 2e-3), 1e-6);
}

// A disk with constant rate: a = −ω² r, also for a marker off the axis in space.
TEST(Acceleration, OfARotatingDiskIsCentripetal) {
  EXPECT_LT(error_over_a_run(RungeKutta4<Projection>{}, 0.0, 20.0, 2e-3), 1e-6);
  using Pin = Joint<Revolute, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Pin>> model;
  auto const disk = model.add(Rigid<>(2.0, Mat3(Vec3(0.1, 0.1, 0.2).asDiagonal())), "disk");
  model.connect(Pin{Revolute{.axis = {0, 0, 1}}}, model.ground().at({0, 0, 0}), disk.centre(), "pin");
  State x = model.reference_state();
  model.set_velocity(x, disk, Vec3::Zero(), {0, 0, 7.0});
  for (State const& now : simulate(model, x, RungeKutta4<Projection>{}, {.end_time = 0.4, .step = 1e-3})) {
    auto const m = disk.at({0.3, -0.1, 0.2});
    Vec3 r = position(model, now, m);
    r[2] = 0.0;
    EXPECT_LT((acceleration(model, now, m) + 49.0 * r).norm(), 1e-8);
  }
}

// The accelerations of EnergyMomentum are means of the last step. compute_accelerations gives those of the state.
TEST(Acceleration, OfEnergyMomentumNeedsForwardDynamics) {
  double const step = 0.02;
  EXPECT_GT(error_over_a_run(EnergyMomentum{}, g, 2.0, step), 0.05);
  Pendulum p(g);
  simulate(p.model, p.x, EnergyMomentum{}, {.end_time = 0.5, .step = step}).run();
  compute_accelerations(p.model, p.x);
  double const angle = p.x.q[2], w = p.x.v[2];
  EXPECT_NEAR(angular_acceleration(p.model, p.x, p.tip())[2], -1.5 * g / p.l * std::cos(angle), 1e-9);
  EXPECT_NEAR(acceleration(p.model, p.x, p.tip()).norm(), p.l * std::hypot(1.5 * g / p.l * std::cos(angle), w * w),
              1e-6);
}

// At a point of a bent beam, against second differences of its positions.
TEST(Acceleration, OfABeamIsTheSecondDifferenceOfItsPosition) {
  using Clamp = Joint<planar::Revolute, Constraint>;
  Model<Bodies<planar::Lrvf>, Joints<Clamp>> model{Gravity{0, -g, 0}};
  Bar const bar{.length = 1.0,
                .constants = BarConstants{.EA = 90, .EI = 4, .mass_per_length = 2.0, .GA = 30, .rotary_inertia = 0.05}};
  auto const beam = model.add(planar::Lrvf::from(bar, 3), "beam");
  model.connect(Clamp{}, model.ground().at({0, 0, 0}), beam.at(0.0), "pin");
  State x = model.reference_state();
  double const h = 1e-3;
  std::vector<Vec3> r, a;
  for (State const& now : simulate(model, x, RungeKutta4<Projection>{}, {.end_time = 0.3, .step = h})) {
    r.push_back(position(model, now, beam.at(0.7)));
    a.push_back(acceleration(model, now, beam.at(0.7)));
  }
  for (std::size_t i = 1; i + 1 < r.size(); ++i)
    EXPECT_LT((a[i] - (r[i + 1] - 2.0 * r[i] + r[i - 1]) / (h * h)).norm(), 2e-3) << i;
  EXPECT_GT(a.back().norm(), 1.0);
}

// A state without accelerations does not answer with zero.
TEST(Acceleration, RefusesAStateWithoutAccelerations) {
  Pendulum p(g), other(g);
  EXPECT_TRUE(has(refusal([&] { (void)acceleration(p.model, p.x, p.tip()); }),
                  "has no accelerations: all are zero, but its forces are not in equilibrium. Call "
                  "compute_accelerations(model, x)"));
  EXPECT_TRUE(has(refusal([&] { (void)accelerations_of(p.model, p.x, p.rod); }), "has no accelerations"));
  EXPECT_TRUE(has(refusal([&] { (void)acceleration(p.model, p.x, other.tip()); }), "another model"));
  State longer = p.x;
  longer.a.resize(4);
  EXPECT_TRUE(has(refusal([&] { (void)acceleration(p.model, longer, p.tip()); }), "does not fit"));
}

// At rest in equilibrium, and without forces, zero is right.
TEST(Acceleration, IsZeroInEquilibrium) {
  Pendulum hanging(g), free(0.0);
  hanging.x.q << 0.0, -0.5 * hanging.l, -0.5 * std::numbers::pi;
  equilibrium(hanging.model, hanging.x);
  EXPECT_EQ(acceleration(hanging.model, hanging.x, hanging.tip()).norm(), 0.0);
  EXPECT_EQ(acceleration(free.model, free.x, free.tip()).norm(), 0.0);
}

}  // namespace accelerations_test
