#include <polybody/bodies/rigid/planar_rigid.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/body_laws.hpp>

#include "support/refusal.hpp"

namespace polybody {
using namespace laws;
namespace planar_rigid_test {

struct PlanarRigidCase {
  static Bar bar() {
    return {.length = 1.3,
            .constants = BarConstants{.EA = 900, .EI = 40, .mass_per_length = 2.0, .rotary_inertia = 0.05},
            .placement = Placement::planar(0.4, -0.3, 0.7)};
  }
  static planar::Rigid body(Bar const& bar) { return planar::Rigid::from(bar); }
};
bool const planar_rigid_obeys = obeys<PlanarRigidCase, BodyLaws>("PlanarRigid");

double const nan_ = std::numeric_limits<double>::quiet_NaN();

TEST(PlanarRigid, SpinningBarHasItsKineticEnergy) {
  planar::Rigid const rod = planar::Rigid::from(PlanarRigidCase::bar());
  double const l = 1.3, m = 2.6, inertia = m * l * l / 12.0 + 0.05 * l, omega = 4.0;
  std::array<double, 3> q, v{0.0, 0.0, omega};
  rod.reference(q);
  EXPECT_NEAR(rod.kinetic_energy(0, q, v), 0.5 * inertia * omega * omega, 1e-14);
}

// The angle counts revolutions: the second revolution differs from the first.
TEST(PlanarRigid, CountsItsTurns) {
  planar::Rigid const body(1.0, 0.5, Placement::planar(1.0, 2.0, 3.0));
  std::array<double, 3> q, moved;
  body.reference(q);
  EXPECT_NEAR(q[2], 3.0, 1e-15);
  body.plus<double>(q, std::array{0.5, 0.25, 10.0}, moved);
  EXPECT_EQ(moved[0], 1.5);
  EXPECT_EQ(moved[1], 2.25);
  EXPECT_NEAR(moved[2], 13.0, 1e-15);
}

TEST(PlanarRigid, PointsCountFromTheCentreOfMass) {
  planar::Rigid const rod = planar::Rigid::from(PlanarRigidCase::bar());
  EXPECT_EQ(rod.at(0.0).u, Vec2(-0.65, 0.0));
  EXPECT_EQ(rod.at(1.3, 0.1).u, Vec2(0.65, 0.1));
  EXPECT_EQ(rod.at(Vec2(3.0, -1.0)).u, Vec2(3.0, -1.0));
}

TEST(PlanarRigid, RefusesMassAndInertiaThatAreNone) {
  for (double const m : {0.0, -1.0, nan_})
    EXPECT_TRUE(has(refusal([&] { planar::Rigid(m, 1.0); }), "planar::Rigid: the mass")) << m;
  for (double const j : {-1.0, nan_})
    EXPECT_TRUE(has(refusal([&] { planar::Rigid(1.0, j); }), "planar::Rigid: the inertia")) << j;
  EXPECT_NO_THROW(planar::Rigid(1.0, 0.0));  // a point mass
}

TEST(PlanarRigid, RefusesToLeaveThePlane) {
  for (Placement const& p : {Placement::at({0, 0, 0.1}), Placement::at({0, 0, 0}, {0.1, 0, 0})}) {
    EXPECT_TRUE(has(refusal([&] { planar::Rigid(1.0, 1.0, p); }), "planar::Rigid: a planar body must lie"));
    Bar bar = PlanarRigidCase::bar();
    bar.placement = p;
    EXPECT_TRUE(has(refusal([&] { (void)planar::Rigid::from(bar); }), "planar::Rigid: a planar body must lie"));
  }
}

TEST(PlanarRigid, RefusesPointsThatAreNone) {
  EXPECT_TRUE(has(refusal([] { (void)planar::Rigid(1.0, 1.0).at(0.0); }), "needs a body made from a Bar"));
  EXPECT_TRUE(has(refusal([] { (void)planar::Rigid(1.0, 1.0).at(Vec2(0, nan_)); }), "the point"));
}

}  // namespace planar_rigid_test
}  // namespace polybody
