// Lesson: the body formulation is one template argument. A moderately flexible pendulum as a rigid rod, as an ANCF
// cable and as a large-rotation-vector beam, all from one Bar. Sample run:
//   rigid  tip at 0.5 s: (-0.0902, -0.9959)
//   ANCF   tip at 0.5 s: (-0.0934, -0.9957)
//   LRVF   tip at 0.5 s: (-0.0934, -0.9957)
#include <polybody/polybody.hpp>

#include <cstdio>
using namespace polybody;

// 1. The physics: case D6b of docs/cases.md.
Bar const bar{.length = 1.0,
              .constants = BarConstants{
                  .EA = 1.5e5, .EI = 5.0, .mass_per_length = 1.0, .GA = 4.807692e4, .rotary_inertia = 3.3333333e-5}};

// 2. The mechanism, for any body.
template <class B>
Vec3 tip_at_half_a_second(B const& body) {
  using Pin = Joint<planar::Revolute, Constraint>;
  Model<Bodies<B>, Joints<Pin>> model{Gravity{0, -9.81, 0}};
  auto const rod = model.add(body, "rod");
  model.connect(Pin{}, model.ground().at({0, 0, 0}), rod.at(0.0), "pin");
  State x = model.reference_state();
  simulate(model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 0.5, .step = 1e-3}).run();
  return position(model, x, rod.at(1.0));  // at(s) is the same material point in all formulations
}

int main() {
  // 3. The body formulations.
  Vec3 const rigid = tip_at_half_a_second(planar::Rigid::from(bar));
  Vec3 const ancf = tip_at_half_a_second(planar::AncfCable<>::from(bar, 8));
  Vec3 const lrvf = tip_at_half_a_second(planar::Lrvf::from(bar, 32));
  std::printf("rigid  tip at 0.5 s: (%.4f, %.4f)\n", rigid[0], rigid[1]);
  std::printf("ANCF   tip at 0.5 s: (%.4f, %.4f)\n", ancf[0], ancf[1]);
  std::printf("LRVF   tip at 0.5 s: (%.4f, %.4f)\n", lrvf[0], lrvf[1]);
  // 4. References: the converged flexible solution (-0.0933, -0.9957), and the rigid solution.
  Vec3 const flexible(-0.093346, -0.995676, 0.0), stiff(-0.090229, -0.995921, 0.0);
  bool const good = (ancf - flexible).norm() < 5e-4 && (lrvf - flexible).norm() < 5e-4 && (rigid - stiff).norm() < 5e-4;
  return good ? 0 : 1;
}
