// Joint coordinates in the plane: loops closed by another policy, implicit steps, flexible bodies in a tree,
// refusals.
#include <gtest/gtest.h>

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/problem_size.hpp>
#include <polybody/run/simulate.hpp>

#include "support/chain.hpp"
#include "support/held.hpp"
#include "support/refusal.hpp"

using namespace polybody;

namespace recursive_loop_test {

using ByBodies = JointCoordinatesBy<joint_coordinates::ArticulatedBody>;

/// A planar four-bar linkage, with a separate policy for the last pin.
template <class Policy>
struct FourBar {
  using Pin = Joint<planar::Revolute, Policy>;
  using Close = Joint<planar::Revolute, Constraint>;
  using Weld = Joint<planar::Weld, Policy>;
  using Slide = Joint<planar::Prismatic, Policy>;
  using ModelType =
      std::conditional_t<std::is_same_v<Policy, Constraint>,
                         Model<Bodies<planar::Rigid>, Joints<Pin, Weld, Slide>, Forces<SpringDamper>>,
                         Model<Bodies<planar::Rigid>, Joints<Pin, Weld, Slide, Close>, Forces<SpringDamper>>>;
  ModelType model{Gravity{0, -9.81, 0}};
  ElementHandle<Close> last;
  State x;

  FourBar() {
    auto const a = model.add(planar::Rigid(1.0, 0.1, Placement::planar(0.0, 0.5, 0.3)));
    auto const b = model.add(planar::Rigid(2.0, 0.4, Placement::planar(0.75, 1.25, -0.2)));
    auto const c = model.add(planar::Rigid(1.5, 0.2, Placement::planar(1.5, 0.75)));
    auto const tip = model.add(planar::Rigid(0.5, 0.05, Placement::planar(0.75, 1.5)));
    auto const slider = model.add(planar::Rigid(0.4, 0.02, Placement::planar(1.75, 0.75)));
    auto const at = [](auto const& body, double bx, double by, double angle, Vec2 const& p) {
      double const s = std::sin(angle), co = std::cos(angle);
      Vec2 const d = p - Vec2(bx, by);
      return body.at(Vec2(co * d[0] + s * d[1], -s * d[0] + co * d[1]));
    };
    model.connect(Pin{}, model.ground().at({0, 0, 0}), at(a, 0.0, 0.5, 0.3, {0, 0}));
    model.connect(Pin{}, at(b, 0.75, 1.25, -0.2, {0, 1}), at(a, 0.0, 0.5, 0.3, {0, 1}));
    model.connect(Pin{}, at(b, 0.75, 1.25, -0.2, {1.5, 1.5}), at(c, 1.5, 0.75, 0.0, {1.5, 1.5}));
    model.connect(Weld{}, at(tip, 0.75, 1.5, 0.0, {0.75, 1.25}), at(b, 0.75, 1.25, -0.2, {0.75, 1.25}));
    model.connect(Slide{{.axis = Vec3(0, 1, 0)}}, at(c, 1.5, 0.75, 0.0, {1.6, 0.75}),
                  at(slider, 1.75, 0.75, 0.0, {1.6, 0.75}));
    last = model.connect(Close{}, at(c, 1.5, 0.75, 0.0, {1.5, 0}), model.ground().at({1.5, 0, 0}));
    model.apply(SpringDamper{.stiffness = 200.0, .damping = 2.0, .free_length = 0.4},
                at(slider, 1.75, 0.75, 0.0, {1.75, 0.75}), model.ground().at({1.75, 0.2, 0}));
    x = model.reference_state();
  }
};

template <class Policy, class I>
FourBar<Policy> run_four_bar(I integrator, double step) {
  FourBar<Policy> f;
  simulate(f.model, f.x, integrator, {.end_time = 0.5, .step = step}).run();
  return f;
}

TEST(RecursiveLoop, LoopsCloseByAnotherPolicy) {
  auto const tied = run_four_bar<Constraint>(RungeKutta4<Projection>{}, 1e-3);
  auto const open = run_four_bar<JointCoordinates>(RungeKutta4<Projection>{}, 1e-3);
  auto const bodies = run_four_bar<ByBodies>(RungeKutta4<Projection>{}, 1e-3);
  EXPECT_EQ(problem_size(open.model).rows, 2);
  EXPECT_EQ(problem_size(open.model).velocities, 4);
  EXPECT_EQ(problem_size(open.model).degrees_of_freedom, 2);
  Vec3 const force = reaction(tied.model, tied.x, tied.last).f;
  EXPECT_GT(force.norm(), 1.0);
  System tied_system(tied.model);
  tied_system.evaluate(tied.x.q, tied.x.v, tied.x.t);
  double const most = peak_joint_force(tied_system, tied.x);
  EXPECT_GE(most, force.norm());
  auto const expect_same = [&](char const* way, auto const& other) {
    auto const apart = [&](char const* what, double distance, double tolerance, double scale) {
      held_within({"closed forms", what, By::itself, "Constraint", std::string("joint coordinates, ") + way}, distance,
                  tolerance, {.scale = scale});
    };
    apart("coordinates of a loop closed by another policy", (tied.x.q - other.x.q).norm(), 1e-8, 1.0);
    apart("accelerations of a loop closed by another policy, of their size",
          (tied.x.a - other.x.a).norm() / tied.x.a.norm(), 1e-6, 1.0);
    apart("force of the pin that closes a loop, of its size",
          (force - reaction(other.model, other.x, other.last).f).norm() / force.norm(), 1e-6, 1.0);
    System system(other.model);
    EXPECT_LT(largest_violation(system, other.x).position, 1e-11);
    EXPECT_NEAR(peak_joint_force(system, other.x), most, 1e-6 * most);
  };
  expect_same("augmented", open);
  expect_same("body by body", bodies);
}

// A joint for both space and plane has three rotations and two translations in space, one of each in the plane. The
// normal of the plane is any of the joint's axes, in either direction.
template <class Policy>
State run_on_lines() {
  using Foot = Joint<PointInPlane, Policy>;
  using Pin = Joint<planar::Revolute, Policy>;
  Model<Bodies<planar::Rigid>, Joints<Foot, Pin>> model{Gravity{2.0, -9.81, 0}};
  auto const ground = model.ground();
  Vec3 const normals[] = {{0, 1, 0}, {0, -1, 0}, {1, 0, 0}, {-1, 0, 0}, {0.6, 0.8, 0}, {-0.8, 0.6, 0}};
  for (int i = 0; i < 6; ++i) {
    auto const foot = model.add(planar::Rigid(1.0, 0.1, Placement::planar(i, 0.0, 0.7 * i)));
    auto const tip = model.add(planar::Rigid(0.5, 0.1, Placement::planar(i, 1.0, 0.3)));
    Foot const on_line{{.normal = normals[i]}, {}};
    if (i % 2 == 0)
      model.connect(on_line, ground.at({double(i), 0, 0}), foot.at(Vec2(0.2, 0.1)));
    else
      model.connect(on_line, foot.at(Vec2(0.2, 0.1)), ground.at({double(i), 0, 0}));
    model.connect(Pin{}, foot.at(Vec2(-0.1, 0.3)), tip.at(Vec2(0, 0)));
  }
  State x = model.reference_state();
  assemble(model, x);
  simulate(model, x, RungeKutta4<Projection>{}, {.end_time = 0.3, .step = 1e-3}).run();
  return x;
}

TEST(RecursiveLoop, JointOfBothWorldsKeepsToThePlane) {
  State const held = run_on_lines<Constraint>();
  for (State const& x : {run_on_lines<JointCoordinates>(), run_on_lines<ByBodies>()}) {
    EXPECT_LT((held.q - x.q).norm(), 1e-8);
    EXPECT_LT((held.a - x.a).norm(), 1e-6 * held.a.norm());
    EXPECT_LT((held.lambda - x.lambda).norm(), 1e-6 * held.lambda.norm());
  }
}

TEST(RecursiveLoop, ImplicitStepsHaveTheirOrder) {
  auto const exact = run_four_bar<JointCoordinates>(RungeKutta4<Projection>{}, 5e-4);
  double last = 0.0;
  for (double const h : {4e-3, 2e-3, 1e-3}) {
    double const off = (run_four_bar<JointCoordinates>(GeneralisedAlpha{.rho_inf = 0.8}, h).x.q - exact.x.q).norm();
    if (last > 0.0) {
      EXPECT_NEAR(std::log2(last / off), 2.0, 0.15);
    }
    last = off;
  }
  EXPECT_GT(last, 1e-9);
  auto const bodies = run_four_bar<ByBodies>(GeneralisedAlpha{.rho_inf = 0.8}, 1e-3);
  EXPECT_NEAR((bodies.x.q - exact.x.q).norm(), last, 0.01 * last);
}

TEST(RecursiveLoop, FlexibleBodiesHangOnATreeByAnotherPolicy) {
  auto const tip = [](auto policy) {
    using P = decltype(policy);
    using Pin = Joint<planar::Revolute, P>;
    using Clamp = Joint<planar::Weld, Constraint>;
    Model<Bodies<planar::Rigid, planar::AncfCable<>>, Joints<Pin, Clamp>> model{Gravity{0, -9.81, 0}};
    auto const arm = model.add(planar::Rigid(1.0, 0.1, Placement::planar(0.5, 0.0)));
    auto const beam =
        model.add(planar::AncfCable<>::from({.length = 1.0,
                                             .constants = BarConstants{.EA = 1e4, .EI = 10.0, .mass_per_length = 1.0},
                                             .placement = Placement::planar(1.0, 0.0)},
                                            3));
    model.connect(Pin{}, model.ground().at({0, 0, 0}), arm.at(Vec2(-0.5, 0)));
    model.connect(Clamp{}, arm.at(Vec2(0.5, 0)), beam.at(0.0));
    State x = model.reference_state();
    simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.3, .step = 1e-3}).run();
    return position(model, x, beam.at(1.0));
  };
  Vec3 const tied = tip(Constraint{}), free = tip(JointCoordinates{});
  EXPECT_GT(std::abs(tied[1]), 0.1);
  held_within({"closed forms", "tip of a cable on a rigid arm [m]", By::itself, "Constraint",
               "joint coordinates and Constraint"},
              (tied - free).norm(), 1e-5, {.scale = 1.0});  // both have an error of h²
}

