// Double pendulum of two point masses in its slower mode of small swings.
#include "mechanism.hpp"
using namespace polybody;

int main() {
  using Pin = Joint<planar::Revolute, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Pin>> model{Gravity{0, -9.81, 0}};
  auto const upper = model.add(planar::Rigid(1.0, 0.0, Placement::planar(0, -1)), "upper");
  auto const lower = model.add(planar::Rigid(1.0, 0.0, Placement::planar(0, -2)), "lower");
  model.connect(Pin{}, model.ground().at({0, 0, 0}), upper.at(Vec2(0, 1)), "hook");
  model.connect(Pin{}, upper.centre(), lower.at(Vec2(0, 1)), "elbow");

  // In the slower mode the angles have the ratio 1 : √2 and ω² = (2 − √2) g/l.
  double const omega = std::sqrt((2.0 - std::sqrt(2.0)) * 9.81), swing = 1e-3;
  State x = model.reference_state();
  model.set_velocity(x, upper, {0, 0, 0}, {0, 0, swing});
  model.set_velocity(x, lower, {swing * (1.0 - std::sqrt(2.0)), 0, 0}, {0, 0, std::sqrt(2.0) * swing});
  mechanism::Picture picture("Double pendulum, swings enlarged", 0, 1);
  double before = 0.0, zero = 0.0, t = 0.0;
  for (auto const& now : simulate(model, x, Radau{}, {.end_time = 2.0, .step = 0.01})) {
    double const at = now.position(upper.centre())[0];
    if (before > 0.0 && at <= 0.0) zero = t + (now.t - t) * before / (before - at);  // half a period
    if (std::fmod(now.t + 1e-6, 0.25) < 0.01) {
      double const scale = 1e3;
      Vec3 a = now.position(upper.centre()), b = now.position(lower.centre());
      a[0] *= scale, b[0] *= scale;
      picture.line({Vec3(0, 0, 0), a, b}, 0, now.t, 2);
    }
    before = at;
    t = now.t;
  }
  picture.write("double_pendulum");
  return mechanism::compare("angular frequency [rad/s]", std::acos(-1.0) / zero, omega, 1e-3);
}
