// A force element may omit its coupling between bodies from the matrix of a time step. The motion does not change,
// and statics uses the full coupling.
#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/run/simulate.hpp>

namespace couples_bodies_test {

using namespace polybody;

struct LooseSpring : SpringDamper {
  static constexpr bool couples_bodies = false;
};
static_assert(couples_bodies<SpringDamper>() && !couples_bodies<LooseSpring>());

template <class Spring>
Spring spring() {
  SpringDamper const s{.stiffness = 50.0, .damping = 0.5, .free_length = 1.0};
  if constexpr (std::is_same_v<Spring, SpringDamper>)
    return s;
  else
    return Spring{s};
}

/// Two masses in a row on two springs, under gravity along the row.
template <class Spring>
struct Row {
  Model<Bodies<planar::Rigid>, Joints<>, Forces<Spring>> model{Gravity{1, 0, 0}};
  BodyHandle<planar::Rigid> a, b;
  State x;
  Row()
      : a(model.add(planar::Rigid(1.0, 1.0, Placement::planar(1, 0)), "a")),
        b(model.add(planar::Rigid(2.0, 1.0, Placement::planar(2, 0)), "b")) {
    model.apply(spring<Spring>(), model.ground().at({0, 0, 0}), a.at(Vec2(0, 0)), "first");
    model.apply(spring<Spring>(), a.at(Vec2(0, 0)), b.at(Vec2(0, 0)), "second");
    x = model.reference_state();
  }
  /// Number of tangent blocks between the two bodies.
  int couplings(SecondOrder second) {
    System system(model);
    system.evaluate(x.q, x.v, x.t);
    PatternSink sink;
    system.tangent({1.0, 0.1, 0.01}, second, x.lambda, sink);
    int count = 0;
    for (Block const& block : sink.blocks) count += block.row != block.col;
    return count;
  }
};

TEST(CouplesBodies, DecidesWhichBlocksATimeStepWrites) {
  EXPECT_EQ(Row<SpringDamper>().couplings(SecondOrder::omitted), 2);
  EXPECT_EQ(Row<LooseSpring>().couplings(SecondOrder::omitted), 0);
  EXPECT_EQ(Row<LooseSpring>().couplings(SecondOrder::included), 2);
}

// Newton's matrix differs, its solution does not: both steps solve the same equations to the same tolerance.
TEST(CouplesBodies, ChangesTheWayToTheSolutionOnly) {
  Row<SpringDamper> tight;
  Row<LooseSpring> loose;
  GeneralisedAlpha const stepper{.rho_inf = 0.8, .tolerance = 1e-10};
  simulate(tight.model, tight.x, stepper, {.end_time = 1.0, .step = 1e-2}).run();
  simulate(loose.model, loose.x, stepper, {.end_time = 1.0, .step = 1e-2}).run();
  EXPECT_GT((tight.x.q - tight.model.reference_state().q).norm(), 0.05);
  EXPECT_LT((tight.x.q - loose.x.q).norm(), 1e-8);
}

}  // namespace couples_bodies_test
