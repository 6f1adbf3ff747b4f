// Lesson: the integrator is one argument. One double pendulum with an implicit method and with explicit methods that
// are stabilised by projection. Sample run:
//   GeneralisedAlpha     2000 steps   tip (-1.4448, -1.3218)   energy error 3e-05 J
//   ...
#include <polybody/polybody.hpp>

#include <cstdio>
using namespace polybody;

// 1. Two point masses of 1 kg on massless rods of 1 m, both horizontal at rest.
template <class I>
bool run(I const& integrator, double step) {
  using Pin = Joint<planar::Revolute, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Pin>> model{Gravity{0, -9.81, 0}};
  auto const first = model.add(planar::Rigid{1.0, 0.0, Placement::planar(1.0, 0.0)}, "first mass");
  auto const second = model.add(planar::Rigid{1.0, 0.0, Placement::planar(2.0, 0.0)}, "second mass");
  model.connect(Pin{}, model.ground().at({0, 0, 0}), first.at({-1.0, 0.0}), "upper pin");
  model.connect(Pin{}, first.at({0.0, 0.0}), second.at({-1.0, 0.0}), "lower pin");
  State x = model.reference_state();
  // 2. An explicit integrator without stabilisation, RungeKutta4<>, would not compile here, because the pins add
  // constraint equations.
  auto simulation = simulate(model, x, integrator, {.end_time = 1.0, .step = step});
  RunReport const& report = simulation.run();
  Vec3 const tip = position(model, x, second.at({0.0, 0.0}));
  double const drift = energy(model, x).total();
  std::printf("%-18s %6ld steps   tip (%.5f, %.5f)   energy error %8.1e J\n", I::name, report.steps, tip[0], tip[1],
              drift);
  // 3. Reference: an independent solution with tolerance 1e-13.
  return (tip - Vec3(-1.444818849943, -1.321794461381, 0.0)).norm() < 2e-4;
}

int main() {
  bool good = run(GeneralisedAlpha{.rho_inf = 1.0}, 5e-4);
  good = run(RungeKutta4<Projection>{}, 5e-3) && good;
  good = run(DormandPrince<Projection>{}, 1e-2) && good;
  good = run(CentralDifference<Projection>{}, 5e-4) && good;
  return good ? 0 : 1;
}
