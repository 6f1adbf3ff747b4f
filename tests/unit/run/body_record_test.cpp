// Balance of the recorded loads of a rigid body: the wrenches at their points satisfy Newton's and Euler's equations.
#include <polybody/run/body_record.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid_euler_parameters.hpp>
#include <polybody/forces/contact_group.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"
#include "support/refusal.hpp"

using namespace polybody;

namespace body_record_test {

Bar rod(Placement const& placement = {}) {
  return {.length = 2.0,
          .section = Rectangle{.height = 0.1, .width = 0.2},
          .material = Material{.density = 7800, .young = 2e11},
          .placement = placement};
}

/// Residuals of m a = Σ F, and of J Ω˙ + Ω × J Ω = Σ (u × f + m) about the centre of mass. They are divided by the
/// largest sum of magnitudes.
Vec2 left_over(BodyRecord const& record, double mass, Mat3 const& inertia) {
  Vec2 left = Vec2::Zero(), size = left;
  for (BodySample const& s : record.samples) {
    Mat3 const to_body = s.frame.A.transpose();
    Vec3 const omega = to_body * s.frame.w;
    Vec3 force = mass * (to_body * (record.gravity - s.acceleration));
    Vec3 moment = -inertia * (to_body * s.angular_acceleration) - omega.cross(inertia * omega);
    Vec2 sum(mass * (record.gravity.norm() + s.acceleration.norm()), moment.norm());
    for (LoadSample const& l : s.loads) {
      force += l.f;
      moment += l.m + l.at.cross(l.f);
      sum += Vec2(l.f.norm(), l.m.norm() + l.at.norm() * l.f.norm());
    }
    left = left.cwiseMax(Vec2(force.norm(), moment.norm()));
    size = size.cwiseMax(sum);
  }
  return left.cwiseQuotient(size);
}

/// Contact law of two markers for a contact group. It presses a point back above z = −2.2.
struct Press {
  static constexpr int markers = 2;
  static constexpr bool is_load = false;
  static constexpr MarkerKind needs = MarkerKind::point;
  double stiffness = 1e5;

