#include <polybody/bodies/rigid/rigid_euler_parameters.hpp>

#include <gtest/gtest.h>

#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/problem_size.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/testing/body_laws.hpp>

namespace polybody {
using namespace laws;
namespace rigid_euler_parameters_test {

struct EulerCase {
  static Bar bar() {
    return {
        .length = 1.3,
        .constants =
            BarConstants{.EA = 900, .EI = 40, .mass_per_length = 2.0, .rotary_inertia = 0.05, .rotary_inertia_y = 0.03},
        .placement = Placement::at({0.4, -0.3, 0.2}, {0.3, -0.5, 0.9})};
  }
  static Rigid<EulerParameters> body(Bar const& bar) { return Rigid<EulerParameters>::from(bar); }
};
bool const rigid_euler_parameters_obeys = obeys<EulerCase, BodyLaws>("RigidEulerParameters");

// Ω = Ḡ θ̇ is the angular velocity of A. The work of a moment is equal in both descriptions.
TEST(EulerParameterMap, RelatesCartesianAndGeneralisedMoments) {
  using Body = Rigid<EulerParameters>;
  using D = Dual<1>;
  Vec<D, 7> q = Vec<D, 7>::Zero();
  Vec4 const theta = Vec4(0.4, -0.3, 0.7, 0.5), rate(0.2, 0.9, -0.4, 0.1);
  for (int i = 0; i < 4; ++i) q[3 + i] = D(theta[i], Dual<1>::Partials(rate[i]));
  Vec<double, 7> const at = values_of(q);
  Mat3 const a = Body::axes<double>(view(at));
  Mat3 const spin = a.transpose() * epsilon_of(Body::axes<D>(view(q)));  // Ω~
  Vec3 const omega = Body::map<double>(view(at)) * rate;
  EXPECT_LT((spin - skew<double>(omega)).norm(), 1e-14);
  Vec3 const moment(2.0, -1.0, 3.0);
  EXPECT_NEAR((Body::map<double>(view(at)).transpose() * moment).dot(rate), moment.dot(omega), 1e-14);
}

/// One mechanism with either description of rotation: a top on a ball joint with a swinging link pinned to it.
template <class Rotation>
struct Mechanism {
  using Body = Rigid<Rotation>;
  using Ball = Joint<Spherical, Constraint>;
  using Pin = Joint<Revolute, Constraint>;
  Model<Bodies<Body>, Joints<Ball, Pin>> model{Gravity{0, 0, -9.81}};
  BodyHandle<Body> top =
      model.add(Body(1.0, Vec3(0.02, 0.01, 0.03).asDiagonal(), Placement::at({0.3, 0.1, 0.2})), "top");
  BodyHandle<Body> link =
      model.add(Body(0.5, Vec3(0.01, 0.02, 0.02).asDiagonal(), Placement::at({0.8, 0.1, 0.2})), "link");
  ElementHandle<Ball> pivot =
      model.connect(Ball{}, model.ground().at({0, 0, 0}), top.at(Vec3(-0.3, -0.1, -0.2)), "pivot");
  ElementHandle<Pin> pin = model.connect(Pin{Revolute{.axis = Vec3::UnitY()}, {}}, top.at(Vec3(0.2, 0, 0)),
                                         link.at(Vec3(-0.3, 0, 0)), "pin");
  State x = model.reference_state();

  Mechanism() {
    model.set_velocity(x, top, Vec3::Zero(), Vec3(1, 2, 5));
    model.set_velocity(x, link, Vec3::Zero(), Vec3(1, 2, 5));
  }
  template <class Integrator>
  void run(Integrator const& integrator, double step) {
    simulate(model, x, integrator, {.end_time = 0.5, .step = step}).run();
  }
};

template <class Integrator>
void expect_same_motion(Integrator const& integrator, double step, double tolerance) {
  Mechanism<UnitQuaternion> a;
  Mechanism<EulerParameters> b;
  a.run(integrator, step);
  b.run(integrator, step);
  auto const apart = [&](auto const& of_a, auto const& of_b) {
    Frame<double> const f = frame(a.model, a.x, of_a), g = frame(b.model, b.x, of_b);
    return (f.r - g.r).norm() + (f.A - g.A).norm() + (f.v - g.v).norm() + (f.w - g.w).norm();
  };
  EXPECT_LT(apart(a.link.at(Vec3(0, 0, 0)), b.link.at(Vec3(0, 0, 0))), tolerance);
  EXPECT_LT(apart(a.top.at(Vec3(0, 0, 0)), b.top.at(Vec3(0, 0, 0))), tolerance);
  Wrench<double> const p = reaction(a.model, a.x, a.pivot), q = reaction(b.model, b.x, b.pivot);
  EXPECT_LT((p.f - q.f).norm(), 100.0 * tolerance);
}

TEST(EulerParameterMotion, IsThatOfTheUnitQuaternion) {
  expect_same_motion(RungeKutta4<Projection>{}, 1e-3, 1e-8);
  // each method has its own error of order h²: 1 ms of a Lie group method against 1 ms of a vector space with a
  // constraint equation
  expect_same_motion(GeneralisedAlpha{}, 2.5e-4, 2e-5);
}

TEST(EulerParameterMotion, KeepsTheNormAndTheEnergy) {
  Mechanism<EulerParameters> m;
  double const start = energy(m.model, m.x).total();
  m.run(GeneralisedAlpha{}, 5e-4);
  EXPECT_NEAR(energy(m.model, m.x).total(), start, 1e-3 * std::abs(start));
  for (Index const at : {3, 10}) EXPECT_NEAR(m.x.q.segment<4>(at).norm(), 1.0, 1e-10);
}

// Counts as in Table 3.4 of Wallin 2016: seven coordinates and one constraint per body.
TEST(EulerParameterCensus, CountsAsTheThesis) {
  Mechanism<EulerParameters> const m;
  ProblemSize const c = problem_size(m.model);
  EXPECT_EQ(c.coordinates, 14);
  EXPECT_EQ(c.constraints, 2 + 3 + 5);
  EXPECT_EQ(c.degrees_of_freedom, 4);
  EXPECT_EQ(c.velocities, 14);
  EXPECT_EQ(c.rows, 10);
  EXPECT_EQ(problem_size(Mechanism<UnitQuaternion>().model).constraints, 10);  // including one for each quaternion
}

TEST(EulerParameterNames, OwnRowIsNamedByItsBody) {
  Mechanism<EulerParameters> const m;
  System system(m.model);
  EXPECT_EQ(system.name_of(14), "body \"top\"");
  EXPECT_EQ(system.name_of(15), "body \"link\"");
  EXPECT_EQ(system.name_of(16), "joint \"pivot\"");
}

}  // namespace rigid_euler_parameters_test
}  // namespace polybody
