// Equilibrium of weights that slide on flexible lines.

#include <gtest/gtest.h>

#include <polybody/statics/equilibrium.hpp>

#include "support/bead_on_a_line.hpp"
#include "support/held.hpp"

using namespace polybody;

namespace sliding_statics_test {

constexpr double g = 9.81;

// Cable under tension T with bending stiffness, pinned at both ends, with a sliding weight P. The equilibrium is in
// the middle:
//   w = P L/(4 T) (1 − tanh u/u),  u = ½ L √(T/EI)      [Timoshenko & Gere 1961, §1.11; for small deflections].
TEST(BeadOnATautCable, ComesToTheMiddle) {
  double const length = 2.0, tension = 1e5, mass = 0.5, u = 6.0, bending = tension * length * length / (4.0 * u * u);
  BeadOnALine rig({0, -g, 0},
                  {.length = length,
                   .constants = BarConstants{.EA = 1e7, .EI = bending, .mass_per_length = 1e-9},
                   .pretension = tension},
                  24, mass, 0.77);
  rig.pin_right({length, 0, 0});
  State x = rig.resting(mass * g);
  equilibrium(rig.model, x);
  double const w = mass * g * length / (4.0 * tension) * (1.0 - std::tanh(u) / u);
  auto const claim = [](char const* what, char const* source) {
    return Claim{"sliders", what, By::closed_form, source, "planar AncfCable, 24 elements"};
  };
  held(claim("place of a weight on a taut cable [m]", "the middle"), slider_position(rig.model, x, rig.line),
       0.5 * length, 1e-6);
  held(claim("deflection of a taut cable under a weight [m]", "P L/4T (1 − tanh u/u), u = ½ L √(T/EI)"),
       -rig.place_of_bead(x)[1], w, 1e-4 * w);
  held_within(claim("force of a taut cable on its weight [N]", "m g"),
              (reaction(rig.model, x, rig.contact).f - Vec3(0, mass * g, 0)).norm(), 1e-7, {.scale = mass * g});
}

// Rope with a heavy bead between pins at the horizontal distance D and the height difference H. Its tension is equal
// on both sides of the bead, and both sides have the same angle φ to the vertical: W = 2 T cos φ, D = L(1 + T/EA) sin
// φ. Bending stiffness rounds the bend over √(EI/T), which must be as long as an element. On a coarser mesh the bead
// has an equilibrium in each element. Each pin carries half of the weight for every EI. The balance of the reactions
// is exact on any mesh.
TEST(BeadOnARope, HangsWhereBothSidesAreEquallySteep) {
  double const D = 1.0, H = 0.25, length = std::hypot(D, H), EA = 60.0, W = 20.0;
  double t = W, phi = 0.0;
  for (int i = 0; i < 200; ++i) {
    phi = std::asin(D / (length * (1.0 + t / EA)));
    t = 0.5 * (t + 0.5 * W / std::cos(phi));
  }
  // the sides a + b = D/sin φ, (a − b) cos φ = H: the shorter side gives the depth below the first pin
  double const depth = 0.5 * (D / std::sin(phi) - H / std::cos(phi)) * std::cos(phi), aside = depth * std::tan(phi);
  Bar const rope{.length = length,
                 .constants = BarConstants{.EA = EA, .EI = 0.02, .mass_per_length = 1e-9},
                 .placement = Placement::planar(0, 0, std::atan2(H, D))};
  double const from_left = depth / std::cos(phi) / (1.0 + t / EA);  // of the unloaded rope
  // the bead is fixed to the rope near its equilibrium, then released
  BeadOnALine tied({0, -g, 0}, rope, 60, W / g, from_left + 0.02, false),
      rig({0, -g, 0}, rope, 60, W / g, from_left + 0.02);
  tied.pin_right({D, H, 0});
  auto const right = rig.pin_right({D, H, 0});
  State before = tied.resting(W), x = rig.resting(W);
  equilibrium(tied.model, before, {.load_steps = 10});
  x.q << before.q.head(before.q.size() - 3), from_left + 0.02, before.q.tail<3>();
  x.lambda = before.lambda;
  equilibrium(rig.model, x);
  double const s = slider_position(rig.model, x, rig.line);
  Vec3 const bead = rig.place_of_bead(x);
  Wrench<double> const a = reaction(rig.model, x, rig.left), b = reaction(rig.model, x, right);
  auto const claim = [](char const* what, char const* source) {
    return Claim{"sliders", what, By::closed_form, source, "planar AncfCable, 60 elements"};
  };
  held_within(claim("force of a rope on its bead [N]", "W"),
              (reaction(rig.model, x, rig.contact).f - Vec3(0, W, 0)).norm(), 1e-6, {.scale = W});
  held_within(claim("forces of the pins of a rope with a bead, together [N]", "W"), (a.f + b.f - Vec3(0, W, 0)).norm(),
              1e-6, {.scale = W});
  held_within(claim("moment of the right pin's force less the bead's [N m]", "0"),
              std::abs(D * b.f[1] - H * b.f[0] - W * bead[0]), 1e-6, {.scale = W});
  Claim const half = claim("forces of the pins of a rope with a bead, upwards [N]", "½ W each");
  held(half, a.f[1], 0.5 * W, 2e-3 * W, {"left"});
  held(half, b.f[1], 0.5 * W, 2e-3 * W, {"right"});
  char const* const steep = "both sides equally steep, without bending";
  held_within(claim("place of a bead on a rope [m]", steep), (bead - Vec3(aside, -depth, 0)).norm(), 0.03,
              {.scale = std::hypot(aside, depth)});  // of the order of √(EI/T)
  held(claim("pull of a rope with a bead [N]", steep), a.f.norm(), t, 0.04 * t);
  held(claim("place of a bead along its rope [m]", steep), s, from_left, 0.03);
}

}  // namespace sliding_statics_test
