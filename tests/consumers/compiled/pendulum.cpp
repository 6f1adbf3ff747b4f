// A program that links polybody::compiled: runs with an implicit and an explicit integrator, and in joint
// coordinates.
#ifdef INCLUDE_COMPILED
#include <polybody/compiled.hpp>
#else
#include <polybody/polybody.hpp>
#endif

#include <cmath>
#include <cstdio>
using namespace polybody;

// Displacement of the tip of a rod of 1 m, 0.3 s after a horizontal release.
template <class Policy, class I>
double drop(Policy policy, I integrator) {
  using Pin = Joint<Revolute, Policy>;
  Model<Bodies<Rigid<>>, Joints<Pin>> model{Gravity{0, 0, -9.81}};
  Mat3 inertia = Mat3::Zero();
  inertia(1, 1) = inertia(2, 2) = 1.0 / 12.0;
  auto const rod = model.add(Rigid<>{1.0, inertia, Placement::at({0.5, 0, 0})}, "rod");
  model.connect(Pin{Revolute{.axis = Vec3::UnitY()}, policy}, model.ground().at({0, 0, 0}), rod.at(Vec3(-0.5, 0, 0)));
  State x = model.reference_state();
  simulate(model, x, integrator, {.end_time = 0.3, .step = 1e-3}).run();
  return -position(model, x, rod.at(Vec3(0.5, 0, 0)))[2];
}

int main() {
  double const implicit = drop(Constraint{}, GeneralisedAlpha{}),
               stages = drop(Constraint{}, RungeKutta4<Projection>{});
  double const joint = drop(JointCoordinates{}, GeneralisedAlpha{});
  // θ¨ = 1.5 g cos θ from rest, by a series in t²: θ = w t²/2 − w³ t⁶/240 + …, w = 1.5 g
  double const w = 1.5 * 9.81, t2 = 0.09;
  double const theta = w * t2 / 2 - std::pow(w * t2, 3) / 240.0;
  std::printf("the tip fell %.6f, %.6f, %.6f m; series %.6f m\n", implicit, stages, joint, std::sin(theta));
  bool const alike = std::abs(implicit - stages) < 1e-5 && std::abs(joint - stages) < 1e-5;
  return alike && std::abs(stages - std::sin(theta)) < 5e-4 ? 0 : 1;
}
