// Generalised and Cartesian moments [Wallin 2016, §3.4] of a spatial double pendulum under a follower moment. The
// rotations are Euler parameters, a quaternion with body-axes angular velocity, or joint coordinates.

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <polybody/bodies/rigid/rigid_euler_parameters.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/problem_size.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"

namespace polybody {
namespace generalised_moments_test {

/// Applied moment in the axes of body b, which tumbles. Its direction in the world changes [N m].
Vec3 const applied(0.8, -0.5, 0.6);

/// Chain: ground, Cardan joint, body a, ball joint, body b.
template <class Rotation, class Policy>
struct Pendulum {
  using Cardan = Joint<Universal, Policy>;
  using Ball = Joint<Spherical, Policy>;
  using ModelType = Model<Bodies<Rigid<Rotation>>, Joints<Cardan, Ball>, Forces<PointMoment<>>>;
  /// Position of the ball from the centres of mass.
  static inline Vec3 const elbow{0.5, 0.1, -0.1}, on_a{0.2, 0.05, -0.1}, on_b{-0.2, 0.0, 0.05};

  ModelType model{Gravity{0, 0, -9.81}};
  BodyHandle<Rigid<Rotation>> a =
      model.add(Rigid<Rotation>(2.0, Vec3(0.02, 0.05, 0.06).asDiagonal(), Placement::at(elbow - on_a)), "a");
  BodyHandle<Rigid<Rotation>> b =
      model.add(Rigid<Rotation>(1.0, Vec3(0.02, 0.01, 0.025).asDiagonal(), Placement::at(elbow - on_b)), "b");
  ElementHandle<Cardan> cardan = model.connect(Cardan{{.first = Vec3::UnitX(), .second = Vec3::UnitY()}, {}},
                                               model.ground().at({0, 0, 0}), a.at(Vec3(on_a - elbow)), "cardan");
  ElementHandle<Ball> ball = model.connect(Ball{}, a.at(on_a), b.at(on_b), "ball");
  State x;

  explicit Pendulum(double h = 5e-4) {
    model.apply(PointMoment<>{.moment = applied, .axes = LoadAxes::marker}, b.at(Vec3(0, 0, 0)));
    x = model.reference_state();
    Vec3 const spin_a(1, 2, 0), spin_b(2, -1, 3);  // rotation of a about both arms of the cross
    model.set_velocity(x, a, Vec3::Zero(), spin_a);
    model.set_velocity(x, b, (spin_a - spin_b).cross(elbow), spin_b);
    simulate(model, x, RungeKutta4<Projection>{}, {.end_time = 1.0, .step = h}).run();
  }
  template <class B>
  Frame<double> of(B const& body) const {
    return frame(model, x, body.at(Vec3(0, 0, 0)));
  }

