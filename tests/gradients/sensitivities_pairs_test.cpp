// Bodies × policies × integrators by pairs: derivatives of runs beside differences of runs.
#include <polybody/gradients/sensitivities.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/generalized_alpha.hpp>
#include <polybody/integrators/hht_alpha.hpp>
#include <polybody/integrators/newmark.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/policies/constraint.hpp>
#include <polybody/joints/policies/penalty.hpp>
#include <polybody/joints/revolute.hpp>
#include <polybody/joints/spherical.hpp>

#include "support/differences_of_runs.hpp"

using namespace polybody;

namespace sensitivities_pairs_test {

using P = std::span<double const>;

template <class B>
B body_of(Bar const& bar) {
  if constexpr (requires { B::from(bar, 1); })
    return B::from(bar, 1);
  else
    return B::from(bar);
}
template <class Policy>
Policy policy_of(double stiffness) {
  if constexpr (std::is_same_v<Policy, Bushing>)
    return Bushing{.stiffness = Bushing::Matrix(stiffness * Bushing::Matrix::Identity()),
                   .damping = Bushing::Matrix(1e-3 * stiffness * Bushing::Matrix::Identity())};
  else if constexpr (std::is_same_v<Policy, Penalty>)
    return Penalty{.stiffness = stiffness, .damping = 1e-3 * stiffness};
  else
    return Policy{};
}

/// Two links of soft rods, the second across the first, that fall about pins which are not parallel. Parameters:
/// Young's modulus, density, stiffness of the pins, length of the second link, speed of the start.
template <class B, class Policy>
auto const links = [](P p) {
  constexpr bool knows_frames = B::observes == Observes::frame;
  using Pin = Joint<std::conditional_t<knows_frames, Revolute, Spherical>, Policy>;
  using M = Model<Bodies<B>, Joints<Pin>>;
  M model{Gravity{0, 0, -9.81}};
  Bar bar{.length = 0.5,
          .section = Rectangle{.height = 0.02, .width = 0.03},
          .material = Material{.density = p[1], .young = p[0], .poisson = 0.3}};
  auto const first = model.add(body_of<B>(bar), "first");
  bar.placement = Placement::at({0.5, 0, 0});
  bar.length = p[3];
  auto const second = model.add(body_of<B>(bar), "second");
  Policy const policy = policy_of<Policy>(p[2]);
  auto const pin = [&](Vec3 const& axis) {
    if constexpr (knows_frames)
      return Pin{Revolute{.axis = axis}, policy};
    else
      return Pin{Spherical{}, policy};
  };
  model.connect(pin({0, 1, 0}), model.ground().at({0, 0, 0}), first.at(0.0), "shoulder");
  model.connect(pin({0, 0.8, 0.6}), first.at(0.5), second.at(0.0), "elbow");
  State start = model.reference_state();
  System const system(model, with<Entries::rigid_speeds>);
  system.entries().first.rigid_speeds(system.entries().second, start.q, Vec3::Zero(), {0, p[4], 0}, start.v);
  double const end = p[3];
  std::vector<Output<M>> outputs{
      {"tip x [m]", [second, end](M const& m, State const& x) { return position(m, x, second.at(end))[0]; }},
      {"tip y [m]", [second, end](M const& m, State const& x) { return position(m, x, second.at(end))[1]; }},
      {"tip z [m]", [second, end](M const& m, State const& x) { return position(m, x, second.at(end))[2]; }}};
  return Scenario<M>{std::move(model), start, {.until = 0.06, .step = 2e-3}, std::move(outputs)};
};

template <class Make, class I>
void expect_slopes_of_runs(Make const& make, std::vector<Parameter> const& parameters, I const& integrator) {
  Sensitivities const s = sensitivities(make, parameters, integrator);
  MatX const expected = by_differences(make, parameters, integrator);
  EXPECT_LT(s.left, 1e-9);
  for (Index j = 0; j < expected.cols(); ++j)
    EXPECT_LT((s.slopes.back().col(j) - expected.col(j)).norm(),
              1e-7 * (expected.col(j).norm() + 1e-4 / parameters[std::size_t(j)].size()))
        << parameters[std::size_t(j)].name << ": " << s.slopes.back().col(j).transpose() << " for "
        << expected.col(j).transpose();
}
std::vector<Parameter> const all{{"young [Pa]", 2e8},
                                 {"density [kg/m³]", 2000.0},
                                 {"stiffness of pins [N/m]", 1e6},
                                 {"length [m]", 0.4},
                                 {"spin [rad/s]", 2.0}};

TEST(SensitivitiesByPairs, RigidOnConstraintByGeneralizedAlpha) {
  expect_slopes_of_runs(links<Rigid<>, Constraint>, all, GeneralizedAlpha{});
}
TEST(SensitivitiesByPairs, RigidOnBushingByTrapezoidal) {
  expect_slopes_of_runs(links<Rigid<>, Bushing>, all, Trapezoidal{});
}
TEST(SensitivitiesByPairs, CableOnPenaltyByHht) { expect_slopes_of_runs(links<AncfCable<>, Penalty>, all, HhtAlpha{}); }
TEST(SensitivitiesByPairs, LrvfOnBushingByNewmark) { expect_slopes_of_runs(links<Lrvf<>, Bushing>, all, Newmark{}); }
TEST(SensitivitiesByPairs, FloatingFrameOnConstraintByHht) {
  expect_slopes_of_runs(links<Ffr, Constraint>, all, HhtAlpha{});
}
TEST(SensitivitiesByPairs, BeamOnConstraintByGeneralizedAlpha) {
  expect_slopes_of_runs(links<AncfBeam<ElasticLine>, Constraint>, all, GeneralizedAlpha{.rho_inf = 0.5});
}

}  // namespace sensitivities_pairs_test
