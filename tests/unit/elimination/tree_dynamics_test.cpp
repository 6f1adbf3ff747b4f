// Accelerations of trees by the articulated-body algorithm. Random trees of every geometry with joint coordinates are
// compared with multipliers, with and without forces. Further tests: floating roots, derivatives by dual numbers, a
// pendulum in closed form.
#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/planar/joints.hpp>

#include "support/held.hpp"
#include "support/random_tree.hpp"

using namespace polybody;

namespace tree_dynamics_test {

using namespace random_tree;

/// A rigid body with air drag, written as a user would write it.
class RigidInAir : public Rigid<> {
 public:
  using Rigid<>::Rigid;
  template <StateScalar T>
  void force(Index e, std::span<T const> q, std::span<T const> v, Vec<T, 6>& out) const {
    Rigid<>::force<T>(e, q, v, out);
    for (int i = 0; i < 3; ++i) {
      out[i] -= 0.7 * v[std::size_t(i)];
      out[3 + i] -= 0.05 * v[std::size_t(3 + i)];
    }
  }
};

template <class Body, bool sprung>
void expect_trees_as_multipliers(unsigned first, unsigned last) {
  double worst_a = 0.0, worst_lambda = 0.0;
  for (unsigned seed = first; seed < last; ++seed) {
    Tree<Body, ByBodies, sprung> const free(seed);
    Tree<Body, Constraint, sprung> const tied(seed);
    State const x = moving(free, seed);
    System system(tied.model);
    VecX a, lambda;
    ForwardDynamics<>(system).accelerations(system, {x.q, x.v, 0.0}, a, lambda);
    VecX open = VecX::Zero(system.rows());
    system.evaluate(x.q, x.v, 0.0);
    system.violation(open);
    EXPECT_LT(open.size() == 0 ? 0.0 : open.cwiseAbs().maxCoeff(), 1e-12) << "seed " << seed;
    worst_a = std::max(worst_a, (x.a - a).norm() / (1.0 + a.norm()));  // zero for a weld to the ground
    if (lambda.size() > 0) worst_lambda = std::max(worst_lambda, (x.lambda - lambda).norm() / (1.0 + lambda.norm()));
  }
  std::string const of =
      std::string(sprung ? " with springs" : " under weight") + (std::is_same_v<Body, Rigid<>> ? "" : " in air");
  Claim claim{"closed forms", "accelerations of random trees" + of + ", of their size", By::itself, "Constraint",
              "JointCoordinatesBy<ArticulatedBody>"};
  held_within(claim, worst_a, 1e-10, {.scale = 1.0});
  claim.what = "multipliers of random trees" + of + ", of their size";
  held_within(claim, worst_lambda, 1e-9, {.scale = 1.0});
}

TEST(TreeDynamics, RandomTreesAccelerateAsMultipliersSay) {
  expect_trees_as_multipliers<Rigid<>, false>(1, 300);
  expect_trees_as_multipliers<Rigid<>, true>(300, 400);
}

TEST(TreeDynamics, ForcesOfAUsersBodyCount) { expect_trees_as_multipliers<RigidInAir, false>(1, 40); }

TEST(TreeDynamics, PlanarTreesAccelerateAsMultipliersSay) {
  auto const accelerations = [](auto policy, unsigned seed, VecX const* q, VecX const* v) {
    using P = decltype(policy);
    using Pin = Joint<planar::Revolute, P>;
    using Slide = Joint<planar::Prismatic, P>;
    Draws draw{std::mt19937(seed)};
    struct {
      Model<Bodies<planar::Rigid>, Joints<Pin, Slide>> model{Gravity{1.0, -9.81, 0}};
    } tree;
    std::vector<BodyHandle<planar::Rigid>> links;
    for (int i = 0; i < 6; ++i) {
      links.push_back(tree.model.add(planar::Rigid(draw.number(1.0, 2.0), draw.number(0.01, 0.1))));
      Vec2 const at(draw.number(-0.3, 0.3), draw.number(-0.3, 0.3));
      int const carrier = draw.below(i + 2) - 2;
      bool const slides = draw.below(3) == 0;
      auto const join = [&](auto const& a, auto const& b) {
        if (slides)
          tree.model.connect(Slide{{.axis = {0.6, 0.8, 0}}, {}}, a, b);
        else
          tree.model.connect(Pin{}, a, b);
      };
      if (carrier == -1) join(links.back().at(at), tree.model.ground().at({at[0], at[1], 0}));
      if (carrier >= 0) join(links[std::size_t(carrier)].at(at), links.back().at(at));
    }
    State x;
    if (!q) return moving(tree, seed);
    System system(tree.model);
    ForwardDynamics<>(system).accelerations(system, {*q, *v, 0.0}, x.a, x.lambda);
    return x;
  };
  double worst = 0.0;
  for (unsigned seed = 1; seed < 60; ++seed) {
    State const x = accelerations(ByBodies{}, seed, nullptr, nullptr);
    State const tied = accelerations(Constraint{}, seed, &x.q, &x.v);
    worst = std::max(worst, (x.a - tied.a).norm() / tied.a.norm());
  }
  held_within({"closed forms", "accelerations of random planar trees, of their size", By::itself, "Constraint",
               "JointCoordinatesBy<ArticulatedBody>"},
              worst, 1e-10, {.scale = 1.0});
}

// The derivative along a direction is the limit of central differences, by Richardson extrapolation.
TEST(TreeDynamics, DualNumbersGiveTheDerivative) {
  for (unsigned seed = 1; seed < 30; ++seed) {
    Tree<Rigid<>, ByBodies, false> const tree(seed);
    Reduction const reduction(tree.model);
    System system = stepped_system(tree.model);
    State x = reduce(system, tree.model.reference_state());
    Draws draw{std::mt19937(seed)};
    VecX q_rate = x.q, v_rate = x.v;
    for (double& d : x.v) d = draw.number(-2.0, 2.0);
    for (double& d : q_rate) d = draw.number(-1.0, 1.0);
    for (double& d : v_rate) d = draw.number(-1.0, 1.0);
    auto const at = [&](double s) {
      TreeDynamicsOf<> dynamics(reduction.tree().bodies);
      VecX a = VecX::Zero(x.v.size());
      EXPECT_EQ(dynamics.accelerations_under_gravity(x.q + s * q_rate, x.v + s * v_rate, Vec3(0, 0, -9.81), a), -1);
      return a;
    };
    using D = Dual<1>;
    VecXOf<D> q(x.q.size()), v(x.v.size()), a(x.v.size());
    for (Index i = 0; i < q.size(); ++i) {
      q[i] = D(x.q[i]);
      q[i].d[0] = q_rate[i];
    }
    for (Index i = 0; i < v.size(); ++i) {
      v[i] = D(x.v[i]);
      v[i].d[0] = v_rate[i];
    }
    TreeDynamicsOf<D> dynamics(reduction.tree().bodies);
    ASSERT_EQ(dynamics.accelerations_under_gravity(q, v, Vec3(0, 0, -9.81), a), -1);
    auto const central = [&](double s) { return VecX((at(s) - at(-s)) / (2.0 * s)); };
    VecX const slope = (4.0 * central(5e-4) - central(1e-3)) / 3.0;
    for (Index i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i].d[0], slope[i], 1e-7 * (1.0 + slope.norm())) << seed;
  }
}

