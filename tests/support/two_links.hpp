#pragma once
// Two links with any body type on pins of any policy: a scenario for differentiated runs.

#include <span>

#include <polybody/compare/compare.hpp>
#include <polybody/gradients/parameter.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/policies/penalty.hpp>
#include <polybody/joints/standard_joints.hpp>

namespace polybody {

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

/// A run of two links, and the end of the second one.
template <class M, class B>
struct RunOfTwoLinks : Scenario<M> {
  Marker<B> tip;
};

/// Two links of soft rods, the second transverse to the first, that fall about pins which are not parallel.
/// Parameters: Young's modulus, density, stiffness of the pins, length of the second link, initial speed.
template <class B, class Policy>
auto const two_links = [](std::span<double const> p) {
  constexpr bool knows_frames = B::observes == MarkerKind::frame;
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
  System const system(model, with<Capabilities::rigid_velocities>);
  system.operations().rigid_velocities(start.q, Vec3::Zero(), {0, p[4], 0}, start.v);
  double const end = p[3];
  std::vector<Output<M>> outputs{
      {"tip x [m]", [second, end](M const& m, State const& x) { return position(m, x, second.at(end))[0]; }},
      {"tip y [m]", [second, end](M const& m, State const& x) { return position(m, x, second.at(end))[1]; }},
      {"tip z [m]", [second, end](M const& m, State const& x) { return position(m, x, second.at(end))[2]; }}};
  return RunOfTwoLinks<M, B>{{std::move(model), start, {.end_time = 0.06, .step = 2e-3}, std::move(outputs)},
                             second.at(end)};
};
/// The parameters of `two_links`.
inline std::vector<Parameter> const parameters_of_two_links{{"young [Pa]", 2e8},
                                                            {"density [kg/m³]", 2000.0},
                                                            {"stiffness of pins [N/m]", 1e6},
                                                            {"length [m]", 0.4},
                                                            {"spin [rad/s]", 2.0}};

}  // namespace polybody
