// Pairs of bodies, policies and integrators: derivatives of runs against finite differences of runs.
#include <polybody/gradients/sensitivities.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/policies/penalty.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/joints/standard_joints.hpp>

#include "support/differences_of_runs.hpp"
#include "support/two_links.hpp"

using namespace polybody;

namespace sensitivities_pairs_test {

template <class Make, class I>
void expect_derivatives_of_runs(Make const& make, std::vector<Parameter> const& parameters, I const& integrator) {
  SensitivityResult const s = sensitivities(make, parameters, integrator);
  MatX const expected = by_differences(make, parameters, integrator);
  EXPECT_LT(s.left, 1e-9);
  for (Index j = 0; j < expected.cols(); ++j)
    EXPECT_LT((s.derivatives.back().col(j) - expected.col(j)).norm(),
              1e-7 * (expected.col(j).norm() + 1e-4 / parameters[std::size_t(j)].size()))
        << parameters[std::size_t(j)].name << ": " << s.derivatives.back().col(j).transpose() << " for "
        << expected.col(j).transpose();
}
TEST(SensitivitiesByPairs, RigidOnConstraintByGeneralizedAlpha) {
  expect_derivatives_of_runs(two_links<Rigid<>, Constraint>, parameters_of_two_links, GeneralisedAlpha{});
}
TEST(SensitivitiesByPairs, RigidOnBushingByTrapezoidal) {
  expect_derivatives_of_runs(two_links<Rigid<>, Bushing>, parameters_of_two_links, Trapezoidal{});
}
TEST(SensitivitiesByPairs, CableOnPenaltyByHht) {
  expect_derivatives_of_runs(two_links<AncfCable<>, Penalty>, parameters_of_two_links, HhtAlpha{});
}
TEST(SensitivitiesByPairs, LrvfOnBushingByNewmark) {
  expect_derivatives_of_runs(two_links<Lrvf<>, Bushing>, parameters_of_two_links, Newmark{});
}
TEST(SensitivitiesByPairs, FloatingFrameOnConstraintByHht) {
  expect_derivatives_of_runs(two_links<Ffr, Constraint>, parameters_of_two_links, HhtAlpha{});
}
TEST(SensitivitiesByPairs, BeamOnConstraintByGeneralizedAlpha) {
  expect_derivatives_of_runs(two_links<AncfBeam<ElasticLine>, Constraint>, parameters_of_two_links,
                             GeneralisedAlpha{.rho_inf = 0.5});
}

}  // namespace sensitivities_pairs_test
