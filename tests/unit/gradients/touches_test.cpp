// Parameters whose `affects` omit an object that depends on them later in the run: a contact before its first touch,
// a load before its start.
#include <polybody/gradients/gradient.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/contact.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/forces/user_force.hpp>
#include <polybody/gradients/sensitivities.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/run/marker_frames.hpp>

#include "support/refusal.hpp"

using namespace polybody;

namespace affects_test {

using Names = std::vector<std::string>;
using Touch = Contact<SphereOnPlane>;
using Push = PointForce<Window>;
using Balls = Model<Bodies<Rigid<>>, Joints<>, Forces<Touch, Push>>;

/// A ball falls on a floor at 0.064 s, and a push acts on it from 0.1 s. Another ball falls freely. Parameters:
/// stiffness of the floor, push, radius of the ball.
auto balls(std::span<double const> p) {
  Balls m{Gravity{0, 0, -9.81}};
  auto const b = m.add(Rigid<>(1.0, 0.004 * Mat3::Identity(), Placement::at({0, 0, 0.12})), "ball");
  (void)m.add(Rigid<>(1.0, 0.004 * Mat3::Identity(), Placement::at({5, 0, 0.3})), "other");
  m.apply(Touch{.geometry = {.radius = p[2]},
                .normal = {.stiffness = p[0], .damping = 20},
                .friction = {.coefficient = 0.3, .slip_speed = 0.01}},
          b.at(Vec3(0, 0, 0)), m.ground().at({0, 0, 0}), "floor");
  m.apply(Push{.force = {p[1], 0, 0}, .law = {.from = 0.1, .to = 0.5}}, b.at(Vec3(0, 0, 0)), "push");
  State x = m.reference_state();
  m.set_velocity(x, b, Vec3(1, 0, 0), Vec3::Zero());
  auto const place = [b](auto const& mm, auto const& y) {
    auto const r = position(mm, y, b.at(Vec3(0, 0, 0)));
    return r[0] + r[2];
  };
  std::vector<Output<Balls>> outputs{{"x + z [m]", place}};
  return with_objective(Scenario<Balls>{std::move(m), x, {.end_time = 0.14, .step = 1e-3}, std::move(outputs)}, place);
}
std::vector<Parameter> of_balls(Names k, Names push, Names radius) {
  return {{"k [N/m]", 1e4, 0.0, std::move(k)},
          {"push [N]", 2.0, 0.0, std::move(push)},
          {"radius [m]", 0.1, 0.0, std::move(radius)}};
}

GeneralisedAlpha const integrator{.tolerance = 1e-11};

template <class I>
void expect_refusals(I const& by, auto const& differentiate) {
  auto const said = [&](Names k, Names push, Names radius) {
    return refusal([&] { (void)differentiate(balls, of_balls(std::move(k), std::move(push), std::move(radius)), by); });
  };
  // the push names the ball; the stiffness shares its perturbed models
  std::string const of_k = said({"other"}, {"push"}, {});
  EXPECT_TRUE(has(of_k, "Parameter \"k [N/m]\" changes the equations of body \"ball\" at t = 0.06"));
  EXPECT_TRUE(
      has(of_k, "Add the object that depends on the parameter (body \"ball\", force \"floor\", force \"push\")"));
  EXPECT_TRUE(has(said({"floor"}, {"other"}, {}), "\"push [N]\" changes the equations of body \"ball\" at t = 0.1"));
  EXPECT_TRUE(has(said({"floor"}, {"push"}, {"other"}), "\"radius [m]\" changes the equations of body \"ball\""));
  // no parameter names the ball
  EXPECT_TRUE(has(said({"other"}, {"other"}, {}), "\"k [N/m]\" changes the equations of body \"ball\" at t = 0.06"));
}

TEST(Touches, LeftOutAreFoundByDirectDifferentiationWhenTheyBegin) {
  auto const run = [](auto const&... x) { return sensitivities(x...); };
  expect_refusals(integrator, run);
  expect_refusals(RungeKutta4<>{}, run);
}
TEST(Touches, LeftOutAreFoundByTheAdjointThroughEvents) {
  auto const said = [](Names k, Names push) {
    return refusal([&] { (void)gradient(balls, of_balls(std::move(k), std::move(push), {}), integrator); });
  };
  EXPECT_TRUE(has(said({"other"}, {"push"}), "\"k [N/m]\" changes the equations of body \"ball\" at t = 0."));
  EXPECT_TRUE(has(said({"floor"}, {"other"}), "\"push [N]\" changes the equations of body \"ball\" at t = 0.1"));
}

/// This model without the push, whose beginning is a breakpoint.
auto without_push(std::span<double const> p) {
  auto scenario = balls(std::array{p[0], 0.0, p[1]});
  scenario.options.end_time = 0.09;
  return scenario;
}
TEST(Touches, LeftOutAreFoundByTheAdjoint) {
  auto const said = [](Names k, Names radius, auto const& by) {
    std::vector<Parameter> const parameters{{"k [N/m]", 1e4, 0.0, std::move(k)}, {"radius [m]", 0.1, 0.0, radius}};
    return refusal([&] { (void)gradient(without_push, parameters, by); });
  };
  char const* const sentence = "\"k [N/m]\" changes the equations of body \"ball\" at t = 0.0";
  EXPECT_TRUE(has(said({"other"}, {"floor"}, integrator), sentence));
  EXPECT_TRUE(has(said({"other"}, {"floor"}, RungeKutta4<>{}), sentence));
}

/// Complete names give the same derivatives as no names. The beginning of contact causes a kink within the finite
/// difference in the radius. This kink must not be refused.
TEST(Touches, CompleteNamesGiveTheSameDerivatives) {
  auto const named = of_balls({"floor"}, {"push"}, {"floor"}), all = of_balls({}, {}, {});
  SensitivityResult const a = sensitivities(balls, named, integrator), b = sensitivities(balls, all, integrator);
  GradientResult const back = gradient(balls, named, integrator);
  for (Index j = 0; j < 3; ++j) {
    double const size = named[std::size_t(j)].size(), expected = size * b.derivatives.back()(0, j);
    EXPECT_NEAR(size * a.derivatives.back()(0, j), expected, 1e-10) << j;
    EXPECT_NEAR(size * back.derivatives[j], expected, 1e-8) << j;
  }
}

/// Bodies in a row, each pushed by its own parameter. The last parameter also acts on the first body from 0.1 s,
/// scaled by `share`.
template <int count>
auto row_of_bodies(double share) {
  return [share](std::span<double const> p) {
    using Always = PointForce<Constant>;
    using M = Model<Bodies<Rigid<>>, Joints<>, Forces<Always, Push>>;
    M m{Gravity{0, 0, 0}};
    BodyHandle<Rigid<>> first;
    for (int i = 0; i < count; ++i) {
      auto const b =
          m.add(Rigid<>(1.0, Mat3::Identity(), Placement::at({double(i), 0, 0})), "body " + std::to_string(i));
      if (i == 0) first = b;
      m.apply(Always{.force = {p[i], 0, 0}, .law = {1.0}}, b.at(Vec3(0, 0, 0)), "push " + std::to_string(i));
    }
    m.apply(Push{.force = {share * p[count - 1], 0, 0}, .law = {.from = 0.1}}, first.at(Vec3(0, 0, 0)), "late");
    State const x = m.reference_state();
    std::vector<Output<M>> outputs{{"x [m]", [](M const&, State const& y) { return y.q[0]; }}};
    return Scenario<M>{std::move(m), x, {.end_time = 0.2, .step = 1e-2}, std::move(outputs)};
  };
}
/// One group of all parameters. The orders of the parameters in two models do not distinguish the first from the last
/// of thirteen.
template <int count>
void expect_late_found(double share) {
  std::vector<Parameter> parameters;
  for (int i = 0; i < count; ++i) {
    std::string const n = std::to_string(i);
    parameters.push_back({"f" + n + " [N]", 1.0 + 0.1 * i, 0.0, {"push " + n}});
  }
  std::string const last = "\"f" + std::to_string(count - 1) + " [N]\"";
  EXPECT_TRUE(has(refusal([&] { (void)sensitivities(row_of_bodies<count>(share), parameters, integrator); }),
                  last + " changes the equations of body \"body 0\" at t = 0.1"));
}
TEST(Touches, LeftOutAreFoundAmongManyThatShareModels) {
  expect_late_found<2>(1.0);
  expect_late_found<2>(-1.0);
  expect_late_found<2>(1e-3);
  expect_late_found<12>(1.0);
  expect_late_found<13>(1.0);
  expect_late_found<14>(1e-3);
}

/// In joint coordinates a parameter touches all equations, so incomplete names have no effect.
TEST(Touches, ChangeNothingInJointCoordinates) {
  auto const make = [](std::span<double const> p) {
    using Rod = planar::Rigid;
    using Pin = Joint<planar::Revolute, JointCoordinates>;
    using M = Model<Bodies<Rod>, Joints<Pin>, Forces<Push>>;
    M m{Gravity{0, -9.81, 0}};
    BodyHandle<Rod> last;
    for (int i = 0; i < 2; ++i) {
      auto const rod = m.add(Rod(p[0], 0.02, Placement::at({0.5 + i, 0, 0})), "rod " + std::to_string(i));
      m.connect(Pin{}, i == 0 ? m.ground().at({0, 0, 0}) : m.ground().at({1, 0, 0}), rod.at(Vec2(-0.5, 0)));
      last = rod;
    }
    m.apply(Push{.force = {0, p[1], 0}, .law = {.from = 0.05, .to = 0.5}}, last.at(Vec2(0.5, 0)), "push");
    State const x = m.reference_state();
    std::vector<Output<M>> outputs{{"angle [rad]", [](M const&, State const& y) { return y.q[5]; }}};
    return Scenario<M>{std::move(m), x, {.end_time = 0.1, .step = 2e-3}, std::move(outputs)};
  };
  auto const of = [](Names push) {
    return std::vector<Parameter>{{"mass [kg]", 1.0, 0.0, {"rod 0"}}, {"push [N]", 2.0, 0.0, std::move(push)}};
  };
  MatX const a = sensitivities(make, of({"rod 0"}), integrator).derivatives.back(),
             b = sensitivities(make, of({}), integrator).derivatives.back();
  EXPECT_GT(std::abs(b(0, 1)), 1e-4);
  EXPECT_EQ(a, b);
}

}  // namespace affects_test
