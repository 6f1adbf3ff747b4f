// Differential between a carrier and two shafts, compared with closed forms and with gears.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/differential.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/gears.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/energy_audit.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"

namespace polybody {
namespace differential_test {

using Pin = Joint<Revolute>;
Pin const about_z{Revolute{.axis = Vec3::UnitZ()}};
Rigid<> disc(double inertia, Vec3 const& centre = Vec3::Zero()) {
  return {1.0, Mat3(Mat3::Identity() * inertia), Placement::at(centre)};
}
Claim closed_form(char const* what, char const* source, char const* formulation = "Differential, Radau IIA") {
  return {"drives", what, By::closed_form, source, formulation};
}

/// Carrier and shafts on one axis, with moments on all three.
struct Axle {
  Model<Bodies<Rigid<>>, Joints<Pin>, Forces<Differential, PointMoment<>>> model;
  std::array<ElementHandle<Pin>, 3> pins;
  ElementHandle<Differential> gears;
  State x;

  Axle(Vec3 const& inertias, Vec3 const& moments, double stiffness = 2e4) {
    std::array<BodyHandle<Rigid<>>, 3> shafts;
    std::array const names = {"carrier", "left", "right"};
    for (std::size_t k = 0; k < 3; ++k) {
      shafts[k] = model.add(disc(inertias[Index(k)]), names[k]);
      pins[k] = model.connect(about_z, model.ground().at({0, 0, 0}), shafts[k].at({0, 0, 0}));
      model.apply(PointMoment<>{.moment = {0, 0, moments[Index(k)]}}, shafts[k].at({0, 0, 0}));
    }
    gears = model.apply(Differential{.stiffness = stiffness, .damping = 20.0},
                        std::tuple(shafts[0].at({0, 0, 0}), shafts[1].at({0, 0, 0}), shafts[2].at({0, 0, 0})),
                        "differential");
    x = model.reference_state();
  }
  Vec3 speeds() const {
    Vec3 w;
    for (std::size_t k = 0; k < 3; ++k) w[Index(k)] = joint_angle_rate(model, x, pins[k]);
    return w;
  }
};

/// Constant accelerations with ω_l + ω_r = 2 ω_c and equal torques T of the shafts: α_k = (M_k + T)/J_k for the shafts,
/// α_c = (M_c − 2 T)/J_c.
struct Ideal {
  double torque;
  Vec3 rates;
  Ideal(Vec3 const& j, Vec3 const& m)
      : torque((2.0 * m[0] / j[0] - m[1] / j[1] - m[2] / j[2]) / (1.0 / j[1] + 1.0 / j[2] + 4.0 / j[0])),
        rates((m[0] - 2.0 * torque) / j[0], (m[1] + torque) / j[1], (m[2] + torque) / j[2]) {}
};

void expect_ideal(Vec3 const& inertias, Vec3 const& moments, char const* what) {
  Axle axle(inertias, moments);
  Ideal const ideal(inertias, moments);
  double const end = 5.0;
  EnergyAudit audit(axle.model);
  for (State const& now : simulate(axle.model, axle.x, Radau{}, {.end_time = end, .step = 1e-3})) audit.record(now);
  EXPECT_LT(audit.relative(), 1e-6) << audit;
  EXPECT_EQ(audit.powers().loads != 0.0, true);
  Vec3 const speeds = axle.speeds();
  auto const w = applied_wrenches(axle.model, axle.x, axle.gears);
  Instance const at{what, 10.0};
  held(closed_form("ω_l + ω_r − 2 ω_c of a differential [rad/s]", "0"), speeds[1] + speeds[2] - 2.0 * speeds[0], 0.0,
       1e-6, at);
  held(closed_form("difference of the torques of its shafts [N m]", "0"), w[1].m.z() - w[2].m.z(), 0.0, 1e-12, at);
  held(closed_form("torque of a shaft of a differential [N m]", "equations of motion without compliance"), w[1].m.z(),
       ideal.torque, 1e-6, at);
  EXPECT_LT((w[0].m + 2.0 * w[1].m).norm(), 1e-10);
  // The twist under the constant torque is 2 T/k; it delays the speeds until the vibration has decayed.
  for (Index k = 0; k < 3; ++k)
    held(closed_form("speeds of carrier and shafts [rad/s]", "equations of motion without compliance"), speeds[k],
         ideal.rates[k] * end, 1e-4, {std::string(what) + ", body " + std::to_string(k), 10.0});
}
TEST(Differential, DividesTheTorqueEquallyAndTheSpeedsFreely) {
  expect_ideal({0.2, 0.5, 0.5}, {4.0, 0.0, 0.0}, "straight");
  expect_ideal({0.2, 0.5, 0.5}, {4.0, -1.5, -0.5}, "turn");
  expect_ideal({0.2, 0.5, 2.0}, {4.0, 0.3, -1.0}, "unequal shafts");
  expect_ideal({0.2, 0.5, 1e9}, {4.0, 0.0, 0.0}, "right shaft blocked");
}
TEST(Differential, TurnsTheFreeShaftTwiceAsFastIfTheOtherOneIsBlocked) {
  Vec3 const w = Ideal({0.2, 0.5, 1e9}, {4.0, 0.0, 0.0}).rates;
  EXPECT_NEAR(w[1], 2.0 * w[0], 1e-8);
  EXPECT_NEAR(w[0], 4.0 / (0.2 + 4.0 * 0.5), 1e-7);  // α_c (J_c + 4 J_l) = M_c
}

// Many turns: the twist stays that of the torque, also from a state in which a shaft has turned by more than half a
// turn.
TEST(Differential, CountsFullTurns) {
  Axle axle({0.2, 0.5, 1e9}, {4.0, 0.0, 0.0});
  simulate(axle.model, axle.x, Radau{}, {.end_time = 10.0, .step = 0.01}).run();
  double const torque = Ideal({0.2, 0.5, 1e9}, {4.0, 0.0, 0.0}).torque;
  EXPECT_GT(std::abs(joint_angle_rate(axle.model, axle.x, axle.pins[1])) * 5.0, 20.0 * std::numbers::pi);
  EXPECT_NEAR(axle.model.states(std::as_const(axle.x), axle.gears)[0], -4.0 * torque / 2e4, 1e-6);
}

// A differential of spur gears without compliance: suns of the shafts, and two planets on the carrier that mesh with
// each other.
TEST(Differential, AgreesWithADifferentialOfGears) {
  using Gears = Joint<Gear>;
  Model<Bodies<Rigid<>>, Joints<Pin, Gears>, Forces<PointMoment<>>> model;
  Vec3 const inertias(0.2, 0.5, 0.7), moments(4.0, -1.0, 0.2);
  std::array<BodyHandle<Rigid<>>, 5> bodies;
  std::array<ElementHandle<Pin>, 5> pins;
  for (std::size_t k = 0; k < 3; ++k) {
    bodies[k] = model.add(disc(inertias[Index(k)]));
    pins[k] = model.connect(about_z, model.ground().at({0, 0, 0}), bodies[k].at({0, 0, 0}));
    model.apply(PointMoment<>{.moment = {0, 0, moments[Index(k)]}}, bodies[k].at({0, 0, 0}));
  }
  std::array const centres = {Vec3(0.1, 0.05, 0), Vec3(0.1, -0.05, 0)};
  double const planet = 1e-3;
  for (std::size_t k = 0; k < 2; ++k) {
    bodies[3 + k] = model.add(disc(planet, centres[k]));
    pins[3 + k] = model.connect(about_z, bodies[0].at(centres[k]), bodies[3 + k].at({0, 0, 0}));
  }
  auto const mesh = [&](std::size_t a, std::size_t b, Vec3 const& line) {
    model.connect(Gears{Gear{.teeth_a = 20, .teeth_b = 20, .axis = Vec3::UnitZ(), .centres = Vec3(line.normalized())}},
                  bodies[a].at({0, 0, 0}), bodies[b].at({0, 0, 0}));
  };
  mesh(1, 3, centres[0]);
  mesh(3, 4, centres[1] - centres[0]);
  mesh(4, 2, -centres[1]);
  State x = model.reference_state();
  simulate(model, x, Radau{}, {.end_time = 1.0, .step = 0.01}).run();
  // T = ½ J_l ω_l² + ½ J_r ω_r² + ½ (J_c + 2 J + 2 m d²) ω_c² + J (ω_l − ω_r)²/4 with ω_c = (ω_l + ω_r)/2
  double const carrier = 0.25 * (inertias[0] + 2.0 * planet + 2.0 * centres[0].squaredNorm()), own = 0.5 * planet;
  Mat<double, 2, 2> mass;
  mass << inertias[1] + carrier + own, carrier - own, carrier - own, inertias[2] + carrier + own;
  Vec2 const shafts = mass.inverse() * Vec2(moments[1] + 0.5 * moments[0], moments[2] + 0.5 * moments[0]);
  Vec3 const rates(0.5 * shafts.sum(), shafts[0], shafts[1]);
  for (std::size_t k = 0; k < 3; ++k)
    held(closed_form("speeds of carrier and shafts of a differential of gears [rad/s]", "Lagrange's equations",
                     "three Gear joints, Radau IIA"),
         joint_angle_rate(model, x, pins[k]), rates[Index(k)], 1e-6, {equals("body", double(k)), 10.0});
}

}  // namespace differential_test
}  // namespace polybody
