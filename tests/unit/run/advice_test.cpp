// Advice after a run: shares of the time, explicit integrators that are stable, and the unchanged run.
#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/run/advice.hpp>
#include <polybody/run/simulate.hpp>

#include <sstream>

namespace polybody {
namespace advice_test {

using Turn = Joint<planar::Revolute, JointCoordinates>;

// A mass of 2 kg between two springs of `stiffness` along x: ω² = 2k/m. It also moves across the springs.
struct Mass {
  Model<Bodies<planar::Rigid>, Joints<>, Forces<SpringDamper>> model;
  State x;
  explicit Mass(double stiffness, double damping = 0.0) {
    auto const mass = model.add(planar::Rigid(2.0, 1.0, Placement::planar(1, 0, 0)), "mass");
    SpringDamper const spring{.stiffness = stiffness, .damping = damping, .free_length = 1.0};
    model.apply(spring, model.ground().at({0, 0, 0}), mass.at(Vec2(0, 0)));
    model.apply(spring, mass.at(Vec2(0, 0)), model.ground().at({2, 0, 0}));
    x = model.reference_state();
    x.v[1] = 5.0;
  }
  template <class I>
  Advice advice(I const& integrator, double step = 1e-3) {
    auto run = simulate(model, x, integrator, {.end_time = 50 * step, .step = step});
    run.run();
    return advise(run);
  }
};

double sum(Advice const& a) { return a.forces + a.equations + a.factorisations + a.solutions; }

TEST(Advice, NamesAStableExplicitIntegrator) {
  double const step = 0.04;  // ω h = 1.13; the limit is 2. Large displacements need several iterations in a step.
  Advice const soft = Mass(800.0).advice(GeneralisedAlpha{}, step);
  EXPECT_NEAR(sum(soft), 1.0, 1e-12);
  EXPECT_GT(soft.step_time, 0.0);
  ASSERT_FALSE(soft.faster.empty());
  EXPECT_EQ(soft.faster.front().integrator, "SymplecticEuler");  // one evaluation of the accelerations in a step
  EXPECT_EQ(soft.faster.front().step, step);
  std::ostringstream text;
  text << soft;
  EXPECT_NE(text.str().find("SymplecticEuler is stable at this state with steps of 0.04 s"), std::string::npos)
      << text.str();
}

TEST(Advice, NamesNoneForStiffnessOrDampingBeyondTheStep) {
  EXPECT_TRUE(Mass(1e11).advice(GeneralisedAlpha{}).faster.empty());      // ω h = 316; the limit is 2
  EXPECT_TRUE(Mass(8.0, 1e6).advice(GeneralisedAlpha{}).faster.empty());  // d h = 1000; the limit is 2
}

TEST(Advice, OfAnExplicitRunHasSharesOnly) {
  Advice const a = Mass(8.0).advice(SymplecticEuler{});
  EXPECT_NEAR(sum(a), 1.0, 1e-12);
  EXPECT_TRUE(a.faster.empty());
}

TEST(Advice, LeavesTheRunUnchangedInJointCoordinates) {
  State ends[2];
  for (bool const asks : {false, true}) {
    Model<Bodies<planar::Rigid>, Joints<Turn>> model{Gravity{0, -9.81, 0}};
    auto const upper = model.add(planar::Rigid(1.0, 1.0, Placement::planar(1, 0, 0)), "upper"),
               lower = model.add(planar::Rigid(1.0, 1.0, Placement::planar(3, 0, 0)), "lower");
    model.connect(Turn{}, model.ground().at({0, 0, 0}), upper.at(Vec2(-1, 0)));
    model.connect(Turn{}, upper.at(Vec2(1, 0)), lower.at(Vec2(-1, 0)));
    State x = model.reference_state();
    auto run = simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.2, .step = 1e-3});
    while (!run.done()) {
      run.advance();
      if (asks && run.report().steps % 50 == 0) {
        EXPECT_NEAR(sum(advise(run)), 1.0, 1e-12);
      }
    }
    ends[asks] = x;
  }
  EXPECT_EQ(ends[0].q, ends[1].q);
  EXPECT_EQ(ends[0].v, ends[1].v);
}

TEST(Advice, CountsIndependentParts) {
  Model<Bodies<planar::Rigid>, Joints<>> model{Gravity{0, -9.81, 0}};
  for (int k = 0; k < 3; ++k) model.add(planar::Rigid(1.0, 1.0, Placement::planar(k, 0, 0)));
  State x = model.reference_state();
  auto run = simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.01, .step = 1e-3});
  run.run();
  EXPECT_EQ(advise(run).islands, 3);
}

TEST(Advice, OfARunWithoutStepsIsEmpty) {
  Mass m(8.0);
  auto run = simulate(m.model, m.x, GeneralisedAlpha{}, {.end_time = 0.01, .step = 1e-3});
  EXPECT_EQ(advise(run).step_time, 0.0);
  std::ostringstream text;
  text << advise(run);
  EXPECT_EQ(text.str(), "The run has no step yet.\n");
}

}  // namespace advice_test
}  // namespace polybody