// Discrete catenary (S11), in equilibrium: ten links of 0.1 m and 1 kg hang over 0.8 m; tan θᵢ = (V − m g (i + ½))/H.
// The links stay at rest, and the reactions of the tree's pins are computed.
TEST(RecursiveLoop, ChainHangsWithThePublishedForces) {
  using Loop = FourBar<JointCoordinates>;
  Loop::ModelType model{Gravity{0, -9.81, 0}};
  double const H = 33.0892370968, V = 49.05, length = 0.1;
  std::vector<ElementHandle<Loop::Pin>> pins;
  std::vector<BodyHandle<planar::Rigid>> links;
  Vec2 const end(0.5 * length, 0.0);
  Vec2 r(0.0, 0.0);
  for (int i = 0; i < 10; ++i) {
    double const angle = -std::atan2(V - 9.81 * (i + 0.5), H);
    Vec2 const half = 0.5 * length * Vec2(std::cos(angle), std::sin(angle));
    r += half;
    links.push_back(model.add(planar::Rigid(1.0, length * length / 12.0, Placement::planar(r[0], r[1], angle))));
    auto const here = links.back().at(-end);
    if (i == 0)
      pins.push_back(model.connect(Loop::Pin{}, model.ground().at({0, 0, 0}), here));
    else
      pins.push_back(model.connect(Loop::Pin{}, links[std::size_t(i) - 1].at(end), here));
    r += half;
  }
  auto const closing = model.connect(Loop::Close{}, links.back().at(end), model.ground().at({0.8, 0, 0}));
  EXPECT_EQ(problem_size(model).velocities, 10);
  EXPECT_EQ(problem_size(model).rows, 2);
  State x = model.reference_state();
  VecX const hanging = x.q;
  simulate(model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 0.1, .step = 1e-2}).run();
  char const *const links_are = "10 rigid links on joint coordinates, generalised-α, 10 steps",
                    *by = "balance of each link";
  held_within({"S11", "places and turns of the hanging links [m, rad]", By::closed_form, by, links_are},
              (x.q - hanging).norm(), 1e-9, {.scale = hanging.norm()});
  Claim const force{"S11", "forces in the chain's pins [N]", By::closed_form, by, links_are};
  held_within(force, (reaction(model, x, pins[0]).f - Vec3(-H, V, 0)).norm(), 1e-6, {"first", V});
  held_within(force, (reaction(model, x, pins[5]).f - Vec3(-H, 0, 0)).norm(), 1e-6, {"middle", H});
  held_within(force, (reaction(model, x, closing).f - Vec3(-H, -V, 0)).norm(), 1e-6, {"last", V});
}

