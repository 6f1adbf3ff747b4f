// Beads on flexible lines in the plane: motions with known solutions.

#include <gtest/gtest.h>

#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/bead_on_a_line.hpp"
#include "support/held.hpp"
#include "support/refusal.hpp"

using namespace polybody;

namespace sliding_bead_test {

constexpr double g = 9.81;

Bar const upright{.length = 2.0, .constants = BarConstants{.EA = 1e6, .EI = 1e3, .mass_per_length = 1e-6}};

Claim bead(char const* what, char const* source) {
  return {"sliders", what, By::closed_form, source, "planar AncfCable, generalised-α"};
}

// Bead on a straight vertical line under gravity: s = ½ g t², through every element.
TEST(BeadOnAStraightLine, FallsFreelyAlongIt) {
  BeadOnALine rig({g, 0, 0}, upright, 5, 3.0, 0.1);
  rig.pin_right({2.0, 0, 0});
  State x = rig.model.reference_state();
  simulate(rig.model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 0.6, .step = 1e-2}).run();
  Claim const fall = bead("place of a bead that falls along a line [m]", "½ g t²");
  held(fall, slider_position(rig.model, x, rig.line), 0.1 + 0.5 * g * 0.36, 1e-9, {"along the line"});
  held(fall, rig.place_of_bead(x)[0], 0.1 + 0.5 * g * 0.36, 1e-9, {"in space"});
  held_within(bead("force on a bead that falls along a line [N]", "0"), reaction(rig.model, x, rig.contact).f.norm(),
              1e-9, {.scale = 3.0 * g});
}

// The run ends when the bead reaches the end of the line: ½ g t² = 1.9. Without the event an error is thrown.
TEST(BeadOnAStraightLine, LeavesItsEnd) {
  BeadOnALine rig({g, 0, 0}, upright, 5, 3.0, 0.1);
  rig.pin_right({2.0, 0, 0});
  State x = rig.model.reference_state();
  auto run = simulate(rig.model, x, GeneralisedAlpha{.rho_inf = 0.8},
                      {.end_time = 2.0, .step = 1e-2, .events = {slider_end_event(rig.model, rig.line)}});
  run.run();
  ASSERT_TRUE(run.report().stopped);
  EXPECT_EQ(run.report().events.front().name, "slider 0 of \"line\" reaches an end");
  held(bead("time at which a bead reaches the end of its line [s]", "√(2 s/g)"), x.t, std::sqrt(2.0 * 1.9 / g), 1e-8);
  EXPECT_NEAR(slider_position(rig.model, x, rig.line), 2.0, 1e-7);
  State y = rig.model.reference_state();
  EXPECT_TRUE(has(message_of<SliderOutOfRange>([&] {
                    simulate(rig.model, y, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 2.0, .step = 1e-2}).run();
                  }),
                  "End the run at the ends of the body with slider_end_event"));
  EXPECT_GT(slider_position(rig.model, y, rig.line), 2.0);  // the last state within the line is kept
  EXPECT_LT(slider_position(rig.model, y, rig.line), 2.4);
}

// Bead on a stiff rod that rotates at ω: r̈ = ω² r, r = r₀ cosh ωt. The transverse force of the rod is 2 m ω ṙ.
TEST(BeadOnATurningRod, IsThrownOut) {
  double const omega = 3.0, r0 = 0.2, mass = 0.5, t = 0.7;
  BeadOnALine rig({}, {.length = 1.0, .constants = BarConstants{.EA = 1e9, .EI = 1e7, .mass_per_length = 0.1}}, 4, mass,
                  r0);
  rig.model.connect(BeadOnALine::Motor{{.law = {{.value = omega}}}, {}}, rig.model.ground().at({0, 0, 0}),
                    rig.line.at(0.0), "motor");
  State x = rig.model.reference_state();
  rig.model.set_velocity(x, rig.line, Vec3::Zero(), Vec3(0, 0, omega));
  rig.model.set_velocity(x, rig.bead, Vec3::Zero(), Vec3(0, 0, omega));
  simulate(rig.model, x, GeneralisedAlpha{.rho_inf = 0.5}, {.end_time = t, .step = 5e-4}).run();
  double const r = r0 * std::cosh(omega * t), rate = r0 * omega * std::sinh(omega * t);
  double const c = std::cos(omega * t), s = std::sin(omega * t);
  held(bead("place of a bead on a turning rod [m]", "r₀ cosh ωt"), slider_position(rig.model, x, rig.line), r, 2e-6);
  held_within(bead("place of a bead on a turning rod, in space [m]", "r₀ cosh ωt"),
              (rig.place_of_bead(x) - r * Vec3(c, s, 0)).norm(), 2e-6, {.scale = r});
  held_within(bead("push of a turning rod on its bead [N]", "2 m ω ṙ"),
              (reaction(rig.model, x, rig.contact).f - 2.0 * mass * omega * rate * Vec3(-s, c, 0)).norm(), 1e-3,
              {.scale = 2.0 * mass * omega * rate});
}

/// Mass M at x = v t on a simply supported Euler–Bernoulli beam, by modes φ_i = sin(iπx/L), w downwards. The beam
/// starts straight and at rest under its own weight. With μ = ½ ρA L and ω_i = (iπ/L)² √(EI/ρA)
///   μ (q̈_i + ω_i² q_i) = φ_i M (g − ẅ) + ρA g L (1 − cos iπ)/(iπ),  ẅ = Σ φ_j q̈_j + 2 v φ_j′ q̇_j + v² φ_j″ q_j
/// [Frýba 1999, ch. 1, with the inertia of the mass]. The Sherman–Morrison formula solves for q̈, and a Runge–Kutta
/// method integrates in time.
struct MovingMass {
  static constexpr int modes = 16;
  double length, bending, density, mass, v;
  using Modes = std::array<double, modes>;

