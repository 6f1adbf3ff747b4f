// Cost before the first step grows linearly with the model. The tests count entries and operations. bench/start.cpp
// measures times.
#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/bodies/rigid/rigid_euler_parameters.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/redundancy.hpp>
#include <polybody/run/simulate.hpp>

namespace polybody {
namespace large_models_test {

using Pin = Joint<planar::Revolute, Constraint>;
using Chain = Model<Bodies<planar::Rigid>, Joints<Pin>>;

/// \param copies number of equal pins at each joint
Chain chain(int bodies, int copies = 1) {
  Chain model{Gravity{0, -9.81, 0}};
  BodyHandle<planar::Rigid> before;
  for (int i = 0; i < bodies; ++i) {
    auto const bar = model.add(planar::Rigid(1.0, 1.0 / 12.0, Placement::planar(0.5 + i, 0.0)));
    for (int copy = 0; copy < copies; ++copy)
      if (i == 0)
        model.connect(Pin{}, model.ground().at({0, 0, 0}), bar.at(Vec2(-0.5, 0)));
      else
        model.connect(Pin{}, before.at(Vec2(0.5, 0)), bar.at(Vec2(-0.5, 0)));
    before = bar;
  }
  return model;
}
/// Square grid of bars with irregular nodes, hung from its upper line of nodes, with every pin doubled. Bars and loops
/// are counted by m².
Chain doubled_grid(int m) {
  Chain model{Gravity{0, -9.81, 0}};
  struct End {
    BodyHandle<planar::Rigid> bar;
    double along;
  };
  std::vector<std::vector<End>> ends(std::size_t((m + 1) * (m + 1)));
  auto const node = [&](int i, int j) {
    return Vec2(i + 0.2 * std::sin(1.0 + 3.7 * i + 1.3 * j), -j + 0.2 * std::cos(2.1 * i * j + 0.7 * j + i));
  };
  auto const bar = [&](int i, int j, int k, int l) {
    Vec2 const a = node(i, j), b = node(k, l), along = b - a, middle = 0.5 * (a + b);
    auto const added = model.add(
        planar::Rigid(1.0, 1.0 / 12.0, Placement::planar(middle[0], middle[1], std::atan2(along[1], along[0]))));
    ends[std::size_t(i * (m + 1) + j)].push_back({added, -0.5 * along.norm()});
    ends[std::size_t(k * (m + 1) + l)].push_back({added, 0.5 * along.norm()});
  };
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j <= m; ++j) {
      if (i < m && j > 0) bar(i, j, i + 1, j);
      if (j < m) bar(i, j, i, j + 1);
    }
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j <= m; ++j)
      for (int copy = 0; copy < 2; ++copy) {
        auto const& at = ends[std::size_t(i * (m + 1) + j)];
        auto const end = [&](std::size_t k) { return at[k].bar.at(Vec2(at[k].along, 0)); };
        if (j == 0) model.connect(Pin{}, model.ground().at(Vec3(node(i, 0)[0], node(i, 0)[1], 0)), end(0));
        for (std::size_t k = 1; k < at.size(); ++k) model.connect(Pin{}, end(k - 1), end(k));
      }
  return model;
}
/// One body on `pins` pins at one point.
Chain pinned(int pins) {
  Chain model{Gravity{0, -9.81, 0}};
  auto const hub = model.add(planar::Rigid(1.0, 1.0, Placement::planar(0.5, 0.0)), "hub");
  for (int i = 0; i < pins; ++i) model.connect(Pin{}, model.ground().at({0, 0, 0}), hub.at(Vec2(-0.5, 0)));
  return model;
}

/// Factor of the constraint Jacobian of a model in its reference state, with all equations or without those that are
/// private to a body (`PrivateRows`).
template <class M>
detail::ConstraintFactor<> factor_of(M const& model, bool all) {
  System system(model, with<Capabilities::motion>);
  State const x = model.reference_state();
  system.evaluate(x.q, x.v, x.t);
  std::vector<Eigen::Triplet<double>> entries;
  detail::ConstraintSink<> sink{system.velocities(), entries};
  system.masses(sink);
  return {system.velocities(), system.rows(), entries, all ? Sequence<BodyLayout>() : system.layout().bodies};
}
VecX dense(IndexMap<double> const& c, Index rows) {
  VecX out = VecX::Zero(rows);
  for (auto const& [i, value] : c) out[i] = value;
  return out;
}
/// Both factors find the same rank, equations and relations. The second one factorises `factored` equations.
template <class M>
void expect_alike(M const& model, Index factored) {
  auto const all = factor_of(model, true), without = factor_of(model, false);
  EXPECT_EQ(all.factored(), model.rows());
  EXPECT_EQ(without.factored(), factored);
  EXPECT_EQ(without.rank(), all.rank());
  ASSERT_EQ(without.repeated(), all.repeated());
  for (Index k = 0; k < all.repeated(); ++k) {
    EXPECT_EQ(without.row(k), all.row(k));
    VecX const expected = dense(all.relation(k), model.rows()),
               apart = dense(without.relation(k), model.rows()) - expected;
    EXPECT_LE(largest_size(apart), 1e-9 * largest_size(expected));
  }
}

