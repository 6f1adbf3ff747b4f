// Derivatives of runs with bristle friction and with friction that follows a reaction; checkpoints of their states.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/forces/bristle_friction.hpp>
#include <polybody/forces/reaction_friction.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/io/checkpoint.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/run/probe.hpp>

#include "support/slopes_of_runs.hpp"

using namespace polybody;

namespace friction_test {

using P = std::span<double const>;
using OnFloor = Contact<SphereOnPlane, SpringDamperContact, BristleFriction>;
using Sliding = Model<Bodies<planar::Rigid>, Joints<>, Forces<OnFloor>>;

/// Coordinate i, and the angular velocity.
template <class M>
std::vector<Output<M>> outputs(Index i) {
  return {{"q", [i](M const&, State const& x) { return x.q[i]; }},
          {"omega", [](M const&, State const& x) { return x.v[2]; }}};
}

/// Disc that slides on a floor and begins to roll. The parameters are μ, σ₀, σ₁ and the initial speed.
Sliding disc(double mu, double stiffness, double damping) {
  Sliding model{Gravity{0, -9.81, 0}};
  Mat3 axes;  // the floor's z points upwards
  axes << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  auto const body = model.add(planar::Rigid(2.0, 0.04, Placement::planar(0, 0.2 - 2.0 * 9.81 / 1e4)), "disc");
  model.apply(OnFloor{{.radius = 0.2},
                      {.stiffness = 1e4, .damping = 50.0},
                      {.coefficient = mu, .stiffness = stiffness, .damping = damping}},
              body.at(Vec2(0, 0)), model.ground().at(Placement{Vec3::Zero(), axes}), "floor");
  return model;
}
auto rolling = [](P p) {
  Sliding model = disc(p[0], p[1], p[2]);
  State start = model.reference_state();
  start.v[0] = p[3];
  return with_objective(
      Scenario<Sliding>{std::move(model), start, {.end_time = 0.4, .step = 1e-3}, outputs<Sliding>(0)},
      [](auto const&, auto const& x) { return x.q[0]; }, [](auto const&, auto const& x) { return x.v[2]; });
};
std::vector<Parameter> const of_rolling{
    {"mu [1]", 0.3}, {"stiffness [N/m]", 500.0}, {"damping [N s/m]", 20.0}, {"speed [m/s]", 0.6}};

TEST(BristleFriction, HasTheDerivativesOfTheRun) {
  expect_derivatives_of_runs(rolling, of_rolling, GeneralisedAlpha{}, 1e-6);
  expect_derivatives_backwards(rolling, of_rolling, GeneralisedAlpha{}, 1e-7);
}

using Pin = Joint<planar::Revolute, Constraint>;
template <class F>
using Swinging = Model<Bodies<planar::Rigid>, Joints<Pin>, Forces<F>>;
/// Pendulum with friction of its bearing. The parameters are μ and the mass.
template <class F>
auto swinging(F force) {
  return [force](P p) {
    Swinging<F> model{Gravity{0, -9.81, 0}};
    auto const body = model.add(planar::Rigid(p[1], 0.1, Placement::planar(0.5, 0)), "pendulum");
    auto const pin = model.connect(Pin{}, model.ground().at({0, 0, 0}), body.at(Vec2(-0.5, 0)), "pin");
    F friction = force;
    friction.coefficient = p[0];
    model.apply(friction, pin, "bearing");
    State const start = model.reference_state();
    return with_objective(
        Scenario<Swinging<F>>{std::move(model), start, {.end_time = 0.6, .step = 1e-3}, outputs<Swinging<F>>(2)},
        [](auto const&, auto const& x) { return x.q[2]; }, [](auto const&, auto const& x) { return x.v[2]; });
  };
}
std::vector<Parameter> const of_swinging{{"mu [1]", 0.4}, {"mass [kg]", 2.0}};
TEST(BearingFriction, HasTheDerivativesOfTheRun) {
  auto const regular =
      swinging(BearingFriction<Pin>{.coefficient = 0.0, .radius = 0.2, .resistance = {.slip_speed = 0.1}});
  expect_derivatives_of_runs(regular, of_swinging, GeneralisedAlpha{}, 1e-6);
  expect_derivatives_backwards(regular, of_swinging, GeneralisedAlpha{}, 1e-7);
  auto const bristle = swinging(StickingBearingFriction<Pin>{
      .coefficient = 0.0, .radius = 0.2, .resistance = {.stiffness = 100.0, .damping = 1.0}});
  expect_derivatives_of_runs(bristle, of_swinging, GeneralisedAlpha{}, 1e-6);
}

TEST(BristleFriction, ContinuesFromACheckpoint) {
  Sliding const model = disc(0.3, 500.0, 20.0);
  State x = model.reference_state(), y;
  x.v[0] = 0.6;
  RunOptions const options{.end_time = 0.4, .step = 1e-3};
  auto const file = std::filesystem::path(testing::TempDir()) / ("friction " + std::to_string(::getpid()));
  auto run = simulate(model, x, GeneralisedAlpha{}, options);
  for (State const& now : run)
    if (now.t > 0.05) break;
  EXPECT_GT(x.v.tail<3>().norm(), 1e-3);  // the deflection of the bristle
  write_checkpoint(file, run.snapshot());
  run.run();
  resume(model, y, GeneralisedAlpha{}, options, read_checkpoint(file)).run();
  std::filesystem::remove(file);
  EXPECT_EQ(y.q, x.q);
  EXPECT_EQ(y.v, x.v);
}

}  // namespace friction_test
