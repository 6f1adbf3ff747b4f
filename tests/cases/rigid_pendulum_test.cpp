// Pendulums of one body by every suitable joint and policy: point pendulum of IFToMM A01 (R1), uniform rod (J1) and
// Chrono's joint test against ADAMS (J2).

#include <gtest/gtest.h>

#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/chain.hpp"
#include "support/exact_pendulum.hpp"
#include "support/held.hpp"

using namespace polybody;

namespace rigid_pendulum_test {

constexpr double g = 9.81, half_pi = 0.5 * std::numbers::pi;

using Plane = Chain<InPlane<Constraint>>;
using Space = Chain<InSpace<Constraint>>;
using Ball = Chain<OnBallJoints<Constraint>>;

DormandPrince<Projection> precise() { return {.relative_tolerance = 1e-11, .absolute_tolerance = 1e-11}; }

/// R1, closed form: a point mass, released at (−1, 0).
struct Place {
  double t, x, y;
};
constexpr std::array<Place, 6> r1{{{0.5, -0.3910487915505464, -0.9203699487851922},
                                   {1, 0.9862917511318753, -0.1650108531255412},
                                   {2, -0.7935661953433217, -0.6084839304437915},
                                   {5, -0.9423054350437573, -0.3347543384140006},
                                   {9.99, -0.3164364699130323, -0.9486137045757765},
                                   {10, -0.2750874625761169, -0.9614192050991251}}};

Claim elliptic(char const* case_id, char const* what, char const* formulation) {
  return {case_id, what, By::closed_form, "elliptic functions", formulation};
}

template <class C, class I>
void expect_r1(C const& chain, Marker<typename C::Body> const& end, I const& integrator, double step, double tolerance,
               char const* formulation) {
  State x = chain.model.reference_state();
  for (Place const& p : r1) {
    simulate(chain.model, x, integrator, {.end_time = p.t, .step = step}).run();
    Vec3 const at = position(chain.model, x, end);
    Instance const when{equals("t", p.t)};
    held(elliptic("R1", "x of the point mass [m]", formulation), at[0], p.x, tolerance, when);
    held(elliptic("R1", "y of the point mass [m]", formulation), at[1], p.y, tolerance, when);
    EXPECT_NEAR(at[2], 0.0, 1e-12);
  }
}

TEST(ExactPendulum, HasThePublishedDigits) {
  ExactPendulum const point(-half_pi, g);
  EXPECT_NEAR(point.period(), 2.36784194757623745, 1e-14);
  for (Place const& p : r1) {
    EXPECT_NEAR(std::sin(point(p.t).angle), p.x, 2e-14) << p.t;
    EXPECT_NEAR(-std::cos(point(p.t).angle), p.y, 2e-14) << p.t;
  }
  ExactPendulum const rod(half_pi, 1.5 * g);
  EXPECT_NEAR(rod(0.25).angle, 1.114159968059, 1e-12);
  EXPECT_NEAR(rod(0.25).rate, -3.602307184113, 1e-12);
}

TEST(PointMassPendulum, IsWhereThePublishedSolutionIs) {
  Plane const plane(1, point_link(), g, -half_pi);
  expect_r1(plane, plane.end(0), precise(), 0.01, 1e-8, "in the plane, Dormand–Prince");
  Space const space(1, point_link(), g, -half_pi);
  expect_r1(space, space.end(0), precise(), 0.01, 1e-8, "in space, Dormand–Prince");
}

// A ball with the radius of gyration 0.4 m, 0.8 m from the pivot, swings as a point at 1 m: (0.4² + 0.8²)/0.8 = 1.
TEST(PointMassPendulum, IsThatOfABallOnABallJoint) {
  Ball const chain(1, {.length = 1.0, .mass = 2.0, .inertia = 2.0 * 0.16, .com = 0.8}, g, -half_pi);
  expect_r1(chain, chain.end(0), precise(), 0.01, 1e-8, "a ball on a ball joint, Dormand–Prince");
}

// R1: the benchmark requires an energy error below 5e-5 J over 10 s. Exudyn's index-2 trapezoidal rule needs h =
// 0.8e-3 for it.
TEST(PointMassPendulum, KeepsItsEnergyAsTheBenchmarkAsks) {
  Plane const chain(1, point_link(), g, -half_pi);
  State x = chain.model.reference_state();
  double worst = 0.0;
  for (State const& now : simulate(chain.model, x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = 10.0, .step = 4e-4}))
    worst = std::max(worst, std::abs(energy(chain.model, now).total()));
  EXPECT_LT(worst, 5e-5);
  EXPECT_NEAR(x.q[0], r1.back().x, 1e-4);
}

