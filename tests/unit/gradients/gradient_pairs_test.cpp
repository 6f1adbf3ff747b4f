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
#include <polybody/joints/policies/policy.hpp>

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

/// Chain of links of 0.1 m on spherical joints, released from the horizontal. The parameters are factors of the masses
/// of the first links. The output is the height of the tip.
struct Chain {
  auto operator()(std::span<double const> p) const {
    using M = Model<Bodies<Rigid<>>, Joints<Joint<Spherical, Constraint>>>;
    M model{Gravity{0, 0, -9.81}};
    std::vector<BodyHandle<Rigid<>>> links;
    for (std::size_t i = 0; i < 16; ++i) {
      double const density = 7800.0 * (i < p.size() ? p[i] : 1.0);
      links.push_back(model.add(Rigid<>::from({.length = 0.1,
                                               .section = Circle{.radius = 0.005},
                                               .material = Material{.density = density, .young = 2e9},
                                               .placement = Placement::at({0.1 * double(i), 0, 0})}),
                                "link " + std::to_string(i)));
      if (i == 0)
        model.connect(Joint<Spherical, Constraint>{}, model.ground().at({0, 0, 0}), links[0].at(0.0));
      else
        model.connect(Joint<Spherical, Constraint>{}, links[i - 1].at(0.1), links[i].at(0.0));
    }
    State const start = model.reference_state();
    auto const tip = links.back();
    std::vector<Output<M>> outputs{
        {"tip z [m]", [tip](M const& m, State const& x) { return position(m, x, tip.at(0.1))[2]; }}};
    return with_objective(Scenario<M>{std::move(model), start, {.end_time = 2.0, .step = 1e-3}, std::move(outputs)},
                          [tip](auto const& m, auto const& x) { return position(m, x, tip.at(0.1))[2]; });
  }
};

// The motion is chaotic: at the end a coordinate changes by some hundreds per unit of a parameter.
TEST(GradientByPairs, LargeSensitivitiesOfAChainAgree) {
  std::vector<Parameter> const parameters{{"mass of link 0", 1.0}, {"mass of link 1", 1.0}};
  VecX const forward = sensitivities(Chain{}, parameters, GeneralisedAlpha{}).derivatives.back().row(0).transpose();
  auto const backward = gradient(Chain{}, parameters, GeneralisedAlpha{}).derivatives;
  for (Index j = 0; j < 2; ++j) EXPECT_NEAR(forward[j], backward[j], 1e-6 * forward.norm()) << j;
  EXPECT_GT(forward.norm(), 1.0);
}

}  // namespace gradient_pairs_test