// Only loops require a rank computation. The number of entries of a factor with all equations of a chain grows as the
// square.
TEST(LargeModels, FactorNoRowsOfChains) {
  expect_alike(chain(50), 0);
  auto const large = factor_of(chain(3000), false);
  EXPECT_EQ(large.factored(), 0);
  EXPECT_EQ(large.rank(), 6000);
}
TEST(LargeModels, FactorNoRowsOfRepeatedPins) { expect_alike(pinned(20), 0); }

// Four-bar linkage with a chain on its coupler. In a second model one pin of the linkage is doubled: its equations are
// compared with those of the first pin alone.
TEST(LargeModels, FactorRowsOfLoopsOnly) {
  Chain model;
  auto const bar = [&](double x, double y, double angle) {
    return model.add(planar::Rigid(1.0, 1.0 / 12.0, Placement::planar(x, y, angle)));
  };
  double const up = 0.5 * std::numbers::pi;
  auto const left = bar(0, 0.5, up), right = bar(1, 0.5, up), top = bar(0.5, 1, 0), first = bar(1.5, 1, 0),
             second = bar(2.5, 1, 0);
  model.connect(Pin{}, model.ground().at({0, 0, 0}), left.at(Vec2(-0.5, 0)));
  model.connect(Pin{}, top.at(Vec2(0.5, 0)), first.at(Vec2(-0.5, 0)));
  model.connect(Pin{}, first.at(Vec2(0.5, 0)), second.at(Vec2(-0.5, 0)));
  model.connect(Pin{}, left.at(Vec2(0.5, 0)), top.at(Vec2(-0.5, 0)));
  model.connect(Pin{}, model.ground().at({1, 0, 0}), right.at(Vec2(-0.5, 0)));
  model.connect(Pin{}, right.at(Vec2(0.5, 0)), top.at(Vec2(0.5, 0)));
  expect_alike(model, 8);
  model.connect(Pin{}, model.ground().at({1, 0, 0}), right.at(Vec2(-0.5, 0)));
  expect_alike(model, 8);
}

// Spatial bodies with their own constraint equation.
TEST(LargeModels, FactorNoRowsOfTreesInSpace) {
  using Hinge = Joint<Revolute, Constraint>;
  Model<Bodies<Rigid<>, Rigid<EulerParameters>>, Joints<Hinge>> model;
  Hinge const hinge{Revolute{.axis = {0, 1, 0}}};
  auto const hub = model.add(Rigid<>(1.0, Mat3::Identity()), "hub");
  model.connect(hinge, model.ground().at({0, 0, 0}), hub.at({0, 0, 0}));
  auto before = model.add(Rigid<EulerParameters>(1.0, Mat3::Identity(), Placement::at({1, 0, 0})));
  model.connect(hinge, hub.at({0.5, 0, 0}), before.at({-0.5, 0, 0}));
  for (int i = 0; i < 5; ++i) {
    auto const next = model.add(Rigid<EulerParameters>(1.0, Mat3::Identity(), Placement::at({2.0 + i, 0, 0})));
    model.connect(hinge, before.at({0.5, 0, 0}), next.at({-0.5, 0, 0}));
    before = next;
  }
  expect_alike(model, 0);
  model.connect(hinge, model.ground().at({6.5, 0, 0}), before.at({0.5, 0, 0}));
  expect_alike(model, model.rows());
}

/// Counts the solutions, and the entries of null vectors.
struct Counting : DefaultSolver {
  Sequence<IndexMap<double>> null_vectors(VecX const& sizes) const {
    auto found = DefaultSolver::null_vectors(sizes);
    for (auto const& n : found) entries += n.size();
    vectors += found.size();
    return found;
  }
  void solve(VecX const& b, VecX& x) {
    ++solutions;
    DefaultSolver::solve(b, x);
  }
  inline static int solutions = 0;
  inline static std::size_t vectors = 0, entries = 0;
};
static_assert(LinearSolver<Counting>);