// Rotation about a fixed axis: the steps of generalised-α on SE(3) agree with those of the plane.
TEST(PointMassPendulum, InSpaceTakesTheStepsOfThePlane) {
  Plane const plane(1, point_link(), g, -half_pi);
  Space const space(1, point_link(), g, -half_pi);
  State in_plane = plane.model.reference_state(), in_space = space.model.reference_state();
  GeneralisedAlpha const integrator{.tolerance = 1e-11};
  RunOptions const options{.end_time = 1.0, .step = 0.01};
  simulate(plane.model, in_plane, integrator, options).run();
  simulate(space.model, in_space, integrator, options).run();
  EXPECT_NEAR(plane.angle(in_plane), space.angle(in_space), 1e-9);
  EXPECT_NEAR(in_plane.v[2], in_space.v[5], 1e-8);
  EXPECT_LT((in_plane.lambda - in_space.lambda.head<2>()).norm(), 1e-6);
  EXPECT_NEAR(std::sin(plane.angle(in_plane)), r1[1].x, 2e-3);  // h = 0.01
}

/// J1: uniform rod released from the horizontal. R acts on the rod at the pivot.
struct Swing {
  double t, angle, rate, rx, ry;
};
constexpr std::array<Swing, 4> swings{{{0.0, half_pi, 0.0, 0.0, 2.4525},
                                       {0.25, 1.114159968059, -3.602307184113, -8.7352815388, 6.7438504085},
                                       {0.5, -0.090352089956, -5.413866990753, 1.9834605859, 24.3453009333},
                                       {1.0, -1.562621718035, 0.490485531299, 0.1804260137, 2.4539749449}}};

template <class C>
void expect_j1(C const& chain, double tolerance, char const* formulation) {
  State x = chain.model.reference_state();
  for (Swing const& s : swings) {
    simulate(chain.model, x, precise(), {.end_time = s.t, .step = 0.01}).run();
    held(elliptic("J1", "angle of the rod [rad]", formulation), chain.angle(x), s.angle, tolerance, {equals("t", s.t)});
    Vec3 const force(s.rx, s.ry, 0.0);
    held_within(elliptic("J1", "reaction of the pin [N]", formulation),
                (reaction(chain.model, x, chain.hinges[0]).f - force).norm(), 30.0 * tolerance,
                {equals("t", s.t), force.norm()});
    // The joint's axes are those of the world at the start and rotate with the rod.
    Mat3 const turned = exp_so3<double>(Vec3(0, 0, s.angle - half_pi));
    Wrench<> const local = reaction(chain.model, x, chain.hinges[0], ReactionAxes::joint);
    EXPECT_LT((local.f - turned.transpose() * force).norm(), 30.0 * tolerance) << s.t;
    EXPECT_NEAR(local.m.norm(), 0.0, 1e-9);  // the pin constrains the plane of the rod
  }
  simulate(chain.model, x, precise(), {.end_time = 2.0, .step = 0.01}).run();
  held(elliptic("J1", "angle of the rod [rad]", formulation), chain.angle(x), 1.538098984222, tolerance, {"t = 2"});
}

TEST(RodPendulum, HasThePublishedReactions) { expect_j1(Plane(1, bar_link()), 1e-9, "in the plane, Dormand–Prince"); }

TEST(RodPendulum, HasThePublishedReactionsInSpace) {
  expect_j1(Space(1, bar_link()), 1e-9, "in space, Dormand–Prince");
}

