// Derivatives of runs in joint coordinates.
#include <polybody/gradients/gradient.hpp>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/gradients/sensitivities.hpp>
#include <polybody/integrators/generalized_alpha.hpp>
#include <polybody/joints/planar/prismatic.hpp>
#include <polybody/joints/planar/revolute.hpp>
#include <polybody/joints/screw.hpp>

#include "support/carried_arm.hpp"
#include "support/slopes_of_runs.hpp"

using namespace polybody;

namespace joint_coordinates_test {

GeneralizedAlpha const integrator{.rho_inf = 0.7};

template <class Policy, CarriedArm what>
void expect_slopes() {
  auto parameters = parameters_of_carried_arm;
  if (!what.flexible) parameters.pop_back();
  auto const make = carried_arm<Policy, what>(2e-3);
  // the rounding of rows over βh² is in what the rod holds, and differences of runs divide it by their distance
  expect_slopes_of_runs(make, parameters, integrator, what.loop ? 1e-7 : 1e-8);
  expect_slopes_backwards(make, parameters, integrator, 1e-11);
}

TEST(JointCoordinatesUnderParameters, OfATreeInTheAugmentedSystem) {
  expect_slopes<Recursive, CarriedArm{}>();
  expect_slopes<Recursive, CarriedArm{.loop = true}>();
}
TEST(JointCoordinatesUnderParameters, OfATreeInTheDenseSystem) {
  expect_slopes<RecursiveBy<recursive::Reduced>, CarriedArm{.loop = true}>();
}
TEST(JointCoordinatesUnderParameters, OfATreeBodyByBody) {
  expect_slopes<RecursiveBy<recursive::ArticulatedBody>, CarriedArm{}>();
  expect_slopes<RecursiveBy<recursive::ArticulatedBody>, CarriedArm{.loop = true}>();
}
TEST(JointCoordinatesUnderParameters, OfATreeWithABeamThatFloatsOnAFrame) {
  expect_slopes<Recursive, CarriedArm{.flexible = true}>();
}

/// In the plane: a beam on a pin with a slider at its end, and two bodies on a pin that fly. Parameters: Young's
/// modulus, where the slider sits, a mass, a spin.
auto const in_the_plane = [](std::span<double const> p) {
  using Turn = Joint<planar::Revolute, Recursive>;
  using Slide = Joint<planar::Prismatic, Recursive>;
  using M = Model<Bodies<planar::Rigid, planar::Ffr>, Joints<Turn, Slide>>;
  M model{Gravity{0, -9.81, 0}};
  auto const slider = model.add(planar::Rigid(p[2], 0.01, Placement::planar(0.6, p[1], 0.2)), "slider");
  Vec2 const end_of_beam = Eigen::Rotation2D(-0.2) * Vec2(-0.1, -p[1]);  // on the slider
  auto const beam = model.add(planar::Ffr::from({.length = 0.5,
                                                 .section = Rectangle{.height = 0.01, .width = 0.01},
                                                 .material = Material{.density = 2000.0, .young = p[0], .poisson = 0.3},
                                                 .placement = Placement::at({0, 0, 0})},
                                                2),
                              "beam");
  Vec2 const end_of_first = Vec2(2.0, 0.0) + Eigen::Rotation2D(3.0) * Vec2(-0.3, -0.05);
  auto const first = model.add(planar::Rigid(1.0, 0.02, Placement::planar(2.0, 0, 3.0)), "first");
  auto const second =
      model.add(planar::Rigid(p[2], 0.02, Placement::planar(end_of_first[0] + 0.2, end_of_first[1])), "second");
  model.connect(Turn{}, model.ground().at({0, 0, 0}), beam.at(0.0), "pin");
  model.connect(Slide{{.axis = Vec3::UnitX()}}, beam.at(0.5), slider.at(end_of_beam), "slide");
  model.connect(Turn{}, second.at(Vec2(-0.2, 0.0)), first.at(Vec2(-0.3, -0.05)), "flying pin");
  State start = model.reference_state();
  System const system(model, with<Entries::rigid_speeds>);
  system.entries().first.rigid_speeds(system.entries().second, start.q, Vec3::Zero(), {0, 0, p[3]}, start.v);
  start.v[8] += 1.0;  // of the second body that flies
  auto const end = [slider, second](auto const& m, auto const& x) {
    auto const a = position(m, x, slider.at(Vec2(0.05, 0.02))), b = position(m, x, second.at(Vec2(0.0, 0.1)));
    auto sum = a[0] + 2.0 * a[1] + b[0] - b[1];
    for (Index i = 0; i < x.v.size(); ++i) sum += 0.002 * double(i + 1) * x.v[i];
    return sum;
  };
  auto const way = [second](auto const& m, auto const& x) { return position(m, x, second.at(Vec2(0.0, 0.1)))[1]; };
  std::vector<Output<M>> outputs{{"end [1]", end}, {"way [1]", way}};
  return rated(Scenario<M>{std::move(model), start, {.until = 0.1, .step = 2e-3}, std::move(outputs)}, end, way);
};
TEST(JointCoordinatesUnderParameters, InThePlane) {
  std::vector<Parameter> const parameters{
      {"young [Pa]", 1e9}, {"place [m]", 0.1}, {"mass [kg]", 0.2}, {"spin [rad/s]", 3.0}};
  expect_slopes_of_runs(in_the_plane, parameters, integrator, 1e-7);  // of a beam that swings many times
  expect_slopes_backwards(in_the_plane, parameters, integrator, 1e-11);
}

/// A nut on a thread: z = p θ. Parameters: pitch, mass, spin; and where an event turns it back.
auto const nut = [](std::span<double const> p) {
  using Thread = Joint<Screw, Recursive>;
  using M = Model<Bodies<Rigid<>>, Joints<Thread>>;
  M model{Gravity{0, 0, -9.81}};
  auto const body = model.add(Rigid<>(p[1], 0.01 * Mat3::Identity(), Placement::at({0, 0, 0})), "nut");
  model.connect(Thread{{.pitch = p[0], .axis = Vec3::UnitZ()}, {}}, model.ground().at({0, 0, 0}), body.at({0, 0, 0}),
                "thread");
  State start = model.reference_state();
  start.v[2] = p[0] * p[2];
  start.v[5] = p[2];
  std::vector<Output<M>> outputs{{"z [m]", [](M const&, State const& x) { return x.q[2]; }},
                                 {"spin [rad/s]", [](M const&, State const& x) { return x.v[5]; }}};
  Event const stop{.name = "stop",
                   .value = [at = p[3]](State const& x) { return x.q[2] - at; },
                   .tolerance = 1e-15,
                   .then = [](State& x) { x.v *= -0.5; }};
  return Scenario<M>{std::move(model), start, {.until = 0.2, .step = 1e-2, .events = {stop}}, std::move(outputs)};
};
TEST(JointCoordinatesUnderParameters, OfAThreadAndOfWhatAnEventDoes) {
  // J ω˙ + m p² ω˙ = −m g p, once from ω₀ and once from −ω/2 where p θ = z₁
  auto const closed_form = [](std::vector<double> const& p) {
    double const rate = -p[1] * 9.81 * p[0] / (0.01 + p[1] * p[0] * p[0]);
    double const turned = p[3] / p[0], t = (-p[2] + std::sqrt(p[2] * p[2] + 2.0 * rate * turned)) / rate;
    double const back = -0.5 * (p[2] + rate * t), left = 0.2 - t;
    return Vec2(p[3] + p[0] * (back * left + 0.5 * rate * left * left), back + rate * left);
  };
  std::vector<Parameter> const parameters{
      {"pitch [m/rad]", 0.02}, {"mass [kg]", 2.0}, {"spin [rad/s]", 20.0}, {"stop [m]", 0.03}};
  Sensitivities const s = sensitivities(nut, parameters, integrator);
  ASSERT_EQ(s.run.events.size(), 1u);
  std::vector<double> p;
  for (Parameter const& one : parameters) p.push_back(one.value);
  for (std::size_t j = 0; j < p.size(); ++j) {
    Vec2 slope = Vec2::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      std::vector<double> near = p;
      near[j] *= 1.0 + 1e-3 * FourPoints::places[k];
      slope += FourPoints::weights[k] / (1e-3 * p[j]) * closed_form(near);
    }
    EXPECT_LT((s.slopes.back().col(Index(j)) - slope).norm(), 1e-8 * slope.norm()) << parameters[j].name;
  }
}

TEST(JointCoordinatesUnderParameters, ApproachSlopesOnRowsAtSecondOrder) {
  auto parameters = parameters_of_carried_arm;
  parameters.pop_back();
  auto const apart = [&](double h) {
    MatX const free = sensitivities(carried_arm<Recursive, CarriedArm{}>(h), parameters, integrator).slopes.back(),
               on_rows = sensitivities(carried_arm<Constraint, CarriedArm{}>(h), parameters, integrator).slopes.back();
    double most = 0.0;
    for (Index j = 0; j < free.cols(); ++j)
      most = std::max(most, parameters[std::size_t(j)].size() * (free - on_rows).col(j).head(3).norm());
    return most;
  };
  double const coarse = apart(4e-3), fine = apart(2e-3);
  EXPECT_LT(fine, 1e-3);
  EXPECT_NEAR(coarse / fine, 4.0, 1.0);
}

}  // namespace joint_coordinates_test
