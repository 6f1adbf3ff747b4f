// User-defined types, combined with each other and with those of the library, against closed forms and balances.
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <numbers>
#include <string>

#include "bathe.hpp"
#include "double_pendulum.hpp"
#include "dumbbell.hpp"
#include "hardening_penalty.hpp"
#include "lennard_jones.hpp"
#include "point_on_parabola.hpp"

extern template struct polybody::BodyKernels<own::Dumbbell, double>;  // compiled in dumbbell.cpp

namespace own {
namespace {

/// Prints the errors, and counts those above their tolerance.
class Checks {
 public:
  void small(std::string const& what, double error, double tolerance) {
    bool const good = std::abs(error) <= tolerance;  // false for a NaN
    std::cout << (good ? "good  " : "WRONG ") << what << ": " << error << " (at most " << tolerance << ")" << std::endl;
    failures_ += good ? 0 : 1;
  }
  int failures() const { return failures_; }

 private:
  int failures_ = 0;
};

/// Two molecules in free flight, and a rigid body that hangs on one by a joint of the library: user-defined body,
/// force and integrator. E, p and the angular momentum are constant.
void molecules(Checks& checks) {
  using Ball = Joint<Spherical, Constraint>;
  Model<Bodies<Dumbbell, Rigid<>>, Joints<Ball>, Forces<LennardJones>> model;
  Dumbbell::Parameters near{
      .mass_1 = 1.0, .mass_2 = 1.5, .stiffness = 400.0, .r_1 = Vec3(0, 0, 0), .r_2 = Vec3(0, 0, 1)};
  Dumbbell::Parameters far = near;
  far.r_1 = Vec3(1.2, 0.1, 0);
  far.r_2 = Vec3(1.2, -0.1, 1.2);
  auto const a = model.add(Dumbbell(near), "a"), b = model.add(Dumbbell(far), "b");
  auto const rider = model.add(
      Rigid<>(0.7, Vec3(0.02, 0.03, 0.04).asDiagonal().toDenseMatrix(), Placement::at({0.0, -0.3, 0.0})), "rider");
  for (int i : {1, 2})
    for (int j : {1, 2}) model.apply(LennardJones{.depth = 0.5, .diameter = 1.0}, a.at(i), b.at(j));
  model.connect(Ball{}, a.at(1), rider.at(Vec3(0.0, 0.3, 0.0)), "seat");
  State x = model.reference_state();
  model.set_velocity(x, a, {0.2, 0.0, 0.1}, {0.3, 0.1, -0.2});
  model.set_velocity(x, b, {-0.2, 0.1, 0.0}, {0.0, 0.2, 0.1});
  model.set_velocity(x, rider, {0.2, 0.0, 0.1}, {0.3, 0.1, -0.2});
  Momentum const before = momentum(model, x);
  double const start = energy(model, x).total();
  double const bound = energy(model, x).forces;
  simulate(model, x, Bathe{}, {.end_time = 1.0, .step = 2e-3}).run();
  Momentum const after = momentum(model, x);
  checks.small("molecules: energy", (energy(model, x).total() - start) / std::abs(bound), 1e-6);
  checks.small("molecules: momentum", (after.linear - before.linear).norm(), 1e-9);
  checks.small("molecules: angular momentum", (after.angular - before.angular).norm(), 1e-6);
}

/// A bead on the wire z = x²/4f: the user-defined joint with constraint equations of the library, and with the
/// user-defined policy.
template <class Policy>
double bead(Policy const& policy, double x0, double end_time, double* energy_change = nullptr) {
  using Wire = Joint<PointOnParabola, Policy>;
  double const f = 0.5;
  Model<Bodies<Rigid<>>, Joints<Wire>> model{Gravity{0, 0, -9.81}};
  auto const mass = model.add(Rigid<>(2.0, Mat3::Identity(), Placement::at({x0, 0.0, x0 * x0 / (4.0 * f)})), "bead");
  model.connect(Wire{PointOnParabola{.focal_length = f}, policy}, model.ground().at({0, 0, 0}), mass.at({0, 0, 0}));
  State x = model.reference_state();
  double const start = energy(model, x).total();
  simulate(model, x, Bathe{}, {.end_time = end_time, .step = 1e-3}).run();
  if (energy_change) *energy_change = energy(model, x).total() - start;
  return x.q[0];
}

void wire(Checks& checks) {
  double const x0 = 0.01, omega = std::sqrt(9.81);  // √(g/2f) with f = ½
  // x = x₀ cos ωt up to terms of x₀³
  checks.small("wire: small swing", bead(Constraint{}, x0, 2.0) - x0 * std::cos(2.0 * omega), 1e-6);
  double change = 0.0;
  double const rigid = bead(Constraint{}, 0.8, 1.5, &change);
  checks.small("wire: energy of a large swing", change / (2.0 * 9.81 * 0.32), 1e-5);
  double const soft = bead(HardeningPenalty{.stiffness = 2e5, .hardening = 1e9, .damping = 200.0}, 0.8, 1.5);
  checks.small("wire: stiff mount against rows", soft - rigid, 1e-3);
}

/// A weight on a hardening mount is in equilibrium at k g + κ g³ = m g.
void mount(Checks& checks) {
  using Mount = Joint<Weld, HardeningPenalty>;
  Model<Bodies<Rigid<>>, Joints<Mount>> model{Gravity{0, 0, -9.81}};
  auto const block = model.add(Rigid<>(3.0, Mat3::Identity()), "block");
  HardeningPenalty const rubber{.stiffness = 300.0, .hardening = 4e4, .damping = 0.0};
  model.connect(Mount{Weld{}, rubber}, model.ground().at({0, 0, 0}), block.at(Vec3(0, 0, 0)));
  State x = model.reference_state();
  equilibrium(model, x);
  double const sag = -x.q[2], weight = 3.0 * 9.81;
  checks.small("mount: balance of the sag", sag * (300.0 + 4e4 * sag * sag) - weight, 1e-8 * weight);
}

/// A run of one second of a system with steps of one millisecond.
template <class I>
State after_a_second(System& system, State x, I const& integrator) {
  auto const method = method_of(integrator);
  auto workspace = method.template workspace<DefaultSolver>(system);
  method.start(system, x, 1e-3, workspace);
  for (int i = 0; i < 1000; ++i) method.step(system, x, 1e-3, workspace);
  return x;
}

/// The user-defined equations under the user-defined integrator and those of the library, and as bodies and joints of
/// the library.
void pendulum(Checks& checks) {
  DoublePendulum const equations{.mass_1 = 2.0, .mass_2 = 1.0, .length_1 = 0.8, .length_2 = 0.5, .g = 9.81};
  VecX const start = Vec2(1.2, -0.4), none = VecX::Zero(2);
  System system = system_of(equations, "double pendulum");
  State const at_rest{start, none, none, VecX(), 0.0, {}};
  State const x = after_a_second(system, at_rest, Bathe{});
  double const drift = equations.energy(x.q, x.v) - equations.energy(start, none);
  checks.small("pendulum: energy of the equations", drift / (2.0 * 9.81 * 0.8), 1e-5);
  State const fourth_order = after_a_second(system, at_rest, RungeKutta4<>{});
  checks.small("pendulum: equations under RungeKutta4", (fourth_order.q - x.q).norm(), 1e-4);

  using Pin = Joint<planar::Revolute, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Pin>> model{Gravity{0, -9.81, 0}};
  auto const rod = [&](double mass, double length, Vec2 const& from, double angle) {
    double const direction = angle - 0.5 * std::numbers::pi;  // direction of a hanging rod
    Vec2 const middle = from + 0.5 * length * Vec2(std::cos(direction), std::sin(direction));
    return model.add(
        planar::Rigid(mass, mass * length * length / 12.0, Placement::planar(middle.x(), middle.y(), direction)));
  };
  Vec2 const elbow = 0.8 * Vec2(std::sin(start[0]), -std::cos(start[0]));
  auto const upper = rod(2.0, 0.8, Vec2::Zero(), start[0]), lower = rod(1.0, 0.5, elbow, start[1]);
  model.connect(Pin{}, model.ground().at({0, 0, 0}), upper.at(Vec2(-0.4, 0.0)));
  model.connect(Pin{}, upper.at(Vec2(0.4, 0.0)), lower.at(Vec2(-0.25, 0.0)));
  State bodies = model.reference_state();
  simulate(model, bodies, Bathe{}, {.end_time = 1.0, .step = 1e-3}).run();
  checks.small("pendulum: first angle", bodies.q[2] + 0.5 * std::numbers::pi - x.q[0], 1e-4);
  checks.small("pendulum: second angle", bodies.q[5] + 0.5 * std::numbers::pi - x.q[1], 1e-4);
}

}  // namespace
}  // namespace own

int main() {
  own::Checks checks;
  own::molecules(checks);
  own::wire(checks);
  own::mount(checks);
  own::pendulum(checks);
  return checks.failures() == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
