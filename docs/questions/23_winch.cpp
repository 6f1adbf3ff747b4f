// title: Payload on a winch
// thread: https://github.com/google-deepmind/mujoco/issues/1704
// words: cable of variable length, crane, hoist, tension only, slack rope, tendon, unilateral spring
// wanted: A cable on a winch carries a payload, and does not push. Its natural length changes during the
//     simulation.
// inputs: 10 kg, EA = 1e4 N, 200 N s/m, free length 5 m. The winch reels 2 m within 4 s. A second winch unreels
//     7.5 t² m, faster than free fall, from a cable without tension.
// right: A cable with the free length L carries m g at the length L (1 + m g/EA). A slack cable has no tension, so
//     the second payload falls by g t²/2.
#include <polybody/parts.hpp>
#include <polybody/polybody.hpp>

#include "answer.hpp"
using namespace polybody;

struct PayOut {
  Motion operator()(double t) const { return {-7.5 * t * t, -15.0 * t, -15.0}; }
};

int main() {
  using Hoist = OnDistance<Winch<SmoothRamp>>;
  using Drop = OnDistance<Winch<PayOut>>;
  Model<Bodies<Rigid<>>, Joints<>, Forces<Hoist, Drop>> model{Gravity{0, 0, -9.81}};
  double const m = 10.0, EA = 1e4, L = 5.0, stretch = 1.0 + m * 9.81 / EA;
  auto const payload = [&](Vec3 const& at) { return model.add(Rigid<>(m, 0.1 * Mat3::Identity(), Placement::at(at))); };
  auto const raised = payload({0, 0, -L * stretch}), dropped = payload({2, 0, -L});
  auto const hoist = model.apply(Hoist{{.axial_stiffness = EA, .damping = 200.0, .length = L, .reeled = {2.0, 4.0}}},
                                 model.ground().at({0, 0, 0}), raised.centre(), "hoist");
  auto const drop = model.apply(Drop{{.axial_stiffness = EA, .damping = 200.0, .length = L, .reeled = {}}},
                                model.ground().at({2, 0, 0}), dropped.centre(), "drop");
  State x = model.reference_state();
  simulate(model, x, Radau{}, {.end_time = 1.0, .step = 1e-3}).run();
  answer("tension of the slack cable at 1 s [N]", 0.0, applied_wrenches(model, x, drop)[1].f.norm(), 0.0);
  answer("fall within 1 s [m]", 0.5 * 9.81, -L - position(model, x, dropped.centre())[2], 1e-9);
  simulate(model, x, Radau{}, {.end_time = 8.0, .step = 1e-3}).run();
  answer("height of the raised payload [m]", -(L - 2.0) * stretch, position(model, x, raised.centre())[2], 1e-8);
  answer("tension of its cable [N]", m * 9.81, applied_wrenches(model, x, hoist)[1].f.norm(), 1e-6);
  return wrong_answers();
}
