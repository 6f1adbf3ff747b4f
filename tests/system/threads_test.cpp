// Threads share the loops of an evaluation; nothing that is computed depends on their number.

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/integrators/generalized_alpha.hpp>
#include <polybody/run/simulate.hpp>

#include "support/chain.hpp"
#include "support/refusal.hpp"

using namespace polybody;

namespace threads_test {

template <class M>
State run(M const& model, int threads, double until) {
  State x = model.reference_state();
  simulate(model, x, GeneralizedAlpha{}, {.until = until, .step = 1e-3, .threads = threads}).run();
  return x;
}

template <class M>
void expect_same_bits(M const& model, double until) {
  State const alone = run(model, 1, until);
  for (int const threads : {2, 3, 4}) {
    State const shared = run(model, threads, until);
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

TEST(Threads, AreAtLeastOne) {
  Chain<InSpace<Constraint>> const chain(2, bar_link(0.1));
  EXPECT_TRUE(has(refusal([&] { run(chain.model, 0, 0.1); }), "at least one thread"));
}

}  // namespace threads_test
