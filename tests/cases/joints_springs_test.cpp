// Spring cases of Chrono's joint tests against ADAMS (J2): a mass under a vertical spring, a mass swinging on a
// spring, and a bar on a pin with a torsional spring. The parameters of the last case are those of
// utest_JOINT_rotspring.cpp, k = 200 and c = 10. They reproduce the printed digits. The value 50 does not reproduce
// them.

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"

using namespace polybody;

namespace joints_springs_test {

using Pin = Joint<Revolute, Constraint>;
using Rail = Joint<Prismatic, Constraint>;
using Torsion = Joint<Weld, Bushing>;
using Space = Model<Bodies<Rigid<>>, Joints<Pin, Rail, Torsion>, Forces<AxialSpring, SpringDamper>>;

constexpr double g = 9.80665;

/// Body at `place`, the middle of a bar of inertia (0.04, 0.1, 0.1).
struct Case {
  Space model{Gravity{0, 0, -g}};
  BodyHandle<Rigid<>> body;

  explicit Case(Vec3 const& place)
      : body(model.add(Rigid<>(1.0, Vec3(0.04, 0.1, 0.1).asDiagonal().toDenseMatrix(), Placement::at(place)), "bar")) {}

  auto ground() const { return model.ground().at({0, 0, 0}); }

  template <class I>
  Vec3 after_five_seconds(I const& integrator, double step) const {
    State x = model.reference_state();
    simulate(model, x, integrator, {.end_time = 5.0, .step = step}).run();
    return position(model, x, body.at(Vec3(0, 0, 0)));
  }
};

DormandPrince<Projection> precise() { return {.relative_tolerance = 1e-11, .absolute_tolerance = 1e-11}; }

/// Compares with the printed digits and with an exact solution. The position tolerance of Chrono's test is 1e-3.
void expect(Case const& c, char const* which, std::optional<Vec3> const& printed, Vec3 const& exact,
            char const* solution, By by) {
  Vec3 const fine = c.after_five_seconds(precise(), 0.01), coarse = c.after_five_seconds(GeneralisedAlpha{}, 5e-4);
  std::string const what = std::string(which) + ": place at 5 s [m]";
  Instance const at{.scale = 1.0};
  held_within({"J2", what, by, solution, "Dormand–Prince"}, (fine - exact).norm(), 1e-8, at);
  held_within({"J2", what, by, solution, "generalised-α, h = 5e-4 s"}, (coarse - exact).norm(), 1e-5, at);
  if (printed)
    held_within({"J2", what, By::published, "Chrono's data of ADAMS, 6 digits", "Dormand–Prince"},
                (fine - *printed).norm(), 1e-5, at);
}

// TranSpring_Case01: k = 10, c = 0.5, no free length, vertical:
//   z = (g m/k)(e^(−σt)(cos νt + σ/ν sin νt) − 1),  σ = c/2m,  ν² = k/m − σ².
TEST(AdamsSprings, MassSinksOnAnUprightSpring) {
  Case c({0, 0, 0});
  auto const middle = c.body.at(Vec3(0, 0, 0));
  c.model.connect(Rail{Prismatic{.axis = Vec3::UnitZ()}, {}}, c.ground(), middle, "upright");
  c.model.apply(AxialSpring{.stiffness = 10.0, .damping = 0.5, .axis = Vec3::UnitZ()}, c.ground(), middle, "spring");
  double const sigma = 0.25, nu = std::sqrt(10.0 - sigma * sigma), t = 5.0;
  double const z = 0.1 * g * (std::exp(-sigma * t) * (std::cos(nu * t) + sigma / nu * std::sin(nu * t)) - 1.0);
  expect(c, "TranSpring_Case01", Vec3(0, 0, -1.26242), Vec3(0, 0, z), "damped oscillator", By::closed_form);
}

// TranSpring_Case02: k = 100, c = 5, released at a horizontal distance of 2 m from the anchor, which is the free
// length.
TEST(AdamsSprings, MassSwingsOnASpring) {
  Case c({0, 2, 0});
  c.model.apply(SpringDamper{.stiffness = 100.0, .damping = 5.0, .free_length = 2.0}, c.ground(),
                c.body.at(Vec3(0, 0, 0)), "spring");
  expect(c, "TranSpring_Case02", {}, Vec3(0, -1.945197850454, -0.767400995044), "Runge–Kutta 4 of the two coordinates",
         By::independent);
}

// RotSpring_Case01: 4.1 θ¨ = 2 m g cos θ − k θ − c θ˙, the middle of the bar at 2 (cos θ, 0, −sin θ).
TEST(AdamsSprings, BarTurnsAgainstATorsionalSpring) {
  Case c({2, 0, 0});
  auto const end = c.body.at(Vec3(-2, 0, 0));
  c.model.connect(Pin{Revolute{.axis = Vec3::UnitY()}, {}}, c.ground(), end, "pin");
  Bushing const spring{.stiffness = Bushing::diagonal({0, 0, 0}, {0, 200, 0}),
                       .damping = Bushing::diagonal({0, 0, 0}, {0, 10, 0})};
  c.model.connect(Torsion{{}, spring}, c.ground(), end, "spring");
  expect(c, "RotSpring_Case01", Vec3(1.990439, 0, -0.1953254), Vec3(1.9904391270561, 0, -0.1953255781620),
         "Runge–Kutta 4 of the angle", By::independent);
}

}  // namespace joints_springs_test