TEST(RecursiveLoop, EventsSeeTheWholeState) {
  using Pin = Joint<planar::Revolute, JointCoordinates>;
  Model<Bodies<planar::Rigid>, Joints<Pin>> model{Gravity{0, -9.81, 0}};
  auto const rod = model.add(planar::Rigid(1.0, 1.0 / 12.0, Placement::planar(0.5, 0.0)));
  model.connect(Pin{}, model.ground().at({0, 0, 0}), rod.at(Vec2(-0.5, 0)));
  State x = model.reference_state();
  auto run =
      simulate(model, x, DormandPrince<>{.relative_tolerance = 1e-11, .absolute_tolerance = 1e-12},
               {.end_time = 5.0,
                .step = 1e-3,
                .events = {{.name = "below", .value = [](State const& s) { return s.q[0]; }, .terminal = true}}});
  run.run();
  // a quarter of the period of amplitude π/2: K(½) √(2L/3g)
  held({"R1", "time from the level to the lowest place [s]", By::closed_form, "K(½) √(2L/3g)",
        "joint coordinates, Dormand–Prince"},
       x.t, 1.8540746773013719 * std::sqrt(2.0 / (3.0 * 9.81)), 1e-8);
  EXPECT_NEAR(x.q[0], 0.0, 1e-8);
}

