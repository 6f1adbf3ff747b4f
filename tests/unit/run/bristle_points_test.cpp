// Contact points of a contact with bristles: normal force and friction of each slot, and their sum.
#include <gtest/gtest.h>

#include <algorithm>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/bristle_friction.hpp>
#include <polybody/forces/shapes/shapes_on_plane.hpp>
#include <polybody/run/probe.hpp>

namespace polybody::bristle_points_test {

using Floor = Contact<BoxOnPlane, SpringDamperContact, BristleFriction>;

// A tilted box whose four lower corners touch. A corner holds the force σ₀ z + σ₁ v up to μ N; one corner with a small
// load slips. The tolerance is the rounding of forces of some 100 N.
TEST(BristlePoints, HaveTheForcesOfTheirSlots) {
  Model<Bodies<Rigid<>>, Joints<>, Forces<Floor>> model;
  BristleFriction const bristles{.coefficient = 0.5, .stiffness = 2e4, .damping = 30.0};
  auto const box = model.add(Rigid<>(1.0, Mat3(Mat3::Identity()), Placement::at({0.2, 0.1, 0.095}, {0.02, 0.015, 0})));
  auto const on_box = box.at(Vec3(0, 0, 0));
  auto const floor = model.apply(Floor{{.size = {0.3, 0.2, 0.2}}, {.stiffness = 1e4}, bristles}, on_box,
                                 model.ground().at({0, 0, 0}), "floor");
  State x = model.reference_state();
  Vec3 const v(0.1, -0.05, 0.0);
  model.set_velocity(x, box, v, Vec3::Zero());
  std::vector<Vec3> left;  // deflections of the slots
  auto const z = model.states(x, floor);
  for (std::size_t i = 0; i < z.size() / 3; ++i) {
    left.emplace_back(1e-4 * (1.0 + double(i)), -2e-4 * double(i), 0.0);
    for (std::size_t k = 0; k < 3; ++k) z[3 * i + k] = left.back()[Index(k)];
  }
  Probe probe(model);
  ObservedState const now(x, probe);
  int held = 0, slipping = 0;
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  now.for_each_contact(floor, [&](TouchingPoint const& p) {
    double const n = 1e4 * p.depth;
    EXPECT_EQ(*p.against, "floor");
    EXPECT_NEAR(p.depth, -p.place.z(), 1e-15);
    EXPECT_NEAR(p.force.z(), n, 1e-11);
    force += p.force;
    moment += (p.place - now.position(on_box)).cross(p.force);
    Vec3 const friction(p.force.x(), p.force.y(), 0.0);
    auto const own = std::find_if(left.begin(), left.end(), [&](Vec3 const& deflection) {
      Vec3 const trial = bristles.stiffness * deflection + bristles.damping * v;
      return (friction + std::min(1.0, 0.5 * n / trial.norm()) * trial).norm() < 1e-11;
    });
    ASSERT_NE(own, left.end());
    (friction.norm() < 0.5 * n - 1e-9 ? held : slipping) += 1;
    left.erase(own);
  });
  EXPECT_GT(held, 0);
  EXPECT_GT(slipping, 0);
  EXPECT_EQ(held + slipping, 4);
  auto const sum = now.applied_wrenches(floor)[0];
  EXPECT_LT((sum.f - force).norm(), 1e-11);
  EXPECT_LT((sum.m - moment).norm(), 1e-11);
}

}  // namespace polybody::bristle_points_test
