// Independence of the motion from the linear solver, which is a policy. Each solver is compared with dense LU and
// with itself.

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/solvers/auto_lu.hpp>
#include <polybody/solvers/block_factor.hpp>
#include <polybody/solvers/eigen_ldlt.hpp>
#include <polybody/solvers/iterative_refinement.hpp>

#include "support/chain.hpp"

using namespace polybody;

namespace solver_policies_test {

/// Planar model: a rigid link on an ideal pin, a cable on it, and another link on the cable by a stiff pin. Its
/// tangents are symmetric.
struct Mixed {
  using Cable = planar::AncfCable<planar::EngineeringStrain>;
  using Pin = Joint<planar::Revolute, Constraint>;
  using StiffPin = Joint<planar::Revolute, Penalty>;
  Model<Bodies<planar::Rigid, Cable>, Joints<Pin, StiffPin>> model{Gravity{0, -9.81, 0}};

  Mixed() {
    BarConstants const soft{.EA = 1e5, .EI = 2.0, .mass_per_length = 1.0};
    auto const first = model.add(planar::Rigid(1.0, 0.1, Placement::planar(0.5, 0.0)), "first");
    auto const cable = model.add(
        Cable::from(Bar{.length = 1.0, .constants = soft, .placement = Placement::planar(1.0, 0.0)}, 8), "cable");
    auto const last = model.add(planar::Rigid(2.0, 0.2, Placement::planar(2.5, 0.0)), "last");
    model.connect(Pin{}, model.ground().at({0, 0, 0}), first.at(Vec2(-0.5, 0.0)), "pin");
    model.connect(Pin{}, first.at(Vec2(0.5, 0.0)), cable.at(0.0), "middle");
    model.connect(StiffPin{{}, Penalty{.stiffness = 1e5, .damping = 1e2}}, cable.at(1.0), last.at(Vec2(-0.5, 0.0)),
                  "end");
  }
};

template <class Solver, class M>
State moved(M const& model) {
  State x = model.reference_state();
  simulate<Solver>(model, x, GeneralisedAlpha{.tolerance = 1e-12}, {.end_time = 0.1, .step = 2e-3}).run();
  return x;
}

/// Relative difference of two motions, including λ, which is more sensitive. Positions rounded to 1e-16 give
/// accelerations and forces rounded to 1e-16/(βh²), here 1e-10. Newton's method stops at a hundred times this value.
double apart(State const& x, State const& y) {
  return std::max({(x.q - y.q).norm() / y.q.norm(), (x.v - y.v).norm() / y.v.norm(),
                   (x.lambda - y.lambda).norm() / y.lambda.norm()});
}

template <class Solver>
struct SolverPolicies : testing::Test {};
using AnySolver =
    testing::Types<EigenSparseLu, EigenLdlt, AutoLu, BlockLdlt, BlockLu, BlockSolver, IterativeRefinement<BlockSolver>>;
TYPED_TEST_SUITE(SolverPolicies, AnySolver);

/// Solvers for general tangents.
template <class Solver>
struct GeneralSolverPolicies : testing::Test {};
using GeneralSolver = testing::Types<EigenSparseLu, BlockLu, BlockSolver>;
TYPED_TEST_SUITE(GeneralSolverPolicies, GeneralSolver);

TYPED_TEST(SolverPolicies, MoveAMixedModelAlikeAndGiveTheSameBitsTwice) {
  Mixed const mixed;
  State const x = moved<TypeParam>(mixed.model), again = moved<TypeParam>(mixed.model);
  EXPECT_LT(apart(x, moved<DenseLu>(mixed.model)), 1e-8);
  EXPECT_TRUE(x.q == again.q && x.v == again.v && x.a == again.a && x.lambda == again.lambda);
}

TYPED_TEST(GeneralSolverPolicies, MoveAChainOfBallsAlike) {
  Chain<OnBallJoints<Constraint>> const chain(8, bar_link(0.2));
  EXPECT_LT(apart(moved<TypeParam>(chain.model), moved<DenseLu>(chain.model)), 1e-8);
}

}  // namespace solver_policies_test