TEST(RecursiveLoop, NamesTheJointThatClosesALoop) {
  using Pin = Joint<planar::Revolute, JointCoordinates>;
  Model<Bodies<planar::Rigid>, Joints<Pin>> model;
  auto const a = model.add(planar::Rigid(1.0, 0.1)), b = model.add(planar::Rigid(1.0, 0.1));
  model.connect(Pin{}, model.ground().at({0, 0, 0}), a.at(Vec2(0, 0)));
  model.connect(Pin{}, a.at(Vec2(0, 0)), b.at(Vec2(0, 0)));
  model.connect(Pin{}, b.at(Vec2(0, 0)), model.ground().at({0, 0, 0}), "closing pin");
  State x = model.reference_state();
  std::string const why =
      refusal([&] { simulate(model, x, RungeKutta4<Projection>{}, {.end_time = 1.0, .step = 1e-3}); });
  EXPECT_TRUE(has(why, "\"closing pin\" closes a loop"));
  EXPECT_TRUE(has(why, "Constraint"));
}

TEST(RecursiveLoop, EliminationByBodiesNamesAForceThatItCannotTake) {
  using Pin = Joint<planar::Revolute, ByBodies>;
  Model<Bodies<planar::Rigid>, Joints<Pin>, Forces<SpringDamper>> model;
  auto const a = model.add(planar::Rigid(1.0, 0.1), "a"), b = model.add(planar::Rigid(1.0, 0.1), "b"),
             c = model.add(planar::Rigid(1.0, 0.1), "c");
  model.connect(Pin{}, model.ground().at({0, 0, 0}), a.at(Vec2(0, 0)));
  model.connect(Pin{}, a.at(Vec2(0, 0)), b.at(Vec2(0, 0)));
  model.connect(Pin{}, b.at(Vec2(0, 0)), c.at(Vec2(0, 0)));
  model.apply(SpringDamper{.stiffness = 1.0, .damping = 0.0, .free_length = 1.0}, a.at(Vec2(1, 0)), c.at(Vec2(0, 1)));
  State x = model.reference_state();
  EXPECT_NO_THROW(
      // M alone has no such block
      simulate(model, x, RungeKutta4<Projection>{}, {.end_time = 1e-2, .step = 1e-3}).run());
  std::string const why =
      refusal([&] { simulate(model, x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 1e-3}).run(); });
  EXPECT_TRUE(has(why, "\"c\""));
  EXPECT_TRUE(has(why, "Augmented"));
}

template <class Policy>
RunReport fall_of_a_chain() {
  Chain<InPlane<Policy>> chain(64, bar_link(0.1));
  State x = chain.model.reference_state();
  return simulate(chain.model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 1.0, .step = 1e-3}).run();
}
// With −Tᵀr as the residual instead of the r of the bodies, 419 factorisations instead of 295.
TEST(RecursiveLoop, KeepsAFactorisationAsLongAsItsBodiesWouldDo) {
  RunReport const reduced = fall_of_a_chain<JointCoordinates>(), full = fall_of_a_chain<Constraint>();
  EXPECT_LT(double(reduced.factorisations), 1.25 * double(full.factorisations));
  EXPECT_LT(double(reduced.iterations), 1.1 * double(full.iterations));
}

/// The largest unbalanced force in the states of a falling chain.
template <class Policy>
double out_of_balance() {
  Chain<InPlane<Policy>> chain(16, bar_link(0.1));
  State x = chain.model.reference_state();
  auto run =
      simulate(chain.model, x, GeneralisedAlpha{.rho_inf = 0.8},
               {.end_time = 0.5, .step = 1e-3, .events = {{.name = "first link below", .value = [](State const& s) {
                                                             return s.q[1] + 0.02;
                                                           }}}});
  System full(chain.model);
  VecX r = VecX::Zero(full.velocities()), held = r;
  double worst = 0.0;
  for (State const& shown : run) {
    full.evaluate(shown.q, shown.v, shown.t);
    full.residual(shown.a, shown.lambda, r);
    full.rows_transposed_times(shown.lambda, held);
    worst = std::max(worst, r.norm() / held.norm());
  }
  return worst;
}
// Recorded states use the multipliers of the step. The balance of each body shows the error of the state.
TEST(RecursiveLoop, StatesAreInBalanceWithTheMultipliersOfTheStep) {
  double const reduced = out_of_balance<JointCoordinates>(), full = out_of_balance<Constraint>();
  EXPECT_LT(full, 1e-7);
  EXPECT_LT(reduced, 10.0 * full);
}

}  // namespace recursive_loop_test