  void check(std::string const&) const {}
  template <StateScalar T>
  bool may_touch(Frame<T> const& a, Frame<T> const& b) const {
    return a.r[2] < b.r[2];
  }
  template <StateScalar T>
  std::array<Wrench<T>, 2> wrenches(std::array<Frame<T>, 2> const& f, double) const {
    std::array<Wrench<T>, 2> w;
    T const deep = f[1].r[2] - f[0].r[2];
    if (deep > T(0.0)) {
      w[0].f[2] = deep * stiffness;
      w[1].f[2] = -w[0].f[2];
    }
    return w;
  }
};

// Joints by multipliers and by a bushing, a spring-damper, a follower load, a dead moment, a late contact, gravity.
// The Newton tolerance is 1e-12 of an acceleration. The velocity constraint equations are also satisfied, for the
// rate of the norm of Euler parameters.
template <class Body>
void balances() {
  using Ball = Joint<Spherical, Constraint>;
  using Soft = Joint<Weld, Bushing>;
  using Group = ContactGroup<Press>;
  Model<Bodies<Body>, Joints<Ball, Soft>, Forces<SpringDamper, PointForce<>, PointMoment<>, Group>> model{
      Gravity{0.3, -0.2, -9.81}};
  Bar const first = rod(Placement::at({0, 0, 0}, {0.3, 0.2, -0.4}));
  Bar second = first;
  second.placement.origin = first.placement.origin + first.placement.axes.col(0) * first.length;
  auto const a = model.add(Body::from(first), "a");
  auto const b = model.add(Body::from(second), "b");
  model.connect(Ball{}, model.ground().at({0, 0, 0}), a.at(0.0), "ball");
  Mat<double, 6, 6> const k = Vec6(1e7, 2e7, 1e7, 1e5, 2e5, 1e5).asDiagonal();
  model.connect(Soft{{}, {.stiffness = k, .damping = 1e-3 * k}}, a.at(2.0), b.at(0.0), "soft");
  model.apply(SpringDamper{.stiffness = 4e3, .damping = 50.0, .free_length = 1.0}, model.ground().at({2, 1, -1}),
              a.at(1.3, 0.05, 0.1), "spring");
  model.apply(PointForce<>{.force = {50, 300, -200}, .axes = LoadAxes::marker}, b.at(2.0, -0.05, 0.0), "follower");
  model.apply(PointMoment<>{.moment = {30, -40, 50}}, a.at(0.7), "moment");
  auto const group = model.apply(Group{}, std::vector{a.at(1.9), b.at(2.0)}, "contacts");
  model.add_partner(group, Press{}, model.ground().at({0, 0, -2.2}), "floor");

  LoadRecorder recorder(model);
  recorder.add(b);
  recorder.add(a);
  recorder.add(a);  // a second call has no effect
  State x = model.reference_state();
  for (State const& now :
       simulate(model, x, GeneralisedAlpha{.tolerance = 1e-12, .stabilised = true}, {.end_time = 0.6, .step = 2e-3}))
    recorder.record(now);

  Rigid<> const body = Rigid<>::from(rod());
  std::size_t most = 0;
  for (BodyRecord const* r : {&recorder.of(a), &recorder.of(b)}) {
    ASSERT_EQ(r->samples.size(), 301u);
    Vec2 const left = left_over(*r, body.mass(), body.inertia());
    held_within({"thesis §4.3", "recorded loads less the inertia of their body, of the largest", By::closed_form, "0",
                 std::is_same_v<Body, Rigid<>> ? "Rigid" : "Rigid<EulerParameters>"},
                left.maxCoeff(), 1e-8, {r->name, 1.0});
    for (BodySample const& s : r->samples) most = std::max(most, s.loads.size());
  }
  EXPECT_EQ(recorder.of(a).samples.front().loads.size(), 4u);  // ball, bushing, spring, moment
  EXPECT_EQ(recorder.of(b).samples.front().loads.size(), 2u);  // bushing, follower
  bool touched = false;
  for (BodySample const& s : recorder.of(b).samples) touched = touched || s.loads.size() == 3;
  EXPECT_TRUE(touched);
  EXPECT_EQ(most, 4u);
}

TEST(BodyRecord, BalancesWhateverActsOnTheBody) { balances<Rigid<>>(); }
TEST(BodyRecord, BalancesABodyOfEulerParameters) { balances<Rigid<EulerParameters>>(); }

// Uniform motion on a circle: the pin carries m ω² L/2 along the rod, at the end of the rod.
TEST(BodyRecord, HoldsThePinForceAtItsPointInTheBodysAxes) {
  using Pin = Joint<planar::Revolute, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Pin>> model{Gravity{0, 0, -9.81}};  // no force normal to the plane
  auto const arm = model.add(planar::Rigid::from(rod()), "arm");
  model.connect(Pin{}, model.ground().at({0, 0, 0}), arm.at(0.0), "pin");
  State x = model.reference_state();
  model.set_velocity(x, arm, Vec3::Zero(), {0, 0, 5.0});
  LoadRecorder recorder(model);
  recorder.add(arm);
  for (State const& now : simulate(model, x, RungeKutta4<Projection>{}, {.end_time = 0.5, .step = 1e-3}))
    recorder.record(now);
  double const mass = 7800 * 0.02 * 2.0;
  BodyRecord const& record = recorder.of(arm);
  EXPECT_EQ(record.gravity, Vec3::Zero());
  for (BodySample const& s : record.samples) {
    ASSERT_EQ(s.loads.size(), 1u);
    EXPECT_LT((s.loads[0].at - Vec3(-1, 0, 0)).norm(), 1e-12);
    // the projection leaves 1e-10 of the pin's constraint violation and of its rate
    held_within(
        {"thesis §4.3", "recorded force of the pin of a turning rod, of it", By::closed_form, "m ω² r", "Rigid"},
        (s.loads[0].f - Vec3(-mass * 25.0, 0, 0)).norm() / (mass * 25.0), 1e-8, {.scale = 1.0});
  }
}

// Loads of joints that eliminate coordinates agree with those of joints with multipliers.
TEST(BodyRecord, BalancesWithRecursiveJoints) {
  using Turn = Joint<Revolute, JointCoordinates>;
  Model<Bodies<Rigid<>>, Joints<Turn>> model{Gravity{0, 0, -9.81}};
  auto const a = model.add(Rigid<>::from(rod()), "a");
  auto const b = model.add(Rigid<>::from(rod(Placement::at({2, 0, 0}))), "b");
  model.connect(Turn{{.axis = {0, 1, 0}}, {}}, model.ground().at({0, 0, 0}), a.at(0.0), "first");
  model.connect(Turn{{.axis = {0.6, 0.8, 0}}, {}}, a.at(2.0), b.at(0.0), "second");
  LoadRecorder recorder(model);
  recorder.add(a);
  recorder.add(b);
  State x = model.reference_state();
  for (State const& now : simulate(model, x, GeneralisedAlpha{.tolerance = 1e-12}, {.end_time = 0.3, .step = 2e-3}))
    recorder.record(now);
  for (BodyRecord const* r : {&recorder.of(a), &recorder.of(b)})
    held_within({"thesis §4.3", "recorded loads less the inertia of their body, of the largest", By::closed_form, "0",
                 "Rigid, joint coordinates"},
                left_over(*r, Rigid<>::from(rod()).mass(), Rigid<>::from(rod()).inertia()).maxCoeff(), 1e-8,
                {r->name, 1.0});
}

TEST(BodyRecord, RefusesInSentences) {
  using Ball = Joint<Spherical, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Ball>> model{Gravity{0, 0, -9.81}};
  auto const a = model.add(Rigid<>::from(rod()), "a");
  auto const b = model.add(Rigid<>::from(rod(Placement::at({2, 0, 0}))), "b");
  model.connect(Ball{}, model.ground().at({0, 0, 0}), a.at(0.0), "ball");
  model.connect(Ball{}, a.at(2.0), b.at(0.0), "elbow");
  LoadRecorder recorder(model);
  recorder.add(a);
  EXPECT_TRUE(
      has(refusal([&] { recorder.of(b); }), "body \"b\" was not recorded. Add it to the recorder before the run."));
  EXPECT_TRUE(has(refusal([&] { recorder.of(a); }), "there is no sample of \"a\""));
  State x = model.reference_state();
  recorder.record(x);
  EXPECT_TRUE(has(refusal([&] { recorder.record(x); }), "a state at t = 0 s follows a state at 0 s"));
  EXPECT_TRUE(has(refusal([&] { recorder.add(b); }), "\"b\" is added after the first sample"));
  State other = x;
  other.q.resize(3);
  EXPECT_TRUE(has(refusal([&] { recorder.record(other); }), "does not fit the model"));
}

}  // namespace body_record_test
