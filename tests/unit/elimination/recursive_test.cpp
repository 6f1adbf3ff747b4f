// Joint coordinates of trees against the same models with multipliers: motion, reactions, violation, counts, three
// solution methods.
#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/problem_size.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"

using namespace polybody;

namespace recursive_test {

using ByBodies = JointCoordinatesBy<joint_coordinates::ArticulatedBody>;

Rigid<> link(double x, double y) {
  return Rigid<>({.mass = 2.0,
                  .inertia = Vec3(0.02, 0.05, 0.06).asDiagonal(),
                  .placement = Placement::at({x, y, 0}, {0.1, 0.2, -0.1})});
}

template <class Policy>
struct Branched {
  template <class G>
  using J = Joint<G, Policy>;
  using ModelType =
      Model<Bodies<Rigid<>>, Joints<J<Revolute>, J<Prismatic>, J<Cylindrical>, J<Spherical>, J<Universal>, J<Screw>,
                                    J<PlanarJoint>, J<PointOnLine>, J<PointInPlane>, J<ConstantOrientation>, J<Weld>>>;
  ModelType model{Gravity{1, -2, -9.81}};
  std::vector<BodyHandle<Rigid<>>> links;

  /// All joints in a tree with two branches; in every second joint the carried body is the first marker.
  Branched() {
    for (int i = 0; i < 11; ++i) links.push_back(model.add(link(0.3 * i, 0.05 * i)));
    hang(J<Revolute>{{.axis = Vec3::UnitY()}}, -1, 0);
    hang(J<Prismatic>{{.axis = Vec3::UnitX()}}, 0, 1);
    hang(J<Cylindrical>{{.axis = Vec3::UnitZ()}}, 1, 2);
    hang(J<Spherical>{}, 2, 3);
    hang(J<Universal>{{.first = Vec3::UnitX(), .second = Vec3::UnitY()}}, 1, 4);
    hang(J<Screw>{{.pitch = 0.2, .axis = Vec3::UnitX()}}, 4, 5);
    hang(J<PlanarJoint>{{.normal = Vec3::UnitY()}}, 4, 6);
    hang(J<PointOnLine>{{.axis = Vec3::UnitX()}}, 6, 7);
    hang(J<PointInPlane>{{.normal = Vec3::UnitZ()}}, 5, 8);
    hang(J<ConstantOrientation>{}, 3, 9);
    hang(J<Weld>{}, 9, 10);
  }
  template <class Joint>
  void hang(Joint const& joint, int carrier, int carried) {
    Vec3 const off(0.1, -0.05, 0.02);
    auto const b = links[std::size_t(carried)].at(off);
    // the joint's point in the world, on both bodies
    Rigid<> const& body = links[std::size_t(carried)].body();
    std::vector<double> q(7);
    body.reference(q);
    Mat3 const axes = rotation_matrix<double>(Quaternion<double>(q[3], q[4], q[5], q[6]));
    Vec3 const point = Vec3(q[0], q[1], q[2]) + axes * off;
    if (carrier < 0) {
      model.connect(joint, model.ground().at(point), b);
      return;
    }
    links[std::size_t(carrier)].body().reference(q);
    auto const a = links[std::size_t(carrier)].at(axes.transpose() * (point - Vec3(q[0], q[1], q[2])));
    if (carried % 2 == 0)
      model.connect(joint, a, b);
    else
      model.connect(joint, b, a);
  }
  State moving() const {
    State x = model.reference_state();
    for (std::size_t i = 0; i < links.size(); ++i) model.set_velocity(x, links[i], {0.2, -0.1, 0.3}, {0.5, -0.4, 0.2});
    return x;
  }
};

template <class Policy, class I>
State moved(Branched<Policy> const& tree, I integrator, double end_time, double step) {
  State x = tree.moving();
  simulate(tree.model, x, integrator, {.end_time = end_time, .step = step}).run();
  return x;
}

TEST(JointCoordinates, MovesEveryJointAsMultipliersDo) {
  Branched<Constraint> const tied;
  Branched<JointCoordinates> const free;
  State const x = moved(tied, RungeKutta4<Projection>{}, 0.3, 1e-3),
              y = moved(free, RungeKutta4<Projection>{}, 0.3, 1e-3);
  // Both have an error of h⁴: the difference to twice the step gives its size (Richardson).
  State const coarse = moved(tied, RungeKutta4<Projection>{}, 0.3, 2e-3);
  double const off = (x.q - coarse.q).norm();
  EXPECT_LT(off, 1e-7);
  EXPECT_LT((x.q - y.q).norm(), 1e-9 + off);
  EXPECT_LT((x.v - y.v).norm(), 1e-8 + 100.0 * off);
  auto const apart = [](char const* what, VecX const& one, VecX const& other, double part) {
    held_within({"closed forms", std::string(what) + " of a tree of eleven joints, of their size", By::itself,
                 "Constraint", "joint coordinates, Runge–Kutta 4"},
                (one - other).norm() / one.norm(), part, {.scale = 1.0});
  };
  apart("coordinates", x.q, y.q, 1e-8);
  apart("accelerations", x.a, y.a, 1e-6);
  apart("multipliers", x.lambda, y.lambda, 1e-6);
}

TEST(JointCoordinates, JointsHoldToRounding) {
  Branched<JointCoordinates> const free;
  State const y = moved(free, RungeKutta4<Projection>{}, 0.3, 1e-3);
  System system(free.model);
  Violation const open = largest_violation(system, y);
  auto const gap = [](char const* what, double value, double tolerance) {
    held_within({"closed forms", what, By::closed_form, "rows hold", "joint coordinates, Runge–Kutta 4"}, value,
                tolerance, {.scale = 1.0});
  };
  gap("violation of the joints of a tree", open.position, 1e-12);
  gap("its rate", open.velocity, 1e-12);
  gap("its second derivative", open.acceleration, 1e-9);
}

TEST(JointCoordinates, TwoWaysToSolveAreOne) {
  State const x = moved(Branched<JointCoordinates>(), RungeKutta4<Projection>{}, 0.1, 1e-3);
  State const y = moved(Branched<ByBodies>(), RungeKutta4<Projection>{}, 0.1, 1e-3);
  auto const apart = [&](char const* what, double distance, double tolerance) {
    held_within({"closed forms", std::string(what) + " of a tree of eleven joints, of their size", By::itself,
                 "joint coordinates, augmented", "joint coordinates, body by body"},
                distance, tolerance, {.scale = 1.0});
  };
  EXPECT_LT((x.q - y.q).norm(), 1e-11);
  apart("coordinates", (x.q - y.q).norm() / x.q.norm(), 1e-11);
  apart("accelerations", (x.a - y.a).norm() / x.a.norm(), 1e-9);
  apart("multipliers", (x.lambda - y.lambda).norm() / x.lambda.norm(), 1e-9);
}

/// Accelerations of a tree under loads on its joint coordinates.
template <class Policy>
VecX answer(Branched<Policy> const& tree) {
  System system = stepped_system(tree.model);
  State const x = reduce(system, tree.moving());
  auto const write = [&](BlockSink& sink) { system.masses(sink); };
  TangentSolver<BlockSolver> solver;
  system.evaluate(x.q, x.v, x.t);
  solver.analyse(system, 1, write);
  EXPECT_EQ(solver.factor(write), -1);
  VecX loads(system.size()), out(system.size());
  for (Index i = 0; i < loads.size(); ++i) loads[i] = std::sin(1.0 + double(i));
  solver.solve(loads, out);
  return out;
}
TEST(JointCoordinates, AnswersLoadsAlikeWhicheverWayItSolves) {
  VecX const sparse = answer(Branched<JointCoordinates>()), bodies = answer(Branched<ByBodies>());
  EXPECT_LT((bodies - sparse).norm(), 1e-10 * sparse.norm());
}

TEST(JointCoordinates, CountsJointCoordinates) {
  // 1 + 1 + 2 + 3 + 2 + 1 + 3 + 4 + 5 + 3 + 0 degrees of freedom; each of four balls has one coordinate more than
  // velocities
  ProblemSize const c = problem_size(Branched<JointCoordinates>().model);
  auto const count = [](char const* what, Index found, Index counted) {
    held({"closed forms", what, By::closed_form, "counted", "joint coordinates"}, double(found), double(counted), 0.0);
  };
  count("speeds of a tree of eleven joints", c.velocities, 25);
  count("coordinates of a tree of eleven joints", c.coordinates, 28);
  EXPECT_EQ(c.rows, 0);
  count("degrees of freedom of a tree of eleven joints", c.degrees_of_freedom, 25);
  EXPECT_EQ(problem_size(Branched<Constraint>().model).degrees_of_freedom, 25);
}

TEST(JointCoordinates, NarrowAndWideStatesAreTheSame) {
  Branched<JointCoordinates> const free;
  State const x = moved(free, RungeKutta4<Projection>{}, 0.2, 1e-3);
  System system = stepped_system(free.model);
  State const reduced = reduce(system, x);
  State again = x;
  again.lambda.setZero();
  VecX scratch;
  expand(system, reduced, again, scratch);
  EXPECT_LT((x.q - again.q).norm(), 1e-12);
  EXPECT_LT((x.v - again.v).norm(), 1e-12 * x.v.norm());
  EXPECT_LT((x.a - again.a).norm(), 1e-11 * x.a.norm());
  EXPECT_LT((x.lambda - again.lambda).norm(), 1e-10 * x.lambda.norm());
}

TEST(JointCoordinates, FreeTreesKeepTheirMomentum) {
  using Ball = Joint<Spherical, JointCoordinates>;
  Model<Bodies<Rigid<>>, Joints<Ball>> model;
  auto const a = model.add(Rigid<>(2.0, Vec3(0.02, 0.05, 0.06).asDiagonal()));
  auto const b = model.add(Rigid<>(1.0, Vec3(0.01, 0.02, 0.02).asDiagonal(), Placement::at({0.5, 0, 0})));
  model.connect(Ball{}, b.at({-0.25, 0, 0}), a.at({0.25, 0, 0}));
  State x = model.reference_state();
  model.set_velocity(x, a, {0, 1, 0}, {0, 0, 2});
  model.set_velocity(x, b, {0, 1, 0}, {0, 0, 2});
  x.v.segment<3>(model.entry(b).v0 + 3) += Vec3(3, -1, 0.5);  // b rotates relative to a
  x.v.segment<3>(model.entry(b).v0) += Vec3(3, -1, 0.5).cross(Vec3(0.25, 0, 0));
  EXPECT_EQ(problem_size(model).degrees_of_freedom, 9);
  auto const momenta = [&] {
    Vec6 p = Vec6::Zero();
    for (auto const* body : {&a, &b}) {
      auto const& e = model.entry(*body);
      Vec3 const r = x.q.segment<3>(e.q0), v = x.v.segment<3>(e.v0);
      Mat3 const A = rotation_matrix<double>(x.q.segment<4>(e.q0 + 3));
      Vec3 const spin = A * (e.body.inertia() * x.v.segment<3>(e.v0 + 3));
      p.head<3>() += e.body.mass() * v;
      p.tail<3>() += e.body.mass() * r.cross(v) + spin;
    }
    return p;
  };
  Vec6 const before = momenta();
  double const energy_before = energy(model, x).total();
  simulate(model, x, RungeKutta4<>{}, {.end_time = 1.0, .step = 1e-3}).run();
  Claim const invariant{"I3", "momenta and energy of two free bodies on a ball joint", By::closed_form, "invariant",
                        "joint coordinates, Runge–Kutta 4"};
  held_within(invariant, (momenta() - before).norm(), 1e-9, {"momenta", before.norm()});
  held_within(invariant, std::abs(energy(model, x).total() - energy_before), 1e-9, {"energy", energy_before});
}

}  // namespace recursive_test
