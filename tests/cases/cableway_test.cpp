// Cabin that hangs from a trolley on a cable in space.

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/run/sliders.hpp>

#include "support/held.hpp"
#include "support/solver_instances.hpp"

using namespace polybody;

namespace cableway_test {

constexpr double g = 9.81;
using Ball = Joint<Spherical, Constraint>;
using InSpace = Model<Bodies<WithSliders<AncfCable<>>, Rigid<>>, Joints<Ball>>;

/// A cable of 4 m is taut between two anchors. The right anchor is 0.5 m lower. A cabin hangs 0.3 m under a slider
/// and swings sideways.
struct Cableway {
  InSpace model{Gravity{0, 0, -g}};
  Bar const bar{.length = 4.0,
                .constants = BarConstants{.EA = 2e4, .EI = 2.0, .mass_per_length = 0.2},
                .placement = Placement::at({0, 0, 0}, {0, std::asin(0.125), 0}),
                .pretension = 200.0};
  Vec3 along = bar.placement.axes.col(0);
  BodyHandle<WithSliders<AncfCable<>>> cable = model.add(WithSliders(AncfCable<>::from(bar, 8), {0.7}), "cable");
  BodyHandle<Rigid<>> cabin = model.add(
      Rigid<>(2.0, Vec3(0.02, 0.03, 0.04).asDiagonal().toDenseMatrix(), Placement::at(0.7 * along - Vec3(0, 0, 0.3))),
      "cabin");
  ElementHandle<Ball> hanger;
  State start;

  Cableway() {
    model.connect(Ball{}, model.ground().at({0, 0, 0}), cable.at(0.0), "left anchor");
    model.connect(Ball{}, model.ground().at(4.0 * along), cable.at(4.0), "right anchor");
    hanger = model.connect(Ball{}, cable.at(Slider{}), cabin.at(Vec3(0, 0, 0.3)), "hanger");
    start = model.reference_state();
    Vec3 const spin(1.0, 0.3, 0.0), hook = 0.7 * along;
    model.set_velocity(start, cabin, -spin.cross(hook), spin);  // about the hook, which is at rest
  }
};

/// Changes of energy and constraint violations during a run, and the state at its end.
struct Ride {
  State x;
  double energy = 0.0;
  Violation open;

  template <class I>
  Ride(Cableway const& way, I const& integrator, double end_time, double step) : x(way.start) {
    System system(way.model);
    double before = 0.0;
    for (State const& now : simulate(way.model, x, integrator, {.end_time = end_time, .step = step})) {
      Violation const v = largest_violation(system, now);
      double const e = polybody::energy(system, now).total();
      if (now.t == 0.0) before = e;
      energy = std::max(energy, std::abs(e - before));
      open.position = std::max(open.position, v.position);
      open.velocity = std::max(open.velocity, v.velocity);
      open.acceleration = std::max(open.acceleration, v.acceleration);
    }
  }
};

// The cabin moves from the second element of the cable into the third. No force dissipates energy. The constraint
// equations hold in position, velocity and acceleration. Two methods agree.
TEST(Cableway, RidesDownTheCableWithItsEnergy) {
  Cableway const way;
  double const end_time = 0.8, weight = 2.0 * g;  // times 1 m
  Ride const alpha(way, GeneralisedAlpha{.rho_inf = 0.9, .stabilised = true}, end_time, 1e-4),
      radau(way, Radau{}, end_time, 5e-4);
  EXPECT_GT(slider_position(way.model, radau.x, way.cable), 1.1);
  char const *const by_alpha = "AncfCable, generalised-α, stabilised", *const by_radau = "AncfCable, Radau IIA";
  auto const drift = [&](char const* method, double change, double part) {
    held_within(
        {"sliders", "change of energy while a cabin rides down a cable [J]", By::closed_form, "invariant", method},
        change, part * weight, {.scale = weight});
  };
  drift(by_alpha, alpha.energy, 1e-7);
  drift(by_radau, radau.energy, 1e-8);
  EXPECT_LT(alpha.open.position, 1e-11);
  EXPECT_LT(alpha.open.velocity, 1e-9);
  EXPECT_LT(radau.open.position, 1e-11);
  EXPECT_LT(radau.open.velocity, 1e-10);
  EXPECT_LT(radau.open.acceleration, 1e-9);
  held_within({"sliders", "place of a cabin on a cable [m]", By::itself, "Radau IIA", by_alpha},
              std::abs(slider_position(way.model, alpha.x, way.cable) - slider_position(way.model, radau.x, way.cable)),
              5e-5, {.scale = 1.0});
  // the hook pulls across the cable: f · r′ = 0, with r′ from positions on both sides
  double const s = slider_position(way.model, radau.x, way.cable), e = 1e-4;
  auto const point = [&](double at) { return position(way.model, radau.x, way.cable.at(at)); };
  Vec3 const slope = (point(s + e) - point(s - e)) / (2.0 * e);
  Vec3 const f = reaction(way.model, radau.x, way.hanger).f;
  held_within({"sliders", "force of a cabin's hook along the cable, of the force", By::closed_form, "0", by_radau},
              std::abs(f.dot(slope)) / f.norm(), 1e-6, {.scale = 1.0});
  EXPECT_GT(f.norm(), 0.3 * weight);
}

}  // namespace cableway_test
