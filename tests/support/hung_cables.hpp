#pragma once
// Two cables. The second hangs on a point of the first that is not a node: a scenario for differentiated runs.

#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/gradients/objective.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>

namespace polybody {

/// Two cables that fall about pins of a policy. If `held` is true, a rod connects the ground to the end of the second
/// cable: a joint whose constraint equation remains. Parameters: Young's modulus, density, the position of the pin on
/// the first cable, gravity, initial spin. The objective function contains the final state and the path of the tip.
/// Steps have the length h [s].
template <class Policy, bool held>
auto hung_cables(double h = 2e-3) {
  return [h](std::span<double const> p) {
    using Cable = AncfCable<>;
    using Pin = Joint<Spherical, Policy>;
    using Rod = Joint<Distance, Constraint>;
    using M = Model<Bodies<Cable>, std::conditional_t<held, Joints<Pin, Rod>, Joints<Pin>>>;
    M model{Gravity{0, 1.0, -p[3]}};
    Bar bar{.length = 0.5,
            .section = Rectangle{.height = 0.02, .width = 0.03},
            .material = Material{.density = p[1], .young = p[0], .poisson = 0.3}};
    auto const first = model.add(Cable::from(bar, 2), "first");
    bar.placement = Placement::at({p[2], 0, 0});
    auto const second = model.add(Cable::from(bar, 2), "second");
    model.connect(Pin{}, model.ground().at({0, 0, 0}), first.at(0.0), "support");
    auto const pin = model.connect(Pin{}, first.at(p[2]), second.at(0.0), "pin");
    auto const tip = second.at(0.5);
    if constexpr (held) model.connect(Rod{{.length = 0.7}, {}}, model.ground().at({p[2] + 0.5, 0.7, 0}), tip, "rod");
    State start = model.reference_state();
    System const system(model, with<Capabilities::rigid_velocities>);
    system.operations().rigid_velocities(start.q, Vec3::Zero(), {0, p[4], 0}, start.v);
    auto const end = [tip](auto const& m, auto const& x) {
      auto const r = position(m, x, tip);
      auto sum = r[0] + 2.0 * r[1] - 0.5 * r[2];
      for (Index i = 0; i < x.v.size(); ++i) sum += 0.002 * double(i + 1) * x.v[i];
      return sum;
    };
    auto const way = [tip, mass = 1e-3 * p[1]](auto const& m, auto const& x) {
      auto const r = position(m, x, tip);
      return mass * (r[0] * r[0] + r[2]);
    };
    std::vector<Output<M>> outputs{
        {"end [1]", end},
        {"way [1]", way},
        {"elbow z [m]",
         [first, place = p[2]](M const& m, State const& x) { return position(m, x, first.at(place))[2]; }},
        {"tip y [m]", [tip](M const& m, State const& x) { return position(m, x, tip)[1]; }},
        {"reaction [10 N]", [pin](M const& m, State const& x) { return 0.1 * reaction(m, x, pin).f[2]; }}};
    return with_objective(Scenario<M>{std::move(model), start, {.end_time = 0.1, .step = h}, std::move(outputs)}, end,
                          way);
  };
}
/// The parameters of `hung_cables`.
inline std::vector<Parameter> const parameters_of_hung_cables{{"young [Pa]", 1e7},
                                                              {"density [kg/m³]", 1000.0},
                                                              {"place [m]", 0.31},
                                                              {"gravity [m/s²]", 9.81},
                                                              {"spin [rad/s]", 2.0}};

}  // namespace polybody
