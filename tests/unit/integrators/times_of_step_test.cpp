// The times at which a step evaluates loads and driving constraints, checked by results that are exact up to
// round-off.
#include <gtest/gtest.h>

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/integrators/energy_momentum.hpp>
#include <polybody/integrators/symplectic.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

namespace times_of_step_test {

using namespace polybody;

/// F = t.
struct Rising {
  Motion operator()(double t) const { return {t, 1.0, 0.0}; }
};
/// s = t³: a wrong time in the step changes the result.
struct Cubic {
  Motion operator()(double t) const { return {t * t * t, 3.0 * t * t, 6.0 * t}; }
};

/// The velocity of a mass of 1 kg under F = t after 10 steps of 0.1 s from t = 0.
template <class I>
double speed_under_a_rising_force(I const& integrator) {
  Model<Bodies<planar::Rigid>, Joints<>, Forces<PointForce<Rising>>> model;
  auto const mass = model.add(planar::Rigid(1.0, 1.0), "mass");
  model.apply(PointForce<Rising>{.force = {1, 0, 0}}, mass.at(Vec2(0, 0)));
  State x = model.reference_state();
  simulate(model, x, integrator, {.end_time = 1.0, .step = 0.1}).run();
  return x.v[0];
}

// Euler's method sums the forces at the beginnings of steps, h Σ t = h² N (N − 1)/2. The trapezoidal and midpoint
// rules are exact.
TEST(TimesOfAStep, OfLoads) {
  EXPECT_NEAR(speed_under_a_rising_force(SymplecticEuler{}), 0.45, 1e-13);
  EXPECT_NEAR(speed_under_a_rising_force(Rattle{}), 0.5, 1e-13);
  Model<Bodies<planar::AncfCable<>>, Joints<>, Forces<PointForce<Rising>>> model;
  auto const cable = model.add(planar::AncfCable<>::from(
      {.length = 1.0, .constants = BarConstants{.EA = 100.0, .EI = 1.0, .mass_per_length = 2.0}}, 2));
  model.apply(PointForce<Rising>{.force = {1, 3, 0}}, cable.at(0.3));
  State x = model.reference_state();
  simulate(model, x, EnergyMomentum{}, {.end_time = 1.0, .step = 0.1}).run();
  Vec3 const p = momentum(model, x).linear;
  EXPECT_NEAR(p[0], 0.5, 1e-9);
  EXPECT_NEAR(p[1], 1.5, 1e-9);
}

// Rattle satisfies the constraint equations at the end of each step, in positions and velocities.
TEST(TimesOfAStep, OfDrivenRows) {
  using Slide = Joint<PrescribedTranslation<Cubic>, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Slide>> model;
  auto const mass = model.add(planar::Rigid(1.0, 1.0), "mass");
  model.connect(Slide{{.law = {}, .axis = Vec3::UnitX()}, {}}, model.ground().at({0, 0, 0}), mass.at(Vec2(0, 0)));
  State x = model.reference_state();
  for (State const& now : simulate(model, x, Rattle{}, {.end_time = 1.0, .step = 0.05})) {
    EXPECT_NEAR(now.q[0], std::pow(now.t, 3), 1e-11);
    EXPECT_NEAR(now.v[0], 3.0 * now.t * now.t, 1e-11);
  }
}

}  // namespace times_of_step_test
