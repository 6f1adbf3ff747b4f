#pragma once
// Events in runs whose joints eliminate coordinates.

#include <polybody/gradients/sensitivities.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/standard_joints.hpp>

#include "support/differences_of_runs.hpp"
#include "support/hung_cables.hpp"

namespace polybody {

/// The tip of cables on AncfLinear pins hits a floor: the event function and the event action use full states. Steps
/// have the length h [s].
inline auto impact_of_cables(double h) {
  return [h](std::span<double const> p) {
    auto scenario = hung_cables<AncfLinear, false>(h)(std::array{1e7, p[0], p[1], p[2], 2.0});
    Index const z = scenario.start.q.size() - 4;  // height of the tip; its gradient follows
    Event const floor{.name = "floor",
                      .value = [z, height = p[3]](State const& x) { return x.q[z] - height; },
                      .tolerance = 1e-15,
                      .action = [](State& x) { x.v *= -0.5; }};
    scenario.options.events = {floor};
    return scenario;
  };
}
inline std::vector<Parameter> const of_impact{
    {"density [kg/m³]", 1000.0}, {"place [m]", 0.31}, {"gravity [m/s²]", 9.81}, {"floor [m]", -0.1}};

template <class I>
void expect_impact_of_cables(double h, I const& integrator) {
  auto const make = impact_of_cables(h);
  SensitivityResult const s = sensitivities(make, of_impact, integrator);
  ASSERT_EQ(s.run.events.size(), 1u);
  MatX const expected = by_differences(make, of_impact, integrator);
  for (Index j = 0; j < expected.cols(); ++j) {
    double const size = of_impact[std::size_t(j)].size();
    EXPECT_LT(size * (s.derivatives.back().col(j) - expected.col(j)).norm(), 1e-7) << of_impact[std::size_t(j)].name;
    EXPECT_GT(size * expected.col(j).norm(), 1e-3) << of_impact[std::size_t(j)].name;
  }
}

/// A nut on a thread: z = p θ. Parameters: pitch, mass, spin, and the position at which an event reverses it.
inline auto const nut_on_thread = [](std::span<double const> p) {
  using Thread = Joint<Screw, JointCoordinates>;
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
                   .action = [](State& x) { x.v *= -0.5; }};
  return Scenario<M>{std::move(model), start, {.end_time = 0.2, .step = 1e-2, .events = {stop}}, std::move(outputs)};
};
inline std::vector<Parameter> const of_nut{
    {"pitch [m/rad]", 0.02}, {"mass [kg]", 2.0}, {"spin [rad/s]", 20.0}, {"stop [m]", 0.03}};
/// The derivatives equal those of the closed form.
template <class I>
void expect_derivatives_of_nut(I const& integrator) {
  // J ω˙ + m p² ω˙ = −m g p, first from ω₀ and then, at p θ = z₁, from −ω/2
  auto const closed_form = [](std::vector<double> const& p) {
    double const rate = -p[1] * 9.81 * p[0] / (0.01 + p[1] * p[0] * p[0]);
    double const turned = p[3] / p[0], t = (-p[2] + std::sqrt(p[2] * p[2] + 2.0 * rate * turned)) / rate;
    double const back = -0.5 * (p[2] + rate * t), left = 0.2 - t;
    return Vec2(p[3] + p[0] * (back * left + 0.5 * rate * left * left), back + rate * left);
  };
  std::vector<Parameter> const& parameters = of_nut;
  SensitivityResult const s = sensitivities(nut_on_thread, parameters, integrator);
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
    EXPECT_LT((s.derivatives.back().col(Index(j)) - slope).norm(), 1e-8 * slope.norm()) << parameters[j].name;
  }
}

}  // namespace polybody
