// Bodies × policies × integrators by pairs: the adjoint of a run beside its direct differentiation.
#include <polybody/gradients/gradient.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/gradients/sensitivities.hpp>
#include <polybody/integrators/generalized_alpha.hpp>
#include <polybody/integrators/hht_alpha.hpp>
#include <polybody/integrators/newmark.hpp>
#include <polybody/joints/policies/constraint.hpp>

#include "support/two_links.hpp"

using namespace polybody;

namespace gradient_pairs_test {

/// Two links, rated by where the tip ends, how the bodies move and, by a factor, how they are held then; and by the
/// tip's way to there.
template <class B, class Policy>
auto rated_links(double held) {
  return [held](std::span<double const> p) {
    auto links = two_links<B, Policy>(p);
    auto const tip = links.tip;
    auto const end = [tip, held](auto const& model, auto const& x) {
      auto const r = position(model, x, tip);
      auto sum = r[0] + 2.0 * r[1] - 0.5 * r[2];
      for (Index i = 0; i < x.v.size(); ++i) sum += 0.01 * double(i + 1) * x.v[i] + 1e-4 * held * x.a[i];
      for (Index i = 0; i < x.lambda.size(); ++i) sum += 1e-3 * held * double(i + 1) * x.lambda[i];
      return sum;
    };
    auto const way = [tip, mass = 1e-3 * p[1]](auto const& model, auto const& x) {
      auto const r = position(model, x, tip);
      return mass * (r[0] * r[0] + r[2]);
    };
    links.outputs = {{"end [1]", end}, {"way [1]", way}};
    using M = std::remove_cvref_t<decltype(links.model)>;
    return rated(Scenario<M>(std::move(links)), end, way);
  };
}

template <class Make, class I>
void expect_direct_slopes(Make const& make, I const& integrator, double within) {
  std::vector<Parameter> const& parameters = parameters_of_two_links;
  Sensitivities const direct = sensitivities(make, parameters, integrator);
  Gradient const g = gradient(make, parameters, integrator);
  EXPECT_LT(g.left, 1e-10);
  double value = direct.values.back()[0];
  VecX expected = direct.slopes.back().row(0).transpose();
  for (std::size_t k = 1; k < direct.times.size(); ++k) {
    double const half = 0.5 * (direct.times[k] - direct.times[k - 1]);
    value += half * (direct.values[k][1] + direct.values[k - 1][1]);
    expected += half * (direct.slopes[k].row(1) + direct.slopes[k - 1].row(1)).transpose();
  }
  EXPECT_NEAR(g.value, value, 1e-13 * std::abs(value));
  for (Index j = 0; j < expected.size(); ++j) {
    double const size = parameters[std::size_t(j)].size();
    EXPECT_NEAR(size * g.slopes[j], size * expected[j], within * (std::abs(size * expected[j]) + 1.0))
        << parameters[std::size_t(j)].name;
  }
}
template <class B, class Policy, class I>
void expect_direct_slopes(I const& integrator) {
  expect_direct_slopes(rated_links<B, Policy>(0.0), integrator, 1e-11);
  // in accelerations and multipliers is the rounding of rows over βh²
  expect_direct_slopes(rated_links<B, Policy>(1.0), integrator, 1e-9);
}

TEST(GradientByPairs, RigidOnConstraintByGeneralizedAlpha) {
  expect_direct_slopes<Rigid<>, Constraint>(GeneralizedAlpha{});
}
TEST(GradientByPairs, RigidOnBushingByTrapezoidal) { expect_direct_slopes<Rigid<>, Bushing>(Trapezoidal{}); }
TEST(GradientByPairs, CableOnPenaltyByHht) { expect_direct_slopes<AncfCable<>, Penalty>(HhtAlpha{}); }
TEST(GradientByPairs, LrvfOnBushingByNewmark) { expect_direct_slopes<Lrvf<>, Bushing>(Newmark{}); }
TEST(GradientByPairs, FloatingFrameOnConstraintByHht) { expect_direct_slopes<Ffr, Constraint>(HhtAlpha{}); }
TEST(GradientByPairs, BeamOnConstraintByGeneralizedAlpha) {
  expect_direct_slopes<AncfBeam<ElasticLine>, Constraint>(GeneralizedAlpha{.rho_inf = 0.5});
}

}  // namespace gradient_pairs_test
