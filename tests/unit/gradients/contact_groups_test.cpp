// Derivatives of runs with contact in two versions: one contact law per pair of balls, and one contact group of all
// balls.
#include <polybody/forces/contact_group.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/contact.hpp>
#include <polybody/gradients/gradient.hpp>
#include <polybody/gradients/sensitivities.hpp>
#include <polybody/integrators/generalised_alpha.hpp>

#include "support/differences_of_runs.hpp"

using namespace polybody;

namespace contact_groups_test {

using OnPlane = Contact<SphereOnPlane>;
using OnBall = Contact<SphereOnSphere, HuntCrossleyContact>;
using Group = ContactGroup<OnPlane, OnBall>;

std::vector<Parameter> const parameters{{"mass of a ball [kg]", 0.5},
                                        {"stiffness of the floor [N/m]", 2e4},
                                        {"friction [1]", 0.4},
                                        {"first height [m]", 0.12}};

// Three balls fall onto a floor and against a heavier ball.
template <bool grouped>
auto heap(std::span<double const> p) {
  using M = Model<Bodies<Rigid<>>, Joints<>, std::conditional_t<grouped, Forces<Group>, Forces<OnPlane, OnBall>>>;
  M model{Gravity{0, 0, -9.81}};
  double const r = 0.1;
  auto const ball = [&](double m, double radius, Vec3 const& at) {
    return Rigid<>(m, Mat3(0.4 * m * radius * radius * Mat3::Identity()), Placement::at(at));
  };
  auto const heavy = model.add(ball(4.0, 0.2, {-0.31, 0, 0.2}), "heavy ball");
  std::vector<Marker<Rigid<>>> many;
  std::vector<BodyHandle<Rigid<>>> balls;
  for (int i = 0; i < 3; ++i) {
    balls.push_back(model.add(ball(p[0], r, {0.25 * i, 0.03 * i, p[3] + 0.01 * i})));
    many.push_back(balls.back().at(Vec3(0, 0, 0)));
  }
  Friction const rubber{.coefficient = p[2], .slip_speed = 0.05};
  OnPlane const on_floor{{.radius = r}, {.stiffness = p[1], .damping = 15.0}, rubber};
  OnBall const on_heavy{{.radius_a = r, .radius_b = 0.2}, {.stiffness = 2e5, .damping = 0.2}, rubber};
  auto const floor = model.ground().at({0, 0, 0});
  auto const middle = heavy.at(Vec3(0, 0, 0));
  OnPlane const heavy_on_floor{{.radius = 0.2}, {.stiffness = p[1], .damping = 15.0}, rubber};
  if constexpr (grouped) {
    auto const group = model.apply(Group{}, many, "balls");
    model.add_partner(group, on_floor, floor, "floor");
    model.add_partner(group, on_heavy, middle, "heavy ball");
    auto const alone = model.apply(Group{}, std::vector{middle}, "heavy one");
    model.add_partner(alone, heavy_on_floor, floor, "floor");
  } else {
    for (auto const& one : many) {
      model.apply(on_floor, one, floor);
      model.apply(on_heavy, one, middle);
    }
    model.apply(heavy_on_floor, middle, floor);
  }
  State start = model.reference_state();
  for (auto const& b : balls) model.set_velocity(start, b, {-1.0, 0.2, -0.5}, {0, 3.0, 0});
  auto const height = [last = many.back(), first = many.front()](auto const& m, auto const& x) {
    auto const a = position(m, x, last), b = position(m, x, first);
    return a[2] + 0.3 * a[0] + b[1] - 0.7 * b[0];
  };
  std::vector<Output<M>> outputs{{"place [m]", height}};
  return with_objective(Scenario<M>{std::move(model), start, {.end_time = 0.12, .step = 1e-3}, std::move(outputs)},
                        height);
}

GeneralisedAlpha const integrator{.tolerance = 1e-12, .start_correction = false};

TEST(GradientsOfContactGroups, AreThoseOfTheirPairs) {
  auto const grouped = [](std::span<double const> p) { return heap<true>(p); };
  auto const one_by_one = [](std::span<double const> p) { return heap<false>(p); };
  VecX const expected = sensitivities(one_by_one, parameters, integrator).derivatives.back().row(0).transpose(),
             direct = sensitivities(grouped, parameters, integrator).derivatives.back().row(0).transpose(),
             adjoint = gradient(grouped, parameters, integrator).derivatives;
  MatX const differences = by_differences(grouped, parameters, integrator);
  VecX sizes(expected.size());
  for (Index j = 0; j < sizes.size(); ++j) sizes[j] = parameters[std::size_t(j)].size();
  double const largest = sizes.cwiseProduct(expected).lpNorm<Eigen::Infinity>();
  for (Index j = 0; j < sizes.size(); ++j) {
    std::string const& name = parameters[std::size_t(j)].name;
    EXPECT_GT(sizes[j] * std::abs(expected[j]), 1e-5) << name;
    EXPECT_NEAR(sizes[j] * direct[j], sizes[j] * expected[j], 1e-10 * largest) << name;
    EXPECT_NEAR(sizes[j] * adjoint[j], sizes[j] * direct[j], 1e-11 * largest) << name;
    // the difference in the parameter moves contacts from one step to another
    EXPECT_NEAR(sizes[j] * differences(0, j), sizes[j] * expected[j], 3e-5 * largest) << name;
  }
}

}  // namespace contact_groups_test
