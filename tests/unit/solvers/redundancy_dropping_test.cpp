// Redundant constraints under solvers that do not drop them by themselves.

#include <polybody/solvers/redundancy_dropping.hpp>

#include <gtest/gtest.h>

#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/solvers/eigen_ldlt.hpp>
#include <polybody/testing/linear_solver_laws.hpp>

#include "support/linkages.hpp"

namespace polybody {
bool const row_dropping_obeys[] = {
    laws::obeys<RedundancyDropping<DenseLu>, laws::LinearSolvers>("RedundancyDropping<DenseLu>"),
    laws::obeys<RedundancyDropping<EigenSparseLu>, laws::LinearSolvers>("RedundancyDropping<EigenSparseLu>")};

namespace row_dropping_test {

static_assert(std::same_as<StepSolver<BlockLu>, BlockLu>);
static_assert(std::same_as<StepSolver<DenseLu>, RedundancyDropping<DenseLu>>);

/// Two bodies with two velocities and three constraint equations. The last differs by `lean` from the sum of the
/// others.
template <class Sink>
void write(Sink& sink, double lean) {
  using Row = Mat<double, 1, 2>;
  Mat<double, 2, 2> m;
  m << 2.0, 0.5, 0.5, 3.0;
  sink.add(0, 0, m);
  sink.add(2, 2, m);
  Row const g[3][2] = {{{1.0, 0.0}, {-1.0, 0.0}}, {{0.0, 1.0}, {0.0, 2.0}}, {{1.0, 1.0}, {-1.0 + lean, 2.0}}};
  for (Index row = 0; row < 3; ++row)
    for (Index body = 0; body < 2; ++body) {
      Row const& of = g[row][body];
      sink.add(4 + row, 2 * body, of);
      sink.add(2 * body, 4 + row, of.transpose());
    }
}
template <class Solver>
Index factor(Solver& solver, double lean) {
  solver.begin();
  write(solver, lean);
  return solver.factor();
}

template <class Solver>
class EachSolver : public ::testing::Test {};
using Solvers = ::testing::Types<DenseLu, EigenSparseLu, EigenLdlt>;
TYPED_TEST_SUITE(EachSolver, Solvers);

// A dropped constraint equation is satisfied if the others are, and its multiplier is zero. A constraint equation
// that becomes independent is included again.
TYPED_TEST(EachSolver, LeavesOutARowOnlyWhileItRepeatsOthers) {
  PatternSink pattern;
  write(pattern, 0.0);
  RedundancyDropping<TypeParam> solver;
  solver.analyse(7, pattern.blocks);
  for (double const lean : {1.0, 0.0, 1e-7, 0.5, 0.0}) {
    ASSERT_EQ(factor(solver, lean), -1) << lean;
    laws::Plain plain{MatX::Zero(7, 7)};
    write(plain, lean);
    VecX b(7), x = VecX::Zero(7);
    b << 1.0, 2.0, 3.0, 4.0, 0.5, 0.25, 0.75;
    solver.solve(b, x);
    EXPECT_EQ(solver.dropped().size(), lean < 1e-3 ? 1u : 0u) << lean;
    for (Index const i : solver.dropped()) EXPECT_EQ(x[i], 0.0);
    EXPECT_LT((plain.a * x - b).norm(), lean == 1e-7 ? 1e-6 : 1e-12) << lean;
    VecX same = b;
    solver.solve(same, same);
    EXPECT_EQ(same, x);
  }
}

/// Bars with inertia about their own axis; `InSpace` has thin rods, whose M has no pivot of its own.
struct SquareBars : InSpace<Constraint> {
  static Body body(Link const& l, Placement const& place) {
    return {l.mass, Vec3(0.01, l.inertia, l.inertia).asDiagonal().toDenseMatrix(), place};
  }
};

template <class Solver, class Where>
void expect_moves_as_in_the_plane() {
  FourBars<InPlane<Constraint>> plane(2);
  FourBars<Where> space(2);
  GeneralisedAlpha const integrator{.tolerance = 1e-10};
  simulate(plane.model, plane.x, integrator, {.end_time = 0.6, .step = 2e-3}).run();
  RunReport const report = simulate<Solver>(space.model, space.x, integrator, {.end_time = 0.6, .step = 2e-3}).run();
  EXPECT_LT((space.corner() - plane.corner()).norm(), 1e-9);
  EXPECT_EQ(report.redundant.size(), 2u);
  EXPECT_TRUE(space.x.lambda.allFinite());
}
// Four parallel pins in space have three redundant constraint equations per loop.
TYPED_TEST(EachSolver, MovesAPlanarFourBarOfSpatialPins) { expect_moves_as_in_the_plane<TypeParam, SquareBars>(); }
TYPED_TEST(EachSolver, MovesOneOfThinRods) { expect_moves_as_in_the_plane<TypeParam, InSpace<Constraint>>(); }

}  // namespace row_dropping_test
}  // namespace polybody
