#include <polybody/system/model.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/penalty.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/problem_size.hpp>
#include <polybody/run/simulate.hpp>

#include "support/refusal.hpp"

using namespace polybody;

namespace model_test {

using Pin = Joint<planar::Revolute, Constraint>;
using Drive = Joint<PrescribedAngle<Ramp>, Constraint>;
using Plane = Model<Bodies<planar::Rigid>, Joints<Pin, Drive>, Forces<SpringDamper>>;

planar::Rigid bar(double x = 0.0) { return planar::Rigid(2.0, 0.3, Placement::planar(x, 0.0)); }

TEST(Model, CountsWhatWasAdded) {
  Plane model;
  EXPECT_EQ(model.coordinates(), 0);
  auto const a = model.add(bar()), b = model.add(bar(1.0));
  model.connect(Pin{}, model.ground().at({0, 0, 0}), a.at(Vec2(0, 0)));
  model.connect(Pin{}, a.at(Vec2(1, 0)), b.at(Vec2(0, 0)));
  model.connect(Drive{{.law = {.target = 1.0, .duration = 1.0}}, {}}, a.at(Vec2(0, 0)), b.at(Vec2(0, 0)));
  EXPECT_EQ(model.body_count(), 2);
  EXPECT_EQ(model.velocities(), 6);
  EXPECT_EQ(model.rows(), 5);
  EXPECT_EQ(model.markers(), 6);
  EXPECT_EQ(problem_size(model).degrees_of_freedom, 1);
}

TEST(Model, HasNoJointsAndForcesByDefault) {
  Model<Bodies<planar::Rigid>> model{Gravity{0, -9.81, 0}};
  auto const ball = model.add(planar::Rigid(2.0, 0.1));
  State x = model.reference_state();
  simulate(model, x, RungeKutta4<>{}, {.end_time = 1.0, .step = 1e-2}).run();
  EXPECT_NEAR(position(model, x, ball.centre())[1], -0.5 * 9.81, 1e-9);
}

TEST(Model, NamesWhatHasNoName) {
  Plane model;
  auto const a = model.add(bar()), named = model.add(bar(), "boom"), c = model.add(bar());
  EXPECT_EQ(a.name, "body 1");
  EXPECT_EQ(named.name, "boom");
  EXPECT_EQ(c.name, "body 3");
  auto const first = model.connect(Pin{}, model.ground().at({0, 0, 0}), a.at(Vec2(0, 0)));
  auto const second = model.connect(Pin{}, a.at(Vec2(0, 0)), c.at(Vec2(0, 0)), "elbow");
  EXPECT_TRUE(has(first.name, " 1"));
  System const system(model);
  EXPECT_EQ(system.name_of(0), "body \"body 1\"");
  EXPECT_EQ(system.name_of(5), "body \"boom\"");
  EXPECT_EQ(system.name_of(9), "joint \"" + first.name + "\"");
  EXPECT_EQ(system.name_of(12), "joint \"" + second.name + "\"");
}

// Records, files and messages distinguish parts by their names.
TEST(Model, RefusesANameThatIsTaken) {
  using Soft = Joint<planar::Revolute, Penalty>;
  Model<Bodies<planar::Rigid>, Joints<Pin, Soft>, Forces<PointForce<>, PointMoment<>>> model;
  auto const boom = model.add(bar(), "boom");
  auto const ground = model.ground().at({0, 0, 0});
  EXPECT_TRUE(has(refusal([&] { model.add(bar(), "boom"); }), "Duplicate name of a body: \"boom\""));
  model.connect(Pin{}, ground, boom.at(Vec2(0, 0)), "boom");  // a joint may have the same name as a body
  Soft const soft{{}, Penalty{.stiffness = 1.0, .damping = 0.0}};
  EXPECT_TRUE(has(refusal([&] { model.connect(soft, ground, boom.at(Vec2(0, 0)), "boom"); }), "of a joint: \"boom\""));
  model.apply(PointForce<>{.force = {1, 0, 0}}, boom.at(Vec2(0, 0)), "push");
  EXPECT_TRUE(has(refusal([&] { model.apply(PointMoment<>{.moment = {0, 0, 1}}, boom.at(Vec2(0, 0)), "push"); }),
                  "of a force: \"push\""));
  EXPECT_EQ(model.body_count(), 1);  // a refusal leaves the model unchanged
  EXPECT_EQ(model.markers(), 3);
  EXPECT_EQ(model.rows(), 2);
  EXPECT_EQ(model.add(bar(), "jib").name, "jib");
}

// Every type has its own pool, but names are unique in the whole model. Given names have priority.
TEST(Model, GivesNamesThatAreFree) {
  using Soft = Joint<planar::Revolute, Penalty>;
  Model<Bodies<planar::Rigid>, Joints<Pin, Soft>, Forces<PointForce<>, PointMoment<>>> model;
  auto const second = model.add(bar(), "body 2"), free = model.add(bar()), next = model.add(bar());
  EXPECT_EQ(free.name, "body 3");
  EXPECT_EQ(next.name, "body 4");
  auto const ground = model.ground().at({0, 0, 0});
  auto const hard = model.connect(Pin{}, ground, second.at(Vec2(0, 0)));
  auto const soft = model.connect(Soft{{}, Penalty{.stiffness = 1.0, .damping = 0.0}}, ground, free.at(Vec2(0, 0)));
  EXPECT_NE(hard.name, soft.name);
  auto const push = model.apply(PointForce<>{.force = {1, 0, 0}}, free.at(Vec2(0, 0)));
  auto const turn = model.apply(PointMoment<>{.moment = {0, 0, 1}}, free.at(Vec2(0, 0)));
  EXPECT_EQ(push.name, "force 1");
  EXPECT_EQ(turn.name, "force 2");
}

// In the reference state the markers of every joint are at the positions where the user placed the bodies.
TEST(Model, ReferenceStateIsThatOfThePlacements) {
  Plane model;
  auto const turned = model.add(planar::Rigid(1.0, 1.0, Placement::planar(2.0, -1.0, 0.5)));
  State const x = model.reference_state();
  Frame<double> const f = frame(model, x, turned.at(Vec2(1.0, 0.0)));
  EXPECT_LT((f.r - Vec3(2.0 + std::cos(0.5), -1.0 + std::sin(0.5), 0)).norm(), 1e-15);
  EXPECT_LT((f.A.col(0) - Vec3(std::cos(0.5), std::sin(0.5), 0)).norm(), 1e-15);
  EXPECT_EQ(x.v, VecX::Zero(3));
  EXPECT_EQ(x.t, 0.0);
}

// v0 is the velocity of the body-fixed point at the origin: v(r) = v0 + ω × r.
TEST(Model, SetsTheSpeedsOfARigidMotion) {
  Plane model;
  auto const other = model.add(bar()), a = model.add(bar(1.0));
  State x = model.reference_state();
  model.set_velocity(x, a, {0.3, -0.2, 0}, {0, 0, 2.0});
  Frame<double> const f = frame(model, x, a.at(Vec2(0.5, 0.25)));
  EXPECT_LT((f.v - (Vec3(0.3, -0.2, 0) + Vec3(0, 0, 2).cross(f.r))).norm(), 1e-15);
  EXPECT_LT((f.w - Vec3(0, 0, 2)).norm(), 1e-15);
  EXPECT_EQ(frame(model, x, other.at(Vec2(0, 0))).v.norm(), 0.0);
}

TEST(Model, RefusesMarkersAndHandlesOfAnotherModel) {
  Plane model, another;
  auto const own = model.add(bar(), "own"), foreign = another.add(bar(), "foreign");
  auto const at = foreign.at(Vec2(0, 0));
  State x = model.reference_state();
  char const* const said = "of another model. Use a marker or handle of this model.";
  EXPECT_TRUE(has(refusal([&] { model.connect(Pin{}, own.at(Vec2(0, 0)), at, "elbow"); }), "\"elbow\""));
  EXPECT_TRUE(has(refusal([&] { model.connect(Pin{}, own.at(Vec2(0, 0)), at); }), said));
  EXPECT_TRUE(has(refusal([&] { model.connect(Pin{}, another.ground().at({0, 0, 0}), own.at(Vec2(0, 0))); }), said));
  EXPECT_TRUE(has(
      refusal([&] { model.apply(SpringDamper{.stiffness = 1.0, .free_length = 1.0}, own.at(Vec2(0, 0)), at); }), said));
  EXPECT_TRUE(has(refusal([&] { model.set_velocity(x, foreign, {0, 0, 0}, {0, 0, 1}); }), "\"foreign\""));
  EXPECT_TRUE(has(refusal([&] { (void)position(model, x, at); }), said));
  // a refused joint leaves the model unchanged
  EXPECT_EQ(model.rows(), 0);
  EXPECT_EQ(model.markers(), 0);
  // a copy is not accepted as the original either
  Plane const copy = model;
  EXPECT_NO_THROW((void)position(copy, x, own.at(Vec2(0, 0))));
}

TEST(Model, NamesTheJointWhoseParametersCannotBeMeant) {
  Plane model;
  auto const a = model.add(bar());
  auto const connect = [&](Drive const& drive) {
    return refusal([&] { model.connect(drive, model.ground().at({0, 0, 0}), a.at(Vec2(0, 0)), "drive"); });
  };
  EXPECT_TRUE(has(connect({{.law = {.target = 1.0, .duration = 1.0}, .axis = {0, 0, 0}}, {}}), "\"drive\": "));
  EXPECT_TRUE(has(connect({{.law = {.target = 1.0, .duration = -1.0}}, {}}), "\"drive\": the time function"));
  EXPECT_EQ(model.rows(), 0);
}

// A copy of a model is a separate model with the same content.
TEST(Model, ACopyMovesAsTheOriginal) {
  Plane model{Gravity{0, -9.81, 0}};
  auto const a = model.add(bar(0.5));
  model.connect(Pin{}, model.ground().at({0, 0, 0}), a.at(Vec2(-0.5, 0)));
  Plane const copy = model;
  State x = model.reference_state(), y = copy.reference_state();
  simulate(model, x, RungeKutta4<Projection>{}, {.end_time = 0.1, .step = 0.01}).run();
  simulate(copy, y, RungeKutta4<Projection>{}, {.end_time = 0.1, .step = 0.01}).run();
  EXPECT_EQ(x.q, y.q);
}

}  // namespace model_test
