// Coordinate partitioning by sparse factors: the partition itself, and mechanisms against the dense elimination.
#include <gtest/gtest.h>

#include <polybody/integrators/coordinate_partitioning.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"
#include "support/linkages.hpp"

using namespace polybody;

namespace sparse_partition_test {

constexpr CoordinatePartitioning sparse{.dense_up_to = 0};

void write(SparsePartitionOf<>& rows, MatX const& g) {
  rows.begin();
  rows.add(g.cols(), 0, g);
}

// The third row is the sum of the others, so the rank is 2. Then the row changes and the rank is 3.
TEST(SparsePartition, FindsTheRankAndSolves) {
  MatX g(3, 4);
  g << 1, 2, 0, 4, 3, -1, 5, 0, 4, 1, 5, 4;
  VecX const r = Vec3(1, 2, 3);
  SparsePartitionOf<> rows(3, 4);
  write(rows, g);
  rows.renew(10.0);
  EXPECT_EQ(rows.rank(), 2);
  VecX b = VecX::Zero(4);
  rows.solve(r, b);
  EXPECT_LT((g * b - r).norm(), 1e-13);
  for (Index j = 0; j < 4; ++j) EXPECT_EQ(rows.is_dependent(j), b[j] != 0.0);

  g(2, 0) += 1e-3;
  write(rows, g);
  rows.forget();
  rows.renew(1e9);
  EXPECT_EQ(rows.rank(), 3);
  rows.solve(r, b);
  EXPECT_LT((g * b - r).norm(), 1e-9);
}

// Columns that differ by little more than the rank tolerance, and one nearly orthogonal column, last or first. This
// column must be among the dependent ones: without it G_d is almost singular.
TEST(SparsePartition, TakesNoColumnThatHardlyAddsAnything) {
  for (Index const across : {0, 5, 11}) {
    MatX g(2, 12);
    for (Index j = 0; j < 12; ++j) g.col(j) << 1.0, 1.0 + 3e-9 * double(j);
    g.col(across) << 1.0, -1.0;
    VecX const r = Vec2(1, 2);
    SparsePartitionOf<> rows(2, 12);
    write(rows, g);
    rows.renew(1e12);
    ASSERT_EQ(rows.rank(), 2);
    EXPECT_TRUE(rows.is_dependent(across));
    VecX b = VecX::Zero(12);
    rows.solve(r, b);
    EXPECT_LT((g * b - r).norm(), 1e-14);
  }
}

// One row (1, s): the first column remains dependent until its ratio to the second exceeds the limit.
TEST(SparsePartition, ChangesPlacesWhereADependentSpeedMovesTooMuch) {
  SparsePartitionOf<> rows(1, 2);
  MatX g(1, 2);
  g << 1, 0.5;
  write(rows, g);
  rows.renew(10.0);
  long const first = rows.choices;
  Index const dependent = rows.is_dependent(0) ? 0 : 1;
  g(0, dependent) = 1.0;
  g(0, 1 - dependent) = 9.0;
  write(rows, g);
  rows.renew(10.0);
  EXPECT_TRUE(rows.is_dependent(dependent));
  EXPECT_EQ(rows.choices, first);
  g(0, 1 - dependent) = 11.0;
  write(rows, g);
  rows.renew(10.0);
  EXPECT_TRUE(rows.is_dependent(1 - dependent));
  EXPECT_EQ(rows.choices, first + 1);
}

// Random rows of low rank: after the exchanges no dependent column moves by more than the limit per unit of another
// column.
TEST(SparsePartition, ExchangesBoundTheRatios) {
  std::srand(7);
  for (int trial = 0; trial < 50; ++trial) {
    Index const m = 3 + trial % 8, n = m + 2 + trial % 5, k = m - trial % 3;
    MatX const g = MatX::Random(m, k) * MatX::Random(k, n);
    SparsePartitionOf<> rows(m, n);
    write(rows, g);
    rows.renew(2.0);
    ASSERT_EQ(rows.rank(), k);
    VecX b = VecX::Zero(n);
    for (Index j = 0; j < n; ++j) {
      if (rows.is_dependent(j)) continue;
      rows.solve(g.col(j), b);
      EXPECT_LE(b.cwiseAbs().maxCoeff(), 2.0 + 1e-9);
      EXPECT_LT((g * b - g.col(j)).norm(), 1e-9 * g.norm());
    }
  }
}

// Without constraint equations, and with constraint equations of zeros, no coordinate is dependent.
TEST(SparsePartition, TakesNoRowsAndRowsOfZeros) {
  for (Index const m : {0, 2}) {
    SparsePartitionOf<> rows(m, 3);
    EXPECT_FALSE(rows.is_dependent(0));
    rows.begin();
    if (m > 0) rows.add(3, 0, MatX(MatX::Zero(m, 3)));
    rows.renew(10.0);
    EXPECT_EQ(rows.rank(), 0);
    VecX b = VecX::Ones(3);
    rows.solve(VecX::Zero(m), b);
    EXPECT_EQ(b, VecX::Zero(3));
  }
  FourBars<InSpace<Penalty>> bars(1, {.stiffness = 1e6, .damping = 1e2});
  System system(bars.model);
  EXPECT_EQ(independent_velocities(system, bars.x, sparse).size(), 18u);
}

/// Largest constraint violations of four-bar linkages over a run.
template <class M, class I>
Violation worst_of(M const& model, State& x, I const& integrator, RunOptions const& options) {
  Violation worst;
  System system(model);
  for (State const& now : simulate(model, x, integrator, options)) {
    Violation const open = largest_violation(system, now);
    worst.position = std::max(worst.position, open.position);
    worst.velocity = std::max(worst.velocity, open.velocity);
    worst.acceleration = std::max(worst.acceleration, open.acceleration);
  }
  return worst;
}

TEST(SparsePartitioning, MovesLinkagesAsTheDenseOneDoes) {
  for (int const bars : {1, 3, 40}) {
    FourBars<InSpace<Constraint>> kept(bars), dense(bars);
    RunOptions const options{.end_time = 0.3, .step = 2e-3};
    Violation const open =
        worst_of(kept.model, kept.x, RungeKutta4<CoordinatePartitioning>{.stabilisation = sparse}, options);
    EXPECT_LT(open.position, 1e-11) << bars;
    EXPECT_LT(open.velocity, 1e-10) << bars;
    EXPECT_LT(open.acceleration, 1e-8) << bars;
    if (bars > 3) continue;  // the dense elimination would need minutes
    simulate(dense.model, dense.x, RungeKutta4<CoordinatePartitioning>{.stabilisation = {.dense_up_to = 1000}}, options)
        .run();
    EXPECT_LT((kept.x.q - dense.x.q).norm(), 1e-9) << bars;
  }
}

// The windows have one degree of freedom. Both methods name one independent velocity, and the report counts the
// choices.
TEST(SparsePartitioning, NamesTheIndependentSpeedsAndCountsChoices) {
  FourBars<InSpace<Constraint>> bars(2);
  System system(bars.model);
  for (int const dense_up_to : {0, 1000}) {
    std::vector<std::string> const names = independent_velocities(system, bars.x, {.dense_up_to = dense_up_to});
    ASSERT_EQ(names.size(), 1u);
    EXPECT_NE(names.front().find(", velocity "), std::string::npos) << names.front();
  }
  State x = bars.x;
  auto run = simulate(bars.model, x, RungeKutta4<CoordinatePartitioning>{.stabilisation = sparse},
                      {.end_time = 0.5, .step = 2e-3});
  EXPECT_GE(run.run().last.choices, 1);
}

// A rod rotates through a full circle, with its centre 2 m from the pin. x and y may move at most 1.5 times as fast
// as the rotation, in metres and radians. Therefore x and y alternate as the independent coordinate.
TEST(SparsePartitioning, ChangesItsChoiceAsARodTurnsOver) {
  using Pin = Joint<planar::Revolute, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Pin>> model{Gravity{0, -9.81, 0}};
  auto const rod = model.add(planar::Rigid(1.0, 1.0 / 3.0, Placement::planar(2.0, 0.0)), "rod");
  model.connect(Pin{}, model.ground().at({0, 0, 0}), rod.at(Vec2(-2, 0)), "pin");
  State x = model.reference_state();
  model.set_velocity(x, rod, Vec3::Zero(), Vec3(0, 0, 6));
  double const start = energy(model, x).total();
  auto run =
      simulate(model, x, RungeKutta4<CoordinatePartitioning>{.stabilisation = {.largest_ratio = 1.5, .dense_up_to = 0}},
               {.end_time = 10.0, .step = 1e-3});
  EXPECT_GE(run.run().last.choices, 8);
  EXPECT_NEAR(energy(model, x).total(), start, 1e-6);
  System system(model);
  EXPECT_LT(largest_violation(system, x).position, 1e-11);
}

TEST(SparsePartitioning, RefusesWhatCannotBeMeant) {
  FourBars<InSpace<Constraint>> bars(1);
  State x = bars.x;
  EXPECT_THROW(simulate(bars.model, x, RungeKutta4<CoordinatePartitioning>{.stabilisation = {.dense_up_to = -1}},
                        {.end_time = 0.1, .step = 1e-3}),
               InvalidInput);
}

}  // namespace sparse_partition_test