  /// Generalised force −Gᵀλ on a body of the joints whose multipliers are in lambda [Wallin 2016, Eq. 3.3].
  VecX joint_force(BodyHandle<Rigid<Rotation>> const& body, VecX const& lambda) const {
    System system(model);
    system.evaluate(x.q, x.v, x.t);
    VecX with(model.velocities()), without(model.velocities());
    system.residual(x.a, lambda, with);
    system.residual(x.a, VecX::Zero(model.rows()), without);
    return (without - with).segment(model.entry(body).v0, body.body().velocities());
  }
  /// Multipliers of one joint, zero elsewhere.
  template <class J>
  VecX only(J const& joint) const {
    VecX lambda = VecX::Zero(model.rows());
    auto const& e = model.entry(joint);
    lambda.segment(e.row, e.rows) = x.lambda.segment(e.row, e.rows);
    return lambda;
  }
  /// Generalised force of the applied moment on the rotations of b, without gravity.
  VecX applied_force() const {
    System system(model);
    system.evaluate(x.q, x.v, x.t);
    VecX with(model.velocities()), without(model.velocities());
    system.residual(x.a, x.lambda, with);
    system.load_factor = 0.0;
    system.residual(x.a, x.lambda, without);
    return (without - with).segment(model.entry(b).v0 + 3, b.body().velocities() - 3);
  }
};

using Parameters = Pendulum<EulerParameters, Constraint>;
using Cartesian = Pendulum<UnitQuaternion, Constraint>;
using Relative = Pendulum<UnitQuaternion, JointCoordinates>;

/// The three models after one second.
struct Runs {
  Parameters parameters;
  Cartesian cartesian;
  Relative relative;
};
Runs const& runs() {
  static Runs const all;
  return all;
}

template <class A, class B>
double apart(A const& one, B const& other) {
  double sum = 0.0;
  auto const add = [&sum](Frame<double> const& f, Frame<double> const& g) {
    sum += (f.r - g.r).norm() + (f.A - g.A).norm() + (f.v - g.v).norm() + (f.w - g.w).norm();
  };
  add(one.of(one.a), other.of(other.a));
  add(one.of(one.b), other.of(other.b));
  return sum;
}
/// Ḡ (3×4) of θ = (θ₀, θ₁, θ₂, θ₃), |θ| = 1: Ω = Ḡ θ̇ = 2 Im(θ* θ̇), the quaternion product.
Mat<double, 3, 4> g_bar(Vec4 const& theta) {
  Eigen::Quaterniond const back = Eigen::Quaterniond(theta[0], theta[1], theta[2], theta[3]).conjugate();
  Mat<double, 3, 4> g;
  for (int j = 0; j < 4; ++j)
    g.col(j) = 2.0 * (back * Eigen::Quaterniond(double(j == 0), double(j == 1), double(j == 2), double(j == 3))).vec();
  return g;
}
Vec4 theta_of(Parameters const& p, BodyHandle<Rigid<EulerParameters>> const& body) {
  return p.x.q.segment<4>(p.model.entry(body).q0 + 3);
}

// Each model has an error C h⁴. Richardson's difference to the result of twice the step estimates the error. The
// distance of any two models is below this estimate.
TEST(EulerParameterMoments, MakeOneMotionToTheAccuracyOfTheSteps) {
  auto const& [p, c, r] = runs();
  double const of_p = apart(Parameters(1e-3), p) / 15.0, of_c = apart(Cartesian(1e-3), c) / 15.0;
  double const of_r = apart(Relative(1e-3), r) / 15.0;
  for (double const error : {of_p, of_c, of_r}) {
    EXPECT_LT(error, 3e-8);
    EXPECT_GT(error, 1e-10);
  }
  EXPECT_LT(apart(p, c), of_p + of_c);
  EXPECT_LT(apart(r, c), of_r + of_c);
  auto const one_motion = [](char const* formulation, double distance) {
    held_within({"thesis §3.4", "places, turns and their rates of two bodies after 1 s", By::itself,
                 "Rigid<UnitQuaternion>, Constraint", formulation},
                distance, 3e-8, {.scale = 1.0});
  };
  one_motion("Rigid<EulerParameters>, Constraint, Runge–Kutta 4", apart(p, c));
  one_motion("joint coordinates, Runge–Kutta 4", apart(r, c));
  EXPECT_GT((c.of(c.b).A - Mat3::Identity()).norm(), 1.0);  // it has tumbled
}

// A cross carries a moment perpendicular to both its arms, a ball none.
TEST(EulerParameterMoments, JointsHoldTheSameForcesAndMoments) {
  auto const& [p, c, r] = runs();
  auto const expect = [&c = c](char const* formulation, auto const& other) {
    auto const claim = [&](char const* what) {
      return Claim{"thesis §3.4", what, By::itself, "Rigid<UnitQuaternion>, Constraint", formulation};
    };
    auto const same = [&](Wrench<double> const& one, Wrench<double> const& two) {
      held_within(claim("forces of a cross and a ball after 1 s [N]"), (one.f - two.f).norm(), 1e-6,
                  {.scale = two.f.norm()});
      held_within(claim("moments of a cross and a ball after 1 s [N m]"), (one.m - two.m).norm(), 1e-6, {.scale = 1.0});
    };
    Wrench<double> const cardan = reaction(other.model, other.x, other.cardan),
                         ball = reaction(other.model, other.x, other.ball);
    same(cardan, reaction(c.model, c.x, c.cardan));
    same(ball, reaction(c.model, c.x, c.ball));
    EXPECT_GT(cardan.f.norm(), 10.0);
    EXPECT_GT(cardan.m.norm(), 1.0);
    EXPECT_LT(std::abs(cardan.m[0]), 1e-12);                               // the arm on the ground
    EXPECT_LT(std::abs(cardan.m.dot(other.of(other.a).A.col(1))), 1e-12);  // the arm on a
    EXPECT_LT(ball.m.norm(), 1e-12);
  };
  expect("Rigid<EulerParameters>, Constraint", p);
  expect("Rigid<UnitQuaternion>, Constraint", c);
  expect("joint coordinates", r);
}

// −Gᵀλ of a joint on a body, compared with its Cartesian force F and moment M at the point u from the centre of mass.
// The translational part is F. The rotational part is Ḡᵀ Aᵀ(M + u × F) for the four rates of the parameters, and Aᵀ(M
// + u × F) for the three components of the angular velocity [Wallin 2016, Eq. 3.7].
TEST(EulerParameterMoments, OfAJointAreTheCartesianOnesByG) {
  auto const& [p, c, r] = runs();
  auto const expect = [&p = p, &c = c](auto const& joint_p, auto const& joint_c, auto const& body_p, auto const& body_c,
                                       Vec3 const& at, double side) {
    Wrench<double> const w = reaction(c.model, c.x, joint_c);
    Vec3 const force = side * w.f;
    Vec3 const moment = c.of(body_c).A.transpose() * (side * w.m) + at.cross(c.of(body_c).A.transpose() * force);
    EXPECT_GT(moment.norm(), 1.0);
    VecX const six = c.joint_force(body_c, c.only(joint_c)), seven = p.joint_force(body_p, p.only(joint_p));
    ASSERT_EQ(six.size(), 6);
    ASSERT_EQ(seven.size(), 7);
    auto const within = [](char const* what, char const* source, char const* formulation, double error,
                           double tolerance, double scale) {
      held_within({"thesis §3.4", what, By::closed_form, source, formulation}, error, tolerance, {.scale = scale});
    };
    char const *const quaternion = "Rigid<UnitQuaternion>", *const parameters = "Rigid<EulerParameters>";
    within("joint force in the rows of a body [N]", "F", quaternion, (six.head<3>() - force).norm(),
           1e-12 * force.norm(), force.norm());
    EXPECT_LT((six.tail<3>() - moment).norm(), 1e-12 * moment.norm());
    within("joint moment in the rows of a body [N m]", "Aᵀ (M + u × F)", quaternion, (six.tail<3>() - moment).norm(),
           1e-11, moment.norm());
    within("joint force in the rows of a body [N]", "F of another run", parameters, (seven.head<3>() - force).norm(),
           1e-6, force.norm());
    Vec4 const theta = theta_of(p, body_p), generalised = seven.tail<4>();
    double const size = 2.0 * moment.norm();
    within("generalised joint moment of the parameters [N m]", "Ḡᵀ Aᵀ (M + u × F) [thesis Eq. 3.7]", parameters,
           (generalised - g_bar(theta).transpose() * moment).norm(), 1e-6, size);
    within("its size [N m]", "2 ‖M‖, as Ḡ Ḡᵀ = 4 1", parameters, std::abs(generalised.norm() - size), 1e-6, size);
    within("Cartesian moment of it [N m]", "¼ Ḡ of it", parameters, (0.25 * g_bar(theta) * generalised - moment).norm(),
           1e-6, size);
    within("its part along the parameters [N m]", "0, as Ḡ θ = 0", parameters, std::abs(generalised.dot(theta)), 1e-9,
           size);
  };
  Vec3 const pivot = p.on_a - p.elbow;
  expect(p.cardan, c.cardan, p.a, c.a, pivot, 1.0);
  expect(p.ball, c.ball, p.a, c.a, p.on_a, -1.0);
  expect(p.ball, c.ball, p.b, c.b, p.on_b, 1.0);
}

// Moments have no component along θ, so the constraint forces of the norms are zero.
TEST(EulerParameterMoments, LeaveNothingToTheNormsOfTheParameters) {
  Parameters const& p = runs().parameters;
  for (auto const& body : {p.a, p.b}) {
    held_within({"thesis §3.4", "multiplier of the norm of the parameters", By::closed_form, "0, as Ḡ θ = 0",
                 "Rigid<EulerParameters>"},
                std::abs(p.x.lambda[p.model.entry(body).row]), 1e-11, {.scale = 1.0});
    held({"thesis §3.4", "norm of the parameters after 1 s", By::closed_form, "1", "Rigid<EulerParameters>"},
         theta_of(p, body).norm(), 1.0, 1e-12);
  }
}

// Generalised moment of the applied moment M (axes of b): Ḡᵀ M with Euler parameters, M with the quaternion. With
// joint coordinates it consists of the components along the axes of the joints, and is added to the part of the
// weights. All have the power M·Ω.
TEST(EulerParameterMoments, OfALoadHaveItsPower) {
  auto const& [p, c, r] = runs();
  VecX const four = p.applied_force(), three = c.applied_force();
  ASSERT_EQ(four.size(), 4);
  ASSERT_EQ(three.size(), 3);
  Claim const of_four{"thesis §3.4", "generalised moment of a load [N m]", By::closed_form, "Ḡᵀ M",
                      "Rigid<EulerParameters>"};
  held_within(of_four, (four - g_bar(theta_of(p, p.b)).transpose() * applied).norm(), 1e-11, {.scale = four.norm()});
  held({"thesis §3.4", "size of the generalised moment of a load [N m]", By::closed_form, "2 ‖M‖",
        "Rigid<EulerParameters>"},
       four.norm(), 2.0 * applied.norm(), 1e-11);
  held_within({"thesis §3.4", "generalised moment of a load [N m]", By::closed_form, "M", "Rigid<UnitQuaternion>"},
              (three - applied).norm(), 1e-12, {.scale = applied.norm()});
  double const power = applied.dot(c.x.v.segment<3>(c.model.entry(c.b).v0 + 3));
  EXPECT_GT(std::abs(power), 1.0);
  held_within({"thesis §3.4", "power of a load [W]", By::closed_form, "M · Ω", "Rigid<EulerParameters>"},
              std::abs(four.dot(p.x.v.segment<4>(p.model.entry(p.b).v0 + 3)) - power), 1e-6,
              {.scale = std::abs(power)});

  System system = stepped_system(r.model);
  State const reduced = reduce(system, r.x);
  system.evaluate(reduced.q, reduced.v, reduced.t);
  VecX with(system.velocities()), without(system.velocities());
  system.residual(reduced.a, reduced.lambda, with);
  system.load_factor = 0.0;
  system.residual(reduced.a, reduced.lambda, without);
  VecX const five = without - with;
  ASSERT_EQ(five.size(), 2 + 3);
  Frame<double> const a = r.of(r.a), b = r.of(r.b);
  Vec3 const moment = b.A * applied, weight(0, 0, -9.81), elbow = b.r + b.A * r.on_b;
  Vec3 const about_cross = moment + a.r.cross(2.0 * weight) + b.r.cross(weight);
  Claim const axes{"thesis §3.4", "moments of the loads along the axes of the joints [N m]", By::closed_form,
                   "M + Σ r × m g about each axis", "joint coordinates"};
  held_within(axes, std::abs(five[0] - about_cross[0]), 1e-11, {"first arm", about_cross.norm()});
  held_within(axes, std::abs(five[1] - about_cross.dot(a.A.col(1))), 1e-11, {"second arm", about_cross.norm()});
  held_within(axes, std::abs(five.tail<3>().norm() - (moment + (b.r - elbow).cross(weight)).norm()), 1e-11,
              {"ball", about_cross.norm()});
  double const falling = weight.dot(2.0 * a.v + b.v);
  held_within({"thesis §3.4", "power of a load [W]", By::closed_form, "M · Ω + Σ m g · v", "joint coordinates"},
              std::abs(five.dot(reduced.v) - power - falling), 1e-6, {.scale = std::abs(power)});
}

// Counts as in Table 3.4 of Wallin 2016: seven coordinates and one constraint per body, four constraint equations of
// the cross, three of the ball. The joint coordinates of a ball are four parameters with their norm.
TEST(EulerParameterMoments, AreCountedAsInTheThesis) {
  auto const& [p, c, r] = runs();
  auto const expect = [](char const* formulation, ProblemSize const& problem_size, Index coordinates, Index constraints,
                         Index velocities, Index rows) {
    auto const same = [&](char const* what, Index found, Index counted) {
      held({"thesis §3.4", what, By::closed_form, "counted as Table 3.4 does", formulation}, double(found),
           double(counted), 0.0);
    };
    same("coordinates", problem_size.coordinates, coordinates);
    same("constraints", problem_size.constraints, constraints);
    EXPECT_EQ(problem_size.velocities, velocities);
    EXPECT_EQ(problem_size.rows, rows);
    same("degrees of freedom", problem_size.degrees_of_freedom, 5);  // two of the cross, three of the ball
  };
  expect("Rigid<EulerParameters>", problem_size(p.model), 2 * 7, 2 + 4 + 3, 2 * 7, 2 + 4 + 3);
  expect("Rigid<UnitQuaternion>", problem_size(c.model), 2 * 7, 2 + 4 + 3, 2 * 6, 4 + 3);
  expect("joint coordinates", problem_size(r.model), 2 + 4, 1, 5, 0);
}

}  // namespace generalised_moments_test
}  // namespace polybody
