// Distributed force along a bar, compared with an equal weight, in every formulation.
#include <polybody/forces/loads.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/statics/equilibrium.hpp>

#include "support/refusal.hpp"

namespace distributed_force_test {

using namespace polybody;
using Cable = planar::AncfCable<planar::EngineeringStrain>;
using Clamp = Joint<planar::Weld, Constraint>;

template <class B>
struct Clamped {
  Model<Bodies<B>, Joints<Clamp>, Forces<PointForce<>>> model;
  BodyHandle<B> bar;
  ElementHandle<Clamp> clamp;
  explicit Clamped(B const& body)
      : bar(model.add(body, "bar")),
        clamp(model.connect(Clamp{}, model.ground().at({0, 0, 0}), bar.at(0.0), "clamp")) {}
};

Bar slender() { return {.length = 1.0, .constants = BarConstants{.EA = 1e6, .EI = 1.0, .mass_per_length = 1.0}}; }

// Elastica under a distributed load (S2b), q L³/EI = 5: tip at (1 − 0.15334, 0.49591). The tolerance is that of
// statics_elastica_test.cpp, stretch and 2e-6.
TEST(DistributedForce, BendsTheElastica) {
  Clamped<Cable> c(Cable::from(slender(), 64));
  apply_distributed(c.model, c.bar, PointForce<>{.force = {0, 5, 0}}, {.from = 0.0, .to = 1.0, .pieces = 64});
  State x = c.model.reference_state();
  equilibrium(c.model, x, {.load_steps = 10});
  Vec3 const tip = position(c.model, x, c.bar.at(1.0));
  EXPECT_NEAR(tip[0], 1 - 0.1533428200, 5e-6 + 2e-6);
  EXPECT_NEAR(tip[1], 0.4959050446, 5e-6 + 2e-6);
}

// Load over a part of a rigid bar: the clamp carries q (b − a) and its moment q (b² − a²)/2.
TEST(DistributedForce, HasItsResultant) {
  Clamped<planar::Rigid> c(planar::Rigid::from(slender()));
  apply_distributed(c.model, c.bar, PointForce<>{.force = {0, 8, 0}}, {.from = 0.25, .to = 0.75, .pieces = 1});
  State x = c.model.reference_state();
  equilibrium(c.model, x);
  auto const r = reaction(c.model, x, c.clamp);
  EXPECT_NEAR(std::abs(r.f[1]), 4.0, 1e-12);
  EXPECT_NEAR(std::abs(r.m[2]), 2.0, 1e-12);
}

TEST(DistributedForce, RefusesWhatCannotBeMeant) {
  Clamped<planar::Rigid> c(planar::Rigid::from(slender()));
  PointForce<> const q{.force = {0, 1, 0}};
  EXPECT_TRUE(has(refusal([&] { apply_distributed(c.model, c.bar, q, {.from = 0.5, .to = 0.5, .pieces = 1}, "snow"); }),
                  "\"snow\": a distributed force needs a range"));
  EXPECT_TRUE(has(refusal([&] { apply_distributed(c.model, c.bar, q, {.from = 0.0, .to = 1.0, .pieces = 0}); }),
                  "at least one piece"));
  EXPECT_TRUE(has(refusal([&] { apply_distributed(c.model, c.bar, q, {.from = 0.5, .to = 1.5, .pieces = 1}); }),
                  "outside the body"));
  // The point forces of the last piece lie inside the bar, but its end does not. No force is added.
  EXPECT_TRUE(
      has(refusal([&] { apply_distributed(c.model, c.bar, q, {.from = 0.0, .to = 1.1, .pieces = 2}); }), "s = 1.1 m"));
  State x = c.model.reference_state();
  equilibrium(c.model, x);
  EXPECT_EQ(reaction(c.model, x, c.clamp).f.norm(), 0.0);
}

}  // namespace distributed_force_test
