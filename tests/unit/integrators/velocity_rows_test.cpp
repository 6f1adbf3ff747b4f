// The requirements on integrators, for a model with both kinds of constraint equations: one holonomic, two
// nonholonomic.

#include <polybody/integrators/coordinate_partitioning.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/joints/nonholonomic.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/testing/integrator_laws.hpp>

#include "support/solver_instances.hpp"

namespace polybody {
using namespace laws;
namespace velocity_rows_test {

/// A disc of 0.4 m that rolls and wobbles; its axis is inclined by 0.35 rad.
struct WobblingDisc {
  using Wheel = Joint<RollingDisc, Constraint>;
  using ModelType = Model<Bodies<Rigid<>>, Joints<Wheel>>;
  Vec3 axis{std::cos(0.35), 0, std::sin(0.35)};
  ModelType model{Gravity{0, 0, -9.81}};
  BodyHandle<Rigid<>> wheel = model.add(Rigid<>(2.0, Vec3(0.16, 0.08, 0.08).asDiagonal().toDenseMatrix(),
                                                Placement::at({0, 0, 0.4 * std::cos(0.35)}, {0, -0.35, 0})),
                                        "wheel");
  State start;

  WobblingDisc() {
    model.connect(Wheel{{.radius = 0.4, .axis = axis, .normal = Vec3::UnitZ()}, {}}, model.ground().at({0, 0, 0}),
                  wheel.at(Vec3::Zero()), "contact");
    start = model.reference_state();
    Vec3 const w = -5.0 * axis + Vec3(0.3, 0.4, 1.0), contact(0.4 * std::sin(0.35), 0, 0);
    model.set_velocity(start, wheel, -w.cross(contact), w);
  }
};

struct AlphaOnTheDisc {
  using Model = WobblingDisc;
  static auto integrators() {
    return std::vector{GeneralisedAlpha{.rho_inf = 0.8}, GeneralisedAlpha{.rho_inf = 0.8, .stabilised = true}};
  }
  static constexpr double end_time = 0.5;
  static constexpr int steps = 64;
};
struct PartitionedDisc {
  using Model = WobblingDisc;
  static auto integrators() { return std::vector<RungeKutta4<CoordinatePartitioning>>(1); }
  static constexpr double end_time = 0.5;
  static constexpr int steps = 16;
};

bool const velocity_rows_obey[] = {obeys<AlphaOnTheDisc, IntegratorLaws>("VelocityRows"),
                                   obeys<PartitionedDisc, IntegratorLaws>("PartitionedVelocityRows")};

// The contact constraint makes one coordinate dependent; all constraint equations together make three velocities
// dependent.
TEST(CoordinatePartitioning, SplitsCoordinatesBySurfacesAndSpeedsByAllRows) {
  WobblingDisc disc;
  System system(disc.model);
  CoordinatePartitioning const policy;
  CoordinatePartitioning::Scratch scratch(system);
  ForwardDynamics<> forward(system);
  State x = disc.start;
  policy.start(scratch);
  policy.apply(system, forward, scratch, x.q, x.v, 0.0);
  EXPECT_EQ(scratch.rows.rank(), 1);
  EXPECT_EQ(scratch.all_rows.rank(), 3);
}

// The projection returns a position to the plane and makes slipping velocities roll. It does not change positions to
// satisfy the rolling constraint.
TEST(VelocityRows, AreLeftAloneByProjectionsOfPositions) {
  WobblingDisc disc;
  State x = disc.start;
  x.q.head<3>() += Vec3(0.5, -0.3, 1e-3);
  x.v.head<3>() += Vec3(0.1, 0.2, 0.3);
  assemble(disc.model, x);
  System system(disc.model);
  system.evaluate(x.q, x.v, x.t);
  VecX rate = VecX::Zero(3);
  system.violation_rate(rate);
  EXPECT_LT(largest_violation(system, x).position, 1e-12);
  EXPECT_LT(rate.norm(), 1e-12);
  EXPECT_LT((x.q.head<2>() - Vec2(0.5, -0.3)).norm(), 2e-3);
}

}  // namespace velocity_rows_test
}  // namespace polybody