// The pin is at the distance d along its axis from the plane of the rod. The motion is the same. The moment on the
// rod about the point of the pin is d e_z × R, here in the rotated axes of the joint.
TEST(RodPendulum, PinBesideTheRodCarriesAMoment) {
  using Pin = Joint<Revolute, Constraint>;
  double const d = 0.3;
  Model<Bodies<Rigid<>>, Joints<Pin>> model{Gravity{0, -g, 0}};
  auto const rod = model.add(
      Rigid<>(1.0, Vec3(0.0, 1.0 / 12, 1.0 / 12).asDiagonal().toDenseMatrix(), Placement::at({0.5, 0, 0})), "rod");
  auto const pin = model.connect(Pin{Revolute{.axis = Vec3::UnitZ()}, {}}, model.ground().at({0, 0, -d}),
                                 rod.at(Vec3(-0.5, 0, -d)), "pin");
  State x = model.reference_state();
  for (Swing const& s : swings) {
    simulate(model, x, precise(), {.end_time = s.t, .step = 0.01}).run();
    Vec3 const force(s.rx, s.ry, 0.0), moment = d * Vec3::UnitZ().cross(force);
    Wrench<> const world = reaction(model, x, pin), local = reaction(model, x, pin, ReactionAxes::joint);
    char const* const beside = "pin 0.3 m beside the rod, Dormand–Prince";
    held_within(elliptic("J1", "reaction of the pin [N]", beside), (world.f - force).norm(), 1e-7,
                {equals("t", s.t), force.norm()});
    held_within(elliptic("J1", "moment of the pin [N m]", beside), (world.m - moment).norm(), 1e-7,
                {equals("t", s.t), moment.norm()});
    // the third axis is that of the pin; the two others are arbitrary
    EXPECT_NEAR(local.m.norm(), moment.norm(), 1e-7);
    EXPECT_NEAR(local.m[2], 0.0, 1e-9);
  }
}

// J2, Revolute_Case01 (independent computation): a bar of inertia (0.04, 0.1, 0.1) along X on a pin along Y, 2 m from
// its middle, g along −z. Compared are x and z of the middle. The position tolerance of Chrono's test is 2e-3 at h =
// 5e-4.
TEST(RodPendulum, FollowsTheAdamsCase) {
  struct {
    double t, x, z;
  } const exact[] = {{1, -0.892381486, -1.789875773},
                     {2, -1.951117169, -0.439479003},
                     {3, 1.869169564, -0.711480948},
                     {4, 1.296964691, -1.522459388},
                     {5, -1.999683869, -0.035558748}};
  using Pin = Joint<Revolute, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Pin>> model{Gravity{0, 0, -9.80665}};
  auto const bar =
      model.add(Rigid<>(1.0, Vec3(0.04, 0.1, 0.1).asDiagonal().toDenseMatrix(), Placement::at({2, 0, 0})), "bar");
  model.connect(Pin{Revolute{.axis = Vec3::UnitY()}, {}}, model.ground().at({0, 0, 0}), bar.at(Vec3(-2, 0, 0)), "pin");
  State fine = model.reference_state(), coarse = fine;
  for (auto const& e : exact) {
    simulate(model, fine, precise(), {.end_time = e.t, .step = 0.01}).run();
    char const* const what = "Revolute_Case01: middle of the bar [m]";
    Instance const at{equals("t", e.t), 2.0};
    held_within(elliptic("J2", what, "Dormand–Prince"), (fine.q.head<3>() - Vec3(e.x, 0, e.z)).norm(), 1e-8, at);
    simulate(model, coarse, GeneralisedAlpha{}, {.end_time = e.t, .step = 5e-4}).run();
    held_within(elliptic("J2", what, "generalised-α, h = 5e-4 s"), (coarse.q.head<3>() - Vec3(e.x, 0, e.z)).norm(),
                1e-5, at);
  }
}

