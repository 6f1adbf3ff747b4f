// Number of steps for which second-order terms remain in the tangent after a step has required them.
#include <polybody/integrators/step_tangent.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/solvers/default_solver.hpp>
#include <polybody/system/make_operations.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;

namespace step_tangent_test {

struct Pendulum {
  Model<Bodies<Rigid<>>, Joints<Joint<Revolute, Constraint>>, Forces<>> model;
  Pendulum() {
    auto const body = model.add(Rigid<>(1.0, Mat3::Identity(), Placement::at({1, 0, 0})), "body");
    model.connect(Joint<Revolute, Constraint>{{.axis = Vec3(0, 1, 0)}}, model.ground().at({0, 0, 0}),
                  body.at(Vec3(-1, 0, 0)), "pin");
  }
};

struct StepTangents : testing::Test {
  Pendulum pendulum;
  System system{pendulum.model, with<Capabilities::implicit_step>};
  VecX lambda = VecX::Zero(system.rows());
  StepTangent<BlockSolver> tangent;

  void SetUp() override {
    State const x = pendulum.model.reference_state();
    system.evaluate(x.q, x.v, 0.0);
    tangent.analyse(system, SecondOrder::omitted, lambda);
  }
  /// Counts the steps until the second-order terms are omitted.
  int stay() {
    int steps = 1;
    while (!tangent.end_step()) ++steps;
    EXPECT_EQ(tangent.terms(), SecondOrder::omitted);
    return steps;
  }
};

TEST_F(StepTangents, StayForSomeStepsAndGo) {
  EXPECT_EQ(tangent.terms(), SecondOrder::omitted);
  EXPECT_FALSE(tangent.end_step());
  TangentSolver<BlockSolver>* const without = &tangent.solver();
  tangent.include(system, lambda);
  EXPECT_EQ(tangent.terms(), SecondOrder::included);
  EXPECT_NE(&tangent.solver(), without);
  EXPECT_EQ(stay(), 8);
  EXPECT_EQ(&tangent.solver(), without);
  EXPECT_FALSE(tangent.end_step());
}

TEST_F(StepTangents, StayTwiceAsLongWhereTheyAreCalledForAgainSoon) {
  for (int const steps : {8, 16, 32}) {
    tangent.include(system, lambda);
    EXPECT_EQ(stay(), steps);
    tangent.end_step();
  }
  for (int k = 0; k < 100; ++k) tangent.end_step();
  tangent.include(system, lambda);
  EXPECT_EQ(stay(), 8);  // the last request was long ago
}

TEST_F(StepTangents, StartForgetsThem) {
  tangent.include(system, lambda);
  tangent.forget();
  EXPECT_EQ(tangent.terms(), SecondOrder::omitted);
}

TEST_F(StepTangents, AreThereFromTheStartWhereAskedFor) {
  tangent.analyse(system, SecondOrder::included, lambda);
  EXPECT_EQ(tangent.terms(), SecondOrder::included);
  TangentSolver<BlockSolver>* const only = &tangent.solver();
  tangent.include(system, lambda);
  EXPECT_EQ(&tangent.solver(), only);
  for (int k = 0; k < 20; ++k) EXPECT_FALSE(tangent.end_step());
  EXPECT_EQ(tangent.terms(), SecondOrder::included);
}

}  // namespace step_tangent_test
