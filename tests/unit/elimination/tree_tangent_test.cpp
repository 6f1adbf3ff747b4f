// The tangent of an implicit step of a tree, against differences of the residual of the equations of motion. The
// random trees contain every geometry with joint coordinates. This residual is also compared with the residual of the
// full model.
#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/elimination/tree_tangent.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/planar/joints.hpp>

#include "support/held.hpp"
#include "support/random_tree.hpp"

using namespace polybody;

namespace tree_tangent_test {

using namespace random_tree;

/// A random state and accelerations from a seed, in the unknowns of a time step.
struct DrawResult {
  VecX q, v, a, given;
  DrawResult(System& system, State const& x, Draws& draw) : q(x.q), v(x.v), a(x.v), given(x.v) {
    VecX turn = x.v;
    for (VecX* const each : {&turn, &v, &a, &given})
      for (double& d : *each) d = draw.number(-2.0, 2.0);
    system.plus(x.q, turn, q);
  }
};

/// Error of K y relative to `given`, for y = K⁻¹ given. K y is the limit of central differences by Richardson
/// extrapolation.
template <class M>
double tangent_off(M const& model, Draws& draw) {
  System system = stepped_system(model);
  ReductionOf<> const reduction(model);
  DrawResult const x(system, reduce(system, model.reference_state()), draw);
  TreeDynamicsOf<> dynamics(reduction.tree().bodies);
  TreeTangentSolverOf<> tangent(reduction.tree().bodies);
  TangentCoefficients const c{1.2, 0.3, 0.2};
  VecX y = VecX::Zero(x.v.size());
  EXPECT_EQ(tangent.factor({x.q, x.v, 0.0}, x.a, model.gravity().g, c), -1);
  tangent.solve(x.given, y);
  VecX q = x.q, out = y;
  double const unit = 1.0 / (1.0 + y.norm());
  auto const at = [&](double s) {
    s *= unit;
    system.plus(x.q, s * c.stiffness * y, q);
    dynamics.balance(q, x.v + s * c.damping * y, x.a + s * c.mass * y, model.gravity().g, out);
    return out;
  };
  auto const central = [&](double s) { return VecX((at(s) - at(-s)) / (2.0 * s * unit)); };
  VecX const slope = (4.0 * central(1e-3) - central(2e-3)) / 3.0;
  return (slope - x.given).norm() / (x.given.norm() + 1e-2 * y.norm());
}

template <class M>
double balance_off(M const& model, Draws& draw) {
  System system = stepped_system(model);
  ReductionOf<> const reduction(model);
  DrawResult const x(system, reduce(system, model.reference_state()), draw);
  TreeDynamicsOf<> dynamics(reduction.tree().bodies);
  VecX wanted = x.v, out = x.v;
  system.evaluate(x.q, x.v, 0.0);
  system.residual(x.a, VecX(), wanted);
  dynamics.balance(x.q, x.v, x.a, model.gravity().g, out);
  return (out - wanted).norm() / (1.0 + wanted.norm());
}

TEST(TreeTangent, IsTheDerivativeOfTheBalance) {
  double worst = 0.0;
  for (unsigned seed = 1; seed < 200; ++seed) {
    Tree<Rigid<>, ByBodies, false> const tree(seed);
    Draws draw{std::mt19937(seed + 11)};
    if (stepped_system(tree.model).velocities() == 0) continue;  // all bodies are welded to the ground
    double const off = tangent_off(tree.model, draw);
    EXPECT_LT(off, 1e-7) << "seed " << seed;
    worst = std::max(worst, off);
  }
  held_within({"closed forms", "tangent of a step of random trees, of its size", By::itself,
               "differences of the balance", "JointCoordinatesBy<ArticulatedBody>"},
              worst, 1e-7, {.scale = 1.0});
}

TEST(TreeTangent, BalanceIsTheResidualOfTheWholeModel) {
  double worst = 0.0;
  for (unsigned seed = 1; seed < 200; ++seed) {
    Tree<Rigid<>, ByBodies, false> const tree(seed);
    Draws draw{std::mt19937(seed + 13)};
    worst = std::max(worst, balance_off(tree.model, draw));
  }
  held_within({"closed forms", "balance of random trees, of its size", By::itself, "Tᵀ(M(T u̇ + b) − f)",
               "JointCoordinatesBy<ArticulatedBody>"},
              worst, 1e-12, {.scale = 1.0});
}

TEST(TreeTangent, HoldsInThePlane) {
  using Pin = Joint<planar::Revolute, ByBodies>;
  using Slide = Joint<planar::Prismatic, ByBodies>;
  double worst = 0.0, worst_balance = 0.0;
  for (unsigned seed = 1; seed < 40; ++seed) {
    Draws draw{std::mt19937(seed)};
    Model<Bodies<planar::Rigid>, Joints<Pin, Slide>> model{Gravity{1.0, -9.81, 0}};
    std::vector<BodyHandle<planar::Rigid>> links;
    for (int i = 0; i < 5; ++i) {
      links.push_back(model.add(planar::Rigid(draw.number(1.0, 2.0), draw.number(0.01, 0.1))));
      Vec2 const at(draw.number(-0.3, 0.3), draw.number(-0.3, 0.3));
      int const carrier = draw.below(i + 2) - 2;
      bool const slides = draw.below(3) == 0;
      auto const join = [&](auto const& a, auto const& b) {
        slides ? void(model.connect(Slide{{.axis = {0.6, 0.8, 0}}, {}}, a, b)) : void(model.connect(Pin{}, a, b));
      };
      if (carrier == -1) join(links.back().at(at), model.ground().at({at[0], at[1], 0}));
      if (carrier >= 0) join(links[std::size_t(carrier)].at(at), links.back().at(at));
    }
    worst = std::max(worst, tangent_off(model, draw));
    worst_balance = std::max(worst_balance, balance_off(model, draw));
  }
  EXPECT_LT(worst, 1e-7);
  EXPECT_LT(worst_balance, 1e-12);
}

/// Mean number of Newton iterations while a chain on pins falls from a horizontal start.
double iterations(int links, NewtonOptions const& newton) {
  using Pin = Joint<Revolute, ByBodies>;
  Model<Bodies<Rigid<>>, Joints<Pin>> model{Gravity{0, -9.81, 0}};
  std::optional<BodyHandle<Rigid<>>> before;
  for (int i = 0; i < links; ++i) {
    auto const link = model.add(Rigid<>({.mass = 1.0,
                                         .inertia = Vec3(1e-4, 1e-3, 1e-3).asDiagonal(),
                                         .placement = Placement::at({0.1 * (i + 0.5), 0, 0})}));
    Pin const pin{Revolute{.axis = {0, 0, 1}}, {}};
    before ? model.connect(pin, before->at(Vec3(0.05, 0, 0)), link.at(Vec3(-0.05, 0, 0)))
           : model.connect(pin, model.ground().at({0, 0, 0}), link.at(Vec3(-0.05, 0, 0)));
    before = link;
  }
  State x = model.reference_state();
  auto run = simulate(model, x, GeneralisedAlpha{.newton = newton}, {.end_time = 0.1, .step = 1e-3});
  return double(run.run().iterations) / double(run.report().steps);
}

// Newton's method with a tangent that omits the terms of tension and of joint rates contracts less for longer chains.
TEST(TreeTangent, NewtonsCountDoesNotGrowWithTheChain) {
  double const few = iterations(16, {.always_refactor = true}), many = iterations(512, {.always_refactor = true});
  EXPECT_NEAR(few, many, 0.3);
  EXPECT_LT(many, 2.5);
  EXPECT_LT(iterations(512, {}), 4.0);  // reused factorisations
}

}  // namespace tree_tangent_test
