#include <polybody/bodies/rigid/variable_mass.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/testing/body_law_definitions.hpp>

#include "support/refusal.hpp"

using namespace polybody;

namespace changing_test {

using Plane = VariableMass<planar::Rigid>;
using Space = VariableMass<Rigid<>>;

Placement const placed = Placement::at({0.3, -0.2, 0.0});

/// Body of 5 kg that loses 2 kg/s.
Plane leaking() {
  return Plane([](double t) { return planar::Rigid(5.0 - 2.0 * t, 0.4 - 0.1 * t, placed); });
}

struct PlaneCase {
  static Plane body() { return leaking(); }
  static std::vector<Plane::Point> points() { return {body().at(Vec2(0, 0)), body().at(Vec2(0.3, -0.1))}; }
  static double mass() { return 5.0; }
  static Vec3 centre() { return placed.origin; }
};
bool const plane_obeys = laws::obeys<PlaneCase, laws::BodyLaws>("ChangingInThePlane");

struct SpaceCase {
  static Space body() {
    return Space([](double t) { return Rigid<>(3.0 + t, Mat3(Vec3(0.3, 0.4, 0.5).asDiagonal()) * (1.0 + t), placed); });
  }
  static std::vector<Space::Point> points() { return {body().at(Vec3(0, 0, 0)), body().at(Vec3(0.3, -0.1, 0.2))}; }
  static double mass() { return 3.0; }
  static Vec3 centre() { return placed.origin; }
};
bool const space_obeys = laws::obeys<SpaceCase, laws::BodyLaws>("ChangingInSpace");

using Push = PointForce<>;
using Pin = Joint<planar::Revolute, Constraint>;

/// Errors of height and velocity of a rocket after one second relative to [Tsiolkovsky 1903]: v = u ln(m₀/m) − g t,
/// and its integral.
template <class I>
double error_of_rocket(I const& integrator, double h) {
  constexpr double m0 = 5.0, rate = 2.0, u = 40.0, g = 9.81;
  Model<Bodies<Plane>, Joints<>, Forces<Push>> model{Gravity{0, -g, 0}};
  auto const rocket = model.add(leaking(), "rocket");
  model.apply(Push{.force = {0, rate * u, 0}}, rocket.at(Vec2(0, 0)), "thrust");
  State x = model.reference_state();
  simulate(model, x, integrator, {.end_time = 1.0, .step = h}).run();
  double const m = m0 - rate, speed = u * std::log(m0 / m) - g;
  double const height = placed.origin[1] + u * (1.0 - m / rate * std::log(m0 / m)) - 0.5 * g;
  return std::hypot(x.q[1] - height, x.v[1] - speed);
}

TEST(VariableMass, ARocketRisesAsItShould) {
  double const coarse = error_of_rocket(GeneralisedAlpha{.rho_inf = 0.8}, 1e-2),
               fine = error_of_rocket(GeneralisedAlpha{.rho_inf = 0.8}, 5e-3);
  EXPECT_LT(fine, 1e-4);
  EXPECT_NEAR(coarse / fine, 4.0, 0.3);
  double const by_four = error_of_rocket(RungeKutta4<>{}, 0.1), by_eight = error_of_rocket(RungeKutta4<>{}, 0.05);
  EXPECT_LT(by_four, 1e-4);
  EXPECT_NEAR(by_four / by_eight, 16.0, 2.0);
}

TEST(VariableMass, ATorqueTurnsWhatIsLeft) {
  Model<Bodies<Plane>, Joints<>, Forces<PointMoment<>>> model;
  auto const wheel = model.add(leaking(), "wheel");
  model.apply(PointMoment<>{.moment = {0, 0, 0.3}}, wheel.at(Vec2(0, 0)), "torque");
  State x = model.reference_state();
  x.v[2] = 1.0;
  simulate(model, x, RungeKutta4<>{}, {.end_time = 1.0, .step = 1e-2}).run();
  EXPECT_NEAR(x.v[2], 1.0 + 0.3 / 0.1 * std::log(0.4 / 0.3), 1e-9);  // τ/J' ln(J₀/J)
  EXPECT_NEAR(energy(model, x).kinetic, 0.5 * 0.3 * x.v[2] * x.v[2], 1e-9);
}

/// Rod on a pin with the mass m₀ (1 − t/2) or a constant mass: angle after one second, and force in the pin.
template <class Rod, class Policy>
std::array<double, 2> swing(Rod const& body) {
  using Hinge = Joint<planar::Revolute, Policy>;
  Model<Bodies<Rod>, Joints<Hinge>> model{Gravity{0, -9.81, 0}};
  auto const rod = model.add(body, "rod");
  auto const pin = model.connect(Hinge{}, model.ground().at(Vec3(-0.5, 0, 0)), rod.at(Vec2(-0.5, 0)), "pin");
  State x = model.reference_state();
  simulate(model, x, GeneralisedAlpha{.tolerance = 1e-12}, {.end_time = 1.0, .step = 1e-2}).run();
  return {x.q[2], reaction(model, x, pin).f.norm()};
}

TEST(VariableMass, APendulumSwingsAsOneWhoseMassStays) {
  Plane const leaks([](double t) { return planar::Rigid(2.0 * (1.0 - 0.5 * t), 0.25 * (1.0 - 0.5 * t)); });
  auto const stays = swing<planar::Rigid, Constraint>(planar::Rigid(2.0, 0.25));
  auto const by_rows = swing<Plane, Constraint>(leaks), by_angle = swing<Plane, JointCoordinates>(leaks);
  EXPECT_NEAR(by_rows[0], stays[0], 1e-9);
  EXPECT_NEAR(by_rows[1], 0.5 * stays[1], 1e-8);
  EXPECT_NEAR(by_angle[0], stays[0], 1e-3);  // with another discretisation
  EXPECT_NEAR(by_angle[1], 0.5 * stays[1], 1e-2);
}

TEST(VariableMass, RefusesALawThatMovesTheBodyOrLosesItsMass) {
  EXPECT_TRUE(has(refusal([] { Plane(Plane::Law{}); }), "the function of time is empty"));
  EXPECT_TRUE(has(refusal([] { Plane([](double) { return planar::Rigid(0.0, 0.0); }); }), "mass"));
  Plane const moves([](double t) { return planar::Rigid(1.0, 1.0, Placement::at({t, 0, 0})); });
  EXPECT_TRUE(has(refusal([&] { (void)moves.at_time(0.5); }), "at t = 0.5 s the function places the body elsewhere"));
  Model<Bodies<Plane>, Joints<>> model{Gravity{0, -9.81, 0}};
  model.add(leaking(), "tank");
  State x = model.reference_state();
  std::string const said = refusal([&] { simulate(model, x, RungeKutta4<>{}, {.end_time = 3.0, .step = 1e-2}).run(); });
  EXPECT_TRUE(has(said, "planar::Rigid: the mass")) << said;
  EXPECT_NEAR(x.t, 2.5, 0.011);
  EXPECT_TRUE(x.q.allFinite() && x.v.allFinite());
}

}  // namespace changing_test