/// Time from a release at the horizontal until the rod is again at rest on the same side [s].
template <class C>
double period(C const& chain, double h = 1e-3) {
  State x = chain.model.reference_state();
  Index const spin = x.v.size() - 1;  // about z, the last velocity in the plane and in space
  auto run = simulate(chain.model, x, GeneralisedAlpha{.rho_inf = 0.9},
                      {.end_time = 3.0, .step = h, .events = {{.name = "at rest", .value = [spin](State const& s) {
                                                                 return s.v[spin];
                                                               }}}});
  run.run();
  auto const& met = run.report().events;
  return met.size() < 2 ? std::numeric_limits<double>::quiet_NaN() : met[1].time;
}

Penalty stiff(double k) { return {.stiffness = k, .damping = 0.7 * std::sqrt(k)}; }

TEST(RodPendulum, HasTheAnalyticPeriod) {
  double const exact = ExactPendulum(half_pi, 1.5 * g).period();
  double const coarse = period(Plane(1, bar_link()), 1e-3) - exact, fine = period(Plane(1, bar_link()), 2.5e-4) - exact;
  held(elliptic("J1", "period of the rod [s]", "in the plane, generalised-α, h = 2.5e-4 s"), exact + fine, exact, 5e-7);
  EXPECT_NEAR(coarse / fine, 16.0, 1.0);  // second order
  held(elliptic("J1", "period of the rod [s]", "in space, generalised-α, h = 2.5e-4 s"),
       period(Space(1, bar_link()), 2.5e-4), exact, 5e-7);
}

// Compliant joints approach the ideal one with 1/k.
TEST(RodPendulum, PeriodOfAStiffPenaltyTendsToThatOfTheConstraint) {
  double const ideal = period(Plane(1, bar_link()));
  double const soft = period(Chain<InPlane<Penalty>>(1, bar_link(), g, half_pi, stiff(1e4))) - ideal;
  double const firm = period(Chain<InPlane<Penalty>>(1, bar_link(), g, half_pi, stiff(1e5))) - ideal;
  EXPECT_LT(std::abs(soft), 5e-3);
  EXPECT_NEAR(soft / firm, 10.0, 1.5);
  EXPECT_NEAR(period(Chain<InPlane<Penalty>>(1, bar_link(), g, half_pi, stiff(1e8))), ideal, 2e-6);
  EXPECT_NEAR(period(Chain<InSpace<Penalty>>(1, bar_link(), g, half_pi, stiff(1e8))), ideal, 2e-6);
}

// J1: the constraint violation of a compliant pin is |R|/k with R of the ideal pin.
TEST(RodPendulum, GapOfAPenaltyIsTheReactionOverItsStiffness) {
  auto const expect_gap = [](auto const& chain, double k, char const* formulation) {
    State x = chain.model.reference_state();
    for (Swing const& s : {swings[1], swings[2]}) {
      simulate(chain.model, x, GeneralisedAlpha{}, {.end_time = s.t, .step = 5e-4}).run();
      Vec3 const force(s.rx, s.ry, 0.0);
      held({"J1", "gap of a penalty of 1e7 N/m [m]", By::closed_form, "reaction of the ideal pin over k", formulation},
           constraint_violation(chain.model, x, chain.hinges[0]).norm(), force.norm() / k, 2e-3 * force.norm() / k,
           {equals("t", s.t)});
      held_within(elliptic("J1", "reaction of a penalty of 1e7 N/m [N]", formulation),
                  (reaction(chain.model, x, chain.hinges[0]).f - force).norm(), 2e-3 * force.norm(),
                  {equals("t", s.t), force.norm()});
    }
  };
  expect_gap(Chain<InPlane<Penalty>>(1, bar_link(), g, half_pi, stiff(1e7)), 1e7,
             "in the plane, generalised-α, h = 5e-4 s");
  expect_gap(Chain<InSpace<Penalty>>(1, bar_link(), g, half_pi, stiff(1e7)), 1e7,
             "in space, generalised-α, h = 5e-4 s");
}

}  // namespace rigid_pendulum_test
