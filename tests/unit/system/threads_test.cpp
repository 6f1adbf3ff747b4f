// Threads share the loops of an evaluation; no result depends on their number.

#include <gtest/gtest.h>

#include <optional>

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/contact.hpp>
#include <polybody/forces/contact_group.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/run/simulate.hpp>

#include "support/chain.hpp"
#include "support/refusal.hpp"

using namespace polybody;

namespace threads_test {

template <class M>
State run(M const& model, int threads, double end_time) {
  State x = model.reference_state();
  simulate(model, x, GeneralisedAlpha{}, {.end_time = end_time, .step = 1e-3, .threads = threads}).run();
  return x;
}

template <class M>
void expect_same_bits(M const& model, double end_time) {
  State const alone = run(model, 1, end_time);
  for (int const threads : {2, 3, 4}) {
    State const shared = run(model, threads, end_time);
    EXPECT_EQ(shared.q, alone.q) << threads;
    EXPECT_EQ(shared.v, alone.v) << threads;
    EXPECT_EQ(shared.a, alone.a) << threads;
    EXPECT_EQ(shared.lambda, alone.lambda) << threads;
  }
}

TEST(Threads, GiveTheSameBitsForAFlexibleBody) {
  using Cable = planar::AncfCable<>;
  using Pin = Joint<planar::Revolute, Constraint>;
  Model<Bodies<Cable>, Joints<Pin>> model{Gravity{0, -9.81, 0}};
  Bar const bar{.length = 2.0,
                .constants = BarConstants{.EA = 1e5, .EI = 5.0, .mass_per_length = 1.0},
                .damping = {.bending = 0.01}};
  auto const cable = model.add(Cable::from(bar, 203), "cable");
  model.connect(Pin{}, model.ground().at({0, 0, 0}), cable.at(0.0), "pin");
  expect_same_bits(model, 0.05);
}

TEST(Threads, GiveTheSameBitsForManyBodies) {
  Chain<InSpace<Constraint>> const chain(600, bar_link(0.1));
  expect_same_bits(chain.model, 0.02);
}

/// Hanging chains with the same number of bodies, of one element each.
template <class B, class Policy>
auto chain_of(Index count) {
  using Pin = Joint<planar::Revolute, Policy>;
  Model<Bodies<B>, Joints<Pin>> model{Gravity{0, -9.81, 0}};
  std::optional<BodyHandle<B>> last;
  for (Index i = 0; i < count; ++i) {
    Bar const bar{
        .length = 0.1,
        .constants = BarConstants{.EA = 1e5, .EI = 5.0, .mass_per_length = 1.0, .GA = 4e4, .rotary_inertia = 1e-5},
        .placement = Placement::at({0.1 * double(i), 0, 0})};
    auto const next = model.add(B::from(bar, 1), "link " + std::to_string(i));
    if (last)
      model.connect(Pin{}, last->at(0.1), next.at(0.0), "pin " + std::to_string(i));
    else
      model.connect(Pin{}, model.ground().at({0, 0, 0}), next.at(0.0), "pin 0");
    last = next;
  }
  return model;
}

TEST(Threads, GiveTheSameBitsForManyFlexibleBodies) {
  expect_same_bits(chain_of<planar::AncfCable<>, AncfLinear>(203), 0.02);
  expect_same_bits(chain_of<planar::Lrvf, Constraint>(203), 0.02);
}

// Balls that fall on the ground and on a drum, at different times: the forces on both are added in a fixed order.
TEST(Threads, GiveTheSameBitsForContacts) {
  using OnGround = Contact<SphereOnPlane>;
  using OnDrum = Contact<SphereOnCylinder>;
  using Balls = ContactGroup<OnGround, OnDrum>;
  Model<Bodies<Rigid<>>, Joints<>, Forces<Balls>> model{Gravity{0, 0, -9.81}};
  std::vector<Marker<Rigid<>>> middles;
  for (int i = 0; i < 90; ++i) {
    double const x = 0.3 * double(i);
    auto const ball = model.add(Rigid<>(1.0, 0.004 * Mat3::Identity(), Placement::at({x, 0, 0.1 + 1e-4 * double(i)})),
                                "ball " + std::to_string(i));
    middles.push_back(ball.at({0, 0, 0}));
  }
  auto const drum = model.add(Rigid<>(50.0, Mat3::Identity(), Placement::at({10.0, 0, -0.2})), "drum");
  auto const balls = model.apply(Balls{}, middles, "balls");
  SpringDamperContact const law{.stiffness = 1e4, .damping = 20.0};
  model.add_partner(balls, OnGround{{.radius = 0.1}, law, {.coefficient = 0.3, .slip_speed = 0.1}},
                    model.ground().at({0, 0, 0}), "ground");
  model.add_partner(balls, OnDrum{{.radius = 0.1, .cylinder = 0.3}, law}, drum.at({0, 0, 0}), "drum");
  expect_same_bits(model, 0.1);
}

TEST(Threads, AreAtLeastOne) {
  Chain<InSpace<Constraint>> const chain(2, bar_link(0.1));
  EXPECT_TRUE(has(refusal([&] { run(chain.model, 0, 0.1); }), "at least one thread"));
}

}  // namespace threads_test
