// title: Free rotation of a rigid body
// thread: https://github.com/avianphysics/avian/pull/993
// words: gyroscopic torque, Euler equations, intermediate axis, tennis racket, Dzhanibekov, energy drift
// wanted: A free body rotates about its axis of largest inertia, which is stable. Its energy grew until it rotated
//     about the axis of middle inertia.
// inputs: Moments of inertia 0.1, 0.2 and 0.3 kg m², angular velocity (0.2, 0.1, 10) rad/s in body axes, no
//     forces.
// right: DOP853 of SciPy at a tolerance of 1e-13. Energy ½ Σ J ω² = 15.003 J, angular momentum 3.0001333304 N m s;
//     both are constant. About the middle axis this angular momentum has 22.5 J.
#include <polybody/polybody.hpp>

#include "answer.hpp"
using namespace polybody;

int main() {
  Model<Bodies<Rigid<>>, Joints<>> model;
  Vec3 const inertia(0.1, 0.2, 0.3);
  auto const top = model.add(Rigid<>(1.0, inertia.asDiagonal().toDenseMatrix()), "top");
  State start = model.reference_state();
  model.set_velocity(start, top, {0, 0, 0}, {0.2, 0.1, 10});
  auto const spin = [&](State const& x) {  // in body axes
    Frame<double> const f = frame(model, x, top.centre());
    return Vec3(f.A.transpose() * f.w);
  };
  State x = start;
  simulate(model, x, DormandPrince<>{.relative_tolerance = 1e-10, .absolute_tolerance = 1e-12},
           {.end_time = 100.0, .step = 1e-3})
      .run();
  answer("ω₁ at 100 s, Dormand–Prince [rad/s]", 0.03532092, spin(x)[0], 1e-6);
  answer("ω₂ at 100 s, Dormand–Prince [rad/s]", 0.22079953, spin(x)[1], 1e-6);
  answer("ω₃ at 100 s, Dormand–Prince [rad/s]", 9.99935411, spin(x)[2], 1e-7);
  auto const energy_after = [&](auto const& method) {
    State y = start;
    simulate(model, y, method, {.end_time = 100.0, .step = 0.01}).run();
    return energy(model, y).kinetic;
  };
  answer("energy after 1e4 steps, Rattle [J]", 15.003, energy_after(Rattle{}), 1e-8);
  answer("energy after 1e4 steps, generalised-α [J]", 15.003, energy_after(GeneralisedAlpha{}), 0.015);
  answer("energy after 1e4 steps, Runge–Kutta [J]", 15.003, energy_after(RungeKutta4<>{}), 0.015);
  answer("angular momentum after 100 s [N m s]", 3.0001333304, inertia.cwiseProduct(spin(x)).norm(), 1e-7);
  return wrong_answers();
}