/// Number of solutions in the check of initial conditions.
int solutions_of_start(int pins) {
  Chain const model = pinned(pins);
  System system(model, with<Capabilities::motion>);
  State const x = model.reference_state();
  ForwardDynamics<Counting> forward(system);
  Counting::solutions = 0;
  require_consistent_redundancy(system, forward, x);
  EXPECT_EQ(warn_of_ambiguous_branch(system, forward, x), "");
  EXPECT_EQ(forward.redundant_rows().size(), std::size_t(2 * (pins - 1)));
  return Counting::solutions;
}
// The number of consistent redundant constraint equations has no influence. Three checks need one solution each. The
// velocities that test for a singular configuration need one more.
TEST(LargeModels, AreAskedForContradictionsByFewSolutions) {
  EXPECT_EQ(solutions_of_start(5), 4);
  EXPECT_EQ(solutions_of_start(60), 4);
}

/// Solutions, null vectors and their entries in the choice of the equations that a run drops, for a model with every
/// pin doubled.
struct ChoiceCost {
  int solutions;
  std::size_t vectors, entries;
  explicit ChoiceCost(Chain const& model) {
    System system(model, with<Capabilities::motion>);
    State x = model.reference_state();
    ForwardDynamics<Counting> forward(system);
    forward.accelerations(system, {x.q, x.v, x.t}, x.a, x.lambda);
    Counting::solutions = 0;
    Counting::vectors = Counting::entries = 0;
    EXPECT_TRUE(leave_out_redundant(system, forward, x));
    EXPECT_EQ(Index(forward.left_out().size()), system.rows() / 2);
    solutions = Counting::solutions;
    vectors = Counting::vectors;
    entries = Counting::entries;
  }
};
// The choice needs one solution for each test of null vectors, and two entries of each null vector. The entries of
// complete vectors grow as the square of the model.
TEST(LargeModels, ChooseDroppedEquationsByFewEntries) {
  for (Chain const& model : {chain(20, 2), chain(300, 2), doubled_grid(3), doubled_grid(8)}) {
    ChoiceCost const cost(model);
    EXPECT_EQ(cost.solutions, 1);
    EXPECT_EQ(Index(cost.vectors), model.rows());  // twice for each dropped equation
    EXPECT_EQ(cost.entries, 2 * cost.vectors);
  }
}

// All pins after the first one are one node of the factorisation. Separate nodes have n³/6 updates.
TEST(LargeModels, EliminateRepeatedPinsAtOnce) {
  auto const nodes = [](int pins) {
    Chain const model = pinned(pins);
    System system(model, with<Capabilities::motion>);
    PatternSink pattern;
    system.masses(pattern);
    BlockSolver solver;
    solver.analyse(system.size(), pattern.blocks);
    return solver.nodes();
  };
  EXPECT_EQ(nodes(200), nodes(20));
  EXPECT_LE(nodes(200), 4);
}
// A bar on 40 pins moves like the bar on one of them, and 78 of 80 equations are dropped.
TEST(LargeModels, MoveOnRepeatedPinsAsOnOne) {
  auto const end = [](int pins) {
    Chain const model = pinned(pins);
    State x = model.reference_state();
    RunReport const report = simulate(model, x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 1e-2}).run();
    EXPECT_EQ(report.redundant.size(), pins > 1 ? std::size_t(pins - 1) : 0u);
    return x.q;
  };
  EXPECT_LT(largest_size(VecX(end(40) - end(1))), 1e-10);
}

// Automatic names of two pin types with a common numbering. Each name has the next free number.
TEST(LargeModels, NumberPartsOfTwoTypesWithOneName) {
  detail::Names names;
  std::size_t const count = 20000;
  auto const next = [&](std::size_t before) {
    std::string name = names.given_or_next("", "pin", before);
    names.require_free(name, "joint");
    names.take(name);
    return name;
  };
  names.take("pin 20003");
  for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(next(i), "pin " + std::to_string(i + 1));
  EXPECT_EQ(next(0), "pin 20001");
  EXPECT_EQ(next(1), "pin 20002");
  EXPECT_EQ(next(2), "pin 20004");
  for (std::size_t i = 3; i < count; ++i) ASSERT_EQ(next(i), "pin " + std::to_string(count + i + 2));
  EXPECT_EQ(next(5), "pin " + std::to_string(2 * count + 2));
  EXPECT_EQ(names.given_or_next("mine", "pin", 0), "mine");
  EXPECT_EQ(names.given_or_next("", "spring", 4), "spring 5");
}

}  // namespace large_models_test
}  // namespace polybody
