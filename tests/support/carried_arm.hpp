#pragma once
// Serial chain of bodies with joints of all kinds: a scenario for differentiated runs.

#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/gradients/objective.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>

namespace polybody {

/// Additions to the four bodies of the arm.
struct CarriedArm {
  bool loop = false;      ///< a rod from the ground to the tip, whose constraint equation remains
  bool flexible = false;  ///< a beam that hangs on the arm, with a body at its end
};

/// An arm that rotates. It carries a slider on a spring, which carries a body on a ball joint. This body carries
/// another one that slides and rotates. Parameters: stiffness of the spring, mass of the slider, position of the ball
/// on it, gravity, an initial velocity, Young's modulus of the beam. The initial velocity is projected onto the
/// joints. The objective function contains the final state and the path of the tip. Steps have the length h [s].
template <class Policy, CarriedArm with_what>
auto carried_arm(double h) {
  return [h](std::span<double const> p) {
    constexpr bool loop = with_what.loop, flexible = with_what.flexible;
    using Turn = Joint<Revolute, Policy>;
    using Slide = Joint<Prismatic, Policy>;
    using Ball = Joint<Spherical, Policy>;
    using Both = Joint<Cylindrical, Policy>;
    using Rod = Joint<Distance, Constraint>;
    using M = Model<std::conditional_t<flexible, Bodies<Rigid<>, Ffr>, Bodies<Rigid<>>>,
                    std::conditional_t<loop, Joints<Turn, Slide, Ball, Both, Rod>, Joints<Turn, Slide, Ball, Both>>,
                    Forces<SpringDamper>>;
    M model{Gravity{1.0, 0.5, -p[3]}};
    Mat3 inertia = 0.01 * Mat3::Identity();
    inertia(2, 2) = 0.015;
    double const ball = 0.7 + p[2];
    auto const arm = model.add(Rigid<>(1.0, inertia, Placement::at({0.3, 0, 0})), "arm");
    auto const slider = model.add(Rigid<>(p[1], inertia, Placement::at({0.7, 0, 0.1})), "slider");
    auto const hand = model.add(Rigid<>(0.5, 0.4 * inertia, Placement::at({ball + 0.2, 0, 0.1})), "hand");
    auto const tool = model.add(Rigid<>(0.3, 0.3 * inertia, Placement::at({ball + 0.4, 0, 0})), "tool");
    auto const turn = model.connect(Turn{{.axis = Vec3::UnitY()}, {}}, model.ground().at({0, 0, 0}),
                                    arm.at({-0.3, 0, 0}), "shoulder");
    model.connect(Slide{{.axis = Vec3::UnitX()}, {}}, arm.at({0.3, 0, 0.1}), slider.at({-0.1, 0, 0}), "slide");
    auto const wrist = model.connect(Ball{}, slider.at({p[2], 0, 0}), hand.at({-0.2, 0, 0}), "wrist");
    model.connect(Both{{.axis = Vec3(0, 0.6, 0.8)}, {}}, tool.at({0, 0, 0.1}), hand.at({0.2, 0, 0}), "sleeve");
    if constexpr (loop) {
      Vec3 const pole(1.2, 1.0, 0.0);
      model.connect(Rod{{.length = (pole - Vec3(ball + 0.4, 0, 0)).norm()}, {}}, model.ground().at(pole),
                    tool.at({0, 0, 0}), "rod");
    }
    if constexpr (flexible) {
      Bar const bar{.length = 0.4,
                    .section = Rectangle{.height = 0.01, .width = 0.01},
                    .material = Material{.density = 2000.0, .young = p[5], .poisson = 0.3},
                    .placement = Placement::at({0.3, 0, -0.1})};
      auto const beam = model.add(Ffr::from(bar, 1), "beam");
      auto const bob = model.add(Rigid<>(0.1, 0.1 * inertia, Placement::at({0.7, 0, -0.2})), "bob");
      model.connect(Turn{{.axis = Vec3(0, 1, 0.2).normalized()}, {}}, arm.at({0, 0, -0.1}), beam.at(0.0), "hinge");
      model.connect(Turn{{.axis = Vec3::UnitY()}, {}}, beam.at(0.4), bob.at({0, 0, 0.1}), "hook");
    }
    model.apply(SpringDamper{.stiffness = p[0], .damping = 1.0, .free_length = 0.4}, arm.at({-0.1, 0, 0.1}),
                slider.at({0, 0, 0}), "spring");
    State start = model.reference_state();
    start.v[3 * 6 + 1] = p[4];  // velocity of the tool, transverse to the arm
    start.v[0 * 6 + 4] = 0.5 * p[4];
    auto const tip = tool.at({0, 0, 0});
    auto const end = [tip](auto const& m, auto const& x) {
      auto const r = position(m, x, tip);
      auto sum = r[0] + 2.0 * r[1] - 0.5 * r[2];
      for (Index i = 0; i < x.v.size(); ++i) sum += 0.01 * double(i + 1) * x.v[i];
      return sum;
    };
    auto const way = [tip, mass = p[1]](auto const& m, auto const& x) {
      auto const r = position(m, x, tip);
      return mass * (r[0] * r[0] + r[2]);
    };
    std::vector<Output<M>> outputs{
        {"end [1]", end},
        {"way [1]", way},
        {"slider x [m]", [](M const&, State const& x) { return x.q[7]; }},
        {"force [10 N]", [wrist](M const& m, State const& x) { return 0.1 * reaction(m, x, wrist).f[2]; }},
        {"moment [N m]", [turn](M const& m, State const& x) { return reaction(m, x, turn).m[0]; }}};
    return with_objective(Scenario<M>{std::move(model), start, {.end_time = 0.1, .step = h}, std::move(outputs)}, end,
                          way);
  };
}
/// The parameters of `carried_arm`.
inline std::vector<Parameter> const parameters_of_carried_arm{{"stiffness [N/m]", 300.0}, {"mass [kg]", 0.8},
                                                              {"place [m]", 0.1},         {"gravity [m/s²]", 9.81},
                                                              {"speed [m/s]", 2.0},       {"young [Pa]", 1e9}};

}  // namespace polybody
