// Dzhanibekov's nut: a free body that spins about its middle axis turns over. The period follows from an elliptic
// integral.
#include "mechanism.hpp"
using namespace polybody;

int main() {
  Model<Bodies<Rigid<>>, Joints<>> model;
  Mat3 inertia = Mat3::Identity();
  inertia(1, 1) = 2.0, inertia(2, 2) = 3.0;
  auto const nut = model.add(Rigid<>(1.0, inertia), "nut");
  State x = model.reference_state();
  double const spin = 6.0, off = 1e-3;
  model.set_velocity(x, nut, {0, 0, 0}, {off, spin, 0});

  Figure figure{.title = "Angular velocity about the middle axis",
                .x_label = "t [s]",
                .y_label = "angular velocity [rad/s]",
                .legend = false};
  figure.y_range = {-7.0, 7.0};
  figure.curves.push_back({});
  double before = spin, t = 0.0, first = 0.0, second = 0.0;
  for (auto const& now : simulate(model, x, Radau{}, {.end_time = 16.0, .step = 0.01})) {
    Frame<double> const f = now.frame(nut.centre());
    double const middle = f.A.col(1).dot(f.w);
    if (before * middle < 0.0 && second == 0.0)
      (first == 0.0 ? first : second) = t + (now.t - t) * before / (before - middle);
    figure.curves[0].x.push_back(now.t), figure.curves[0].y.push_back(middle);
    before = middle;
    t = now.t;
  }
  std::filesystem::create_directories("out/mechanisms");
  write_figure(figure, "out/mechanisms/dzhanibekov");
  // Landau & Lifshitz, Mechanics, §37: with E the energy and M the momentum, for M² > 2 E I₂,
  // half a period is 2 K(k) √(I₁ I₂ I₃/((I₃ − I₂)(M² − 2 E I₁))), k² = (I₂ − I₁)(2 E I₃ − M²)/((I₃ − I₂)(M² − 2 E I₁));
  // for M² < 2 E I₂ the indices 1 and 3 are exchanged.
  double const E2 = off * off + 2.0 * spin * spin, M2 = off * off + 4.0 * spin * spin;  // M² < 2 E I₂
  double const down = (2.0 - 1.0) * (E2 * 3.0 - M2), up = (3.0 - 2.0) * (M2 - E2 * 1.0);
  double const k = std::sqrt(up / down), known = 2.0 * std::comp_ellint_1(k) * std::sqrt(6.0 / down);
  return mechanism::compare("time between two flips [s]", second - first, known, 2e-3);
}
