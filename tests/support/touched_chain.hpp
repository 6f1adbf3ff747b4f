#pragma once
// A chain whose parameters name the objects that depend on them.

#include <polybody/gradients/objective.hpp>
#include <polybody/gradients/sensitivities.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/penalty.hpp>
#include <polybody/run/probe.hpp>

namespace polybody::touched_chain {

using P = std::span<double const>;

/// A chain of five rods on compliant pins. Parameters: lengths, densities and the stiffness of each pin.
inline auto const chain = [](P p) {
  using Rod = planar::Rigid;
  using Pin = Joint<planar::Revolute, Penalty>;
  using M = Model<Bodies<Rod>, Joints<Pin>>;
  M model{Gravity{0, -9.81, 0}};
  BodyHandle<Rod> last;
  double x = 0.0;
  for (std::size_t i = 0; i < 5; ++i) {
    std::string const number = std::to_string(i);
    auto const rod = model.add(Rod::from({.length = p[3 * i],
                                          .section = Circle{.radius = 0.01},
                                          .material = Material{.density = p[3 * i + 1], .young = 2e11},
                                          .placement = Placement::at({x, 0, 0})}),
                               "rod " + number);
    Pin const pin{planar::Revolute{}, Penalty{.stiffness = p[3 * i + 2], .damping = 10.0}};
    if (i == 0)
      model.connect(pin, model.ground().at({0, 0, 0}), rod.at(0.0), "pin " + number);
    else
      model.connect(pin, last.at(p[3 * (i - 1)]), rod.at(0.0), "pin " + number);
    last = rod;
    x += p[3 * i];
  }
  auto const height = [tip = last.at(p[12])](auto const& m, auto const& y) { return position(m, y, tip)[1]; };
  State const start = model.reference_state();
  return with_objective(Scenario<M>{std::move(model), start, {.end_time = 0.1, .step = 2e-3}}, height);
};
inline std::vector<Parameter> of_chain(bool with_affects) {
  std::vector<Parameter> all;
  for (int i = 0; i < 5; ++i) {
    std::string const n = std::to_string(i), next = std::to_string(i + 1);
    std::vector<std::string> at_rod{"rod " + n, "pin " + n};
    if (i < 4) at_rod.push_back("pin " + next);
    all.push_back({"length " + n + " [m]", 0.2, 0.0, at_rod});
    all.push_back({"density " + n + " [kg/m³]", 7800.0, 0.0, {"rod " + n}});
    all.push_back({"stiffness " + n + " [N/m]", 1e5, 0.0, {"pin " + n}});
  }
  if (!with_affects)
    for (Parameter& p : all) p.affects.clear();
  return all;
}

/// The chain with its last angle as an output.
inline auto chain_with_angle(P p) {
  auto scenario = chain(p);
  scenario.outputs.push_back({"angle [rad]", [](auto const&, State const& x) { return x.q[14]; }});
  return scenario;
}

/// Derivatives of runs of the chain do not depend on the names in `affects`.
template <class I>
void expect_same_derivatives_with_affects(I const& integrator) {
  SensitivityResult const a = sensitivities(chain_with_angle, of_chain(true), integrator),
                          b = sensitivities(chain_with_angle, of_chain(false), integrator);
  for (Index j = 0; j < 15; ++j) {
    double const size = of_chain(true)[std::size_t(j)].size();
    EXPECT_NEAR(size * a.derivatives.back()(0, j), size * b.derivatives.back()(0, j), 1e-11) << j;
    EXPECT_GT(std::abs(size * a.derivatives.back()(0, j)), 1e-8) << j;
  }
}

}  // namespace polybody::touched_chain