  void accelerations(double t, Modes const& q, Modes const& qd, Modes& out) const {
    double const mu = 0.5 * density * length;
    double convective = 0.0, pushed = 0.0, squares = 0.0;
    Modes phi;
    for (std::size_t i = 0; i < modes; ++i) {
      double const k = double(i + 1) * std::numbers::pi / length;
      phi[i] = std::sin(k * v * t);
      convective += 2.0 * v * k * std::cos(k * v * t) * qd[i] - v * v * k * k * phi[i] * q[i];
    }
    for (std::size_t i = 0; i < modes; ++i) {
      double const n = double(i + 1) * std::numbers::pi, k = n / length;
      double const weight = density * g * length * (1.0 - std::cos(n)) / n,
                   elastic = mu * k * k * k * k * bending / density * q[i];
      out[i] = phi[i] * mass * (g - convective) + weight - elastic;
      pushed += phi[i] * out[i];
      squares += phi[i] * phi[i];
    }
    for (std::size_t i = 0; i < modes; ++i) out[i] = (out[i] - phi[i] * mass * pushed / (mu + mass * squares)) / mu;
  }
  /// Deflection under the mass at the end of each of n equal steps of h, each divided into `parts`.
  std::vector<double> deflections(double h, int n, int parts) const {
    Modes q{}, qd{};
    std::vector<double> out;
    double const dt = h / parts;
    for (int i = 0; i < n * parts; ++i) {
      Modes x[4], xd[4], a[4];
      for (int s = 0; s < 4; ++s) {
        double const c = s == 0 ? 0.0 : s == 3 ? 1.0 : 0.5;
        for (std::size_t j = 0; j < modes; ++j) {
          x[s][j] = s == 0 ? q[j] : q[j] + c * dt * xd[s - 1][j];
          xd[s][j] = s == 0 ? qd[j] : qd[j] + c * dt * a[s - 1][j];
        }
        accelerations((i + c) * dt, x[s], xd[s], a[s]);
      }
      double w = 0.0;
      for (std::size_t j = 0; j < modes; ++j) {
        q[j] += dt / 6.0 * (xd[0][j] + 2.0 * xd[1][j] + 2.0 * xd[2][j] + xd[3][j]);
        qd[j] += dt / 6.0 * (a[0][j] + 2.0 * a[1][j] + 2.0 * a[2][j] + a[3][j]);
        w += q[j] * std::sin(double(j + 1) * std::numbers::pi / length * v * (i + 1) * dt);
      }
      if ((i + 1) % parts == 0) out.push_back(w);
    }
    return out;
  }
};

// A mass of a quarter of the beam's mass crosses it in five of its periods. Deflections are 3e-5 of the span, so the
// mass keeps its velocity.
TEST(MovingMassOnABeam, BendsItAsTheModesSay) {
  MovingMass const exact{.length = 10.0, .bending = 2e8, .density = 20.0, .mass = 50.0, .v = 100.0};
  BeadOnALine rig({0, -g, 0},
                  {.length = exact.length,
                   .constants = BarConstants{.EA = 1e9, .EI = exact.bending, .mass_per_length = exact.density}},
                  16, exact.mass, 0.0);
  rig.pin_right({exact.length, 0, 0});
  State x = rig.model.reference_state();
  rig.model.set_velocity(x, rig.bead, Vec3(exact.v, 0, 0), Vec3::Zero());
  x.v[rig.line.body().column_of(Slider{})] = exact.v;
  double const h = 2e-5;
  int const n = 4800;
  std::vector<double> const expected = exact.deflections(h, n, 2);
  System system(rig.model);
  double const before = energy(rig.model, x).total();
  double worst = 0.0, largest = 0.0, change = 0.0;
  Violation open;
  int i = 0;
  auto run =
      simulate(rig.model, x, GeneralisedAlpha{.rho_inf = 0.9, .stabilised = true}, {.end_time = n * h, .step = h});
  for (State const& now : run) {
    if (i > 0) {
      worst = std::max(worst, std::abs(-rig.place_of_bead(now)[1] - expected[std::size_t(i - 1)]));
      largest = std::max(largest, std::abs(expected[std::size_t(i - 1)]));
    }
    if (i++ % 100 != 0) continue;
    Violation const v = largest_violation(system, now);
    open.position = std::max(open.position, v.position);
    open.velocity = std::max(open.velocity, v.velocity);
    open.acceleration = std::max(open.acceleration, v.acceleration);
    change = std::max(change, std::abs(energy(system, now).total() - before));
  }
  EXPECT_GT(largest, 1e-4);
  held_within(
      {"sliders", "deflection under a mass that crosses a beam, of the largest", By::independent,
       "Frýba's equations of 16 modes, Runge–Kutta", "planar AncfCable, 16 elements, generalised-α, stabilised"},
      worst / largest, 1e-3, {.scale = 1.0});
  EXPECT_LT(open.position, 1e-11);
  EXPECT_LT(open.velocity, 1e-9);
  held_within({"sliders", "change of energy while a mass crosses a beam, of m g times the largest deflection",
               By::closed_form, "invariant", "planar AncfCable, 16 elements, generalised-α, stabilised"},
              change / (exact.mass * g * largest), 1e-3, {.scale = 1.0});
}

}  // namespace sliding_bead_test