// ϑ¨ = −m g c cos ϑ/(J + m c²) about a pin at the distance c from the centre of mass.
TEST(TreeDynamics, PendulumStartsAsItsClosedFormSays) {
  using Pin = Joint<Revolute, ByBodies>;
  Model<Bodies<Rigid<>>, Joints<Pin>> model{Gravity{0, 0, -9.81}};
  auto const rod = model.add(Rigid<>({.mass = 3.0, .inertia = Vec3(0.1, 0.25, 0.3).asDiagonal()}));
  model.connect(Pin{{.axis = Vec3::UnitY()}, {}}, model.ground().at({-0.4, 0, 0}), rod.at(Vec3(-0.4, 0, 0)));
  System system = stepped_system(model);
  State x = reduce(system, model.reference_state());
  for (double const angle : {0.0, 0.7, 2.0}) {
    x.q[0] = angle;
    x.v[0] = 3.0;  // the angular velocity has no influence
    ForwardDynamics<>(system).accelerations(system, {x.q, x.v, 0.0}, x.a, x.lambda);
    held({"closed forms", "angular acceleration of a pendulum [rad/s²]", By::closed_form,
          "m g c cos ϑ/(J + m c²), positive downwards", "JointCoordinatesBy<ArticulatedBody>"},
         x.a[0], 3.0 * 9.81 * 0.4 * std::cos(angle) / (0.25 + 3.0 * 0.16), 1e-12, {equals("angle", angle)});
  }
}

// A rod without inertia about the pin through its centre of mass: its angular acceleration is undetermined.
TEST(TreeDynamics, FreedomWithoutInertiaIsNamed) {
  using Pin = Joint<Revolute, ByBodies>;
  Model<Bodies<Rigid<>>, Joints<Pin>> model{Gravity{0, 0, -9.81}};
  auto const point = model.add(Rigid<>({.mass = 3.0}), "bob");
  model.connect(Pin{{.axis = Vec3::UnitY()}, {}}, model.ground().at({0, 0, 0}), point.at(Vec3(0, 0, 0)), "pin");
  State x = model.reference_state();
  try {
    simulate(model, x, RungeKutta4<>{}, {.end_time = 1.0, .step = 0.01}).run();
    ADD_FAILURE() << "no error";
  } catch (SingularMatrix const& e) {
    EXPECT_NE(std::string(e.what()).find("bob"), std::string::npos) << e.what();
  }
}

}  // namespace tree_dynamics_test
