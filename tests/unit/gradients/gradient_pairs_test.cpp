// Pairs of bodies, policies and integrators: the adjoint gradient of a run against its forward sensitivities.
#include <polybody/gradients/gradient.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/gradients/sensitivities.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/hht_alpha.hpp>
#include <polybody/integrators/newmark.hpp>
#include <polybody/joints/policies/constraint.hpp>

#include "support/rated_links.hpp"

using namespace polybody;

namespace gradient_pairs_test {

template <class B, class Policy, class I>
void expect_direct_derivatives(I const& integrator) {
  expect_direct_derivatives(rated_links<B, Policy>(0.0), integrator, 1e-11);
  // accelerations and multipliers contain the round-off of the constraint equations over βh²
  expect_direct_derivatives(rated_links<B, Policy>(1.0), integrator, 1e-9);
}

TEST(GradientByPairs, RigidOnConstraintByGeneralizedAlpha) {
  expect_direct_derivatives<Rigid<>, Constraint>(GeneralisedAlpha{});
}
TEST(GradientByPairs, RigidOnBushingByTrapezoidal) { expect_direct_derivatives<Rigid<>, Bushing>(Trapezoidal{}); }
TEST(GradientByPairs, CableOnPenaltyByHht) { expect_direct_derivatives<AncfCable<>, Penalty>(HhtAlpha{}); }
TEST(GradientByPairs, LrvfOnBushingByNewmark) { expect_direct_derivatives<Lrvf<>, Bushing>(Newmark{}); }
TEST(GradientByPairs, FloatingFrameOnConstraintByHht) { expect_direct_derivatives<Ffr, Constraint>(HhtAlpha{}); }
TEST(GradientByPairs, BeamOnConstraintByGeneralizedAlpha) {
  expect_direct_derivatives<AncfBeam<ElasticLine>, Constraint>(GeneralisedAlpha{.rho_inf = 0.5});
}

}  // namespace gradient_pairs_test
