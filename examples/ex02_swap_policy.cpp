// Lesson: the joint policy is one template argument. One pendulum with an ideal pin (multipliers) and with a stiff pin
// (penalty). Sample run:
//   Constraint: reaction at the lowest point 24.525 N, gap 0.000e+00 m
//   Penalty:    reaction at the lowest point 24.525 N, gap 2.452e-06 m
#include <polybody/polybody.hpp>

#include <cstdio>
using namespace polybody;

struct Result {
  double reaction, gap;
};

// 1. Everything that does not depend on the policy is written once.
template <class P>
Result swing(P policy) {
  using Hinge = Joint<planar::Revolute, P>;
  Model<Bodies<planar::Rigid>, Joints<Hinge>> model{Gravity{0, -9.81, 0}};
  auto const rod = model.add(
      planar::Rigid::from({.length = 1.0, .constants = BarConstants{.EA = 1e7, .EI = 1e3, .mass_per_length = 1.0}}),
      "rod");
  auto const pin = model.connect(Hinge{{}, policy}, model.ground().at({0, 0, 0}), rod.at(0.0), "pin");
  State x = model.reference_state();
  // 2. The rod is released from the horizontal. The run ends at the time at which the rod hangs vertically.
  RunOptions options{.end_time = 2.0, .step = 5e-4};
  options.events.push_back({.name = "lowest point",
                            .value = [&](State const& s) { return position(model, s, rod.at(1.0))[0]; },
                            .terminal = true});
  simulate(model, x, GeneralisedAlpha{.rho_inf = 0.9}, options).run();
  return {reaction(model, x, pin).f[1], constraint_violation(model, x, pin).norm()};
}

int main() {
  Result const ideal = swing(Constraint{});
  Result const stiff = swing(Penalty{.stiffness = 1e7, .damping = 1e3});  // a penalty has no default parameters
  std::printf("Constraint: reaction at the lowest point %.3f N, gap %.3e m\n", ideal.reaction, ideal.gap);
  std::printf("Penalty:    reaction at the lowest point %.3f N, gap %.3e m\n", stiff.reaction, stiff.gap);
  // 3. Theory: reaction 5/2 m g at the lowest point, and constraint violation F/k of the penalty with the reaction F.
  bool const good = std::abs(ideal.reaction - 24.525) < 0.01 && std::abs(stiff.reaction - 24.525) < 0.05 &&
                    ideal.gap < 1e-9 && std::abs(stiff.gap - 24.525 / 1e7) < 1e-8;
  return good ? 0 : 1;
}
