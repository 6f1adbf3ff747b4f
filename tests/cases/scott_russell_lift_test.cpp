// X7: platform on two Scott–Russell linkages, in the plane and in space (after jgerstmayr/EXUDYN#39). In each
// linkage a short bar from a ground pin carries the middle of a long bar. The foot of the long bar moves along x, and
// its head moves along y. The platform is pinned to the left heads and slides on the right heads.

#include <gtest/gtest.h>

#include <numbers>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/minimum_norm.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/redundancy.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/statics/equilibrium.hpp>

#include "support/held.hpp"
#include "support/refusal.hpp"

namespace polybody {
namespace scott_russell_lift_test {

constexpr double g = 9.81, angle = 35.0 * std::numbers::pi / 180.0;
constexpr double half = 0.6, span = 1.5, to_centre = 0.5;                   // of a long bar, between the units [m]
constexpr double long_mass = 8.0, short_mass = 4.0, platform_mass = 120.0;  // of both frames [kg]
double const c = half * std::cos(angle), s = half * std::sin(angle);

struct Still {
  Motion operator()(double) const { return {}; }
};

/// Joints of one linkage in one frame.
template <class Pin, class Rail, class Hold>
struct Unit {
  ElementHandle<Pin> ground_pin;
  ElementHandle<Rail> foot;
  ElementHandle<Hold> hold;
};

/// In space the lift has two frames at z = ±0.2 m, with half of the mass of the bars each.
template <bool space>
struct Lift {
  using Body = std::conditional_t<space, Rigid<>, planar::Rigid>;
  using Pin = Joint<std::conditional_t<space, Revolute, planar::Revolute>>;
  using Rail = Joint<std::conditional_t<space, PointOnLine, PointInPlane>>;
  using Hold = Joint<PrescribedTranslation<Still>>;
  Model<Bodies<Body>, Joints<Pin, Rail, Hold>> model{Gravity{0, -g, 0}};
  BodyHandle<Body> platform = body(platform_mass, 2.0, {to_centre, 2 * s, 0}, "platform");
  std::vector<Unit<Pin, Rail, Hold>> left, right;  // one for each frame

  struct Options {
    bool left_held = true, right_held = true, right_pinned = false;
  };
  explicit Lift(Options const& o) {
    for (double const z : space ? std::vector{0.2, -0.2} : std::vector{0.0}) {
      left.push_back(add(0.0, z, o.left_held, true));
      right.push_back(add(span, z, o.right_held, o.right_pinned));
    }
  }

 private:
  BodyHandle<Body> body(double mass, double length, Vec3 const& centre, std::string const& name) {
    double const inertia = mass * length * length / 12.0;
    if constexpr (space)
      return model.add(Body(mass, Mat3(inertia * Mat3::Identity()), Placement::at(centre)), name);
    else
      return model.add(Body(mass, inertia, Placement::planar(centre[0], centre[1])), name);
  }
  /// Marker at (x, y, z) from the centre of mass.
  auto at(BodyHandle<Body> const& b, double x, double y, double z = 0.0) const {
    if constexpr (space)
      return b.at(Vec3(x, y, z));
    else
      return b.at(Vec2(x, y));
  }
  static Pin pin() {
    if constexpr (space)
      return Pin{Revolute{.axis = {0, 0, 1}}};
    else
      return {};
  }
  static Rail rail() {
    if constexpr (space)
      return Rail{PointOnLine{.axis = {1, 0, 0}}};
    else
      return Rail{PointInPlane{.normal = {0, 1, 0}}};
  }

  Unit<Pin, Rail, Hold> add(double x, double z, bool held, bool pinned) {
    double const part = space ? 0.5 : 1.0;
    std::string const n = std::string(x > 0.0 ? " right" : " left") + (z > 0.0 ? " front" : z < 0.0 ? " back" : "");
    auto const longer = body(part * long_mass, 2 * half, {x + c, s, z}, "long bar" + n),
               shorter = body(part * short_mass, half, {x + 0.5 * c, 0.5 * s, z}, "short bar" + n);
    auto const ground = model.ground().at({x, 0, z}), place = model.ground().at({x + 2 * c, 0, z});
    Unit<Pin, Rail, Hold> unit;
    unit.ground_pin = model.connect(pin(), ground, at(shorter, -0.5 * c, -0.5 * s), "ground pin" + n);
    model.connect(pin(), at(shorter, 0.5 * c, 0.5 * s), at(longer, 0, 0), "middle pin" + n);
    unit.foot = model.connect(rail(), place, at(longer, c, -s), "foot" + n);
    if (held)
      unit.hold = model.connect(Hold{{.law = Still{}, .axis = {1, 0, 0}}}, place, at(longer, c, -s), "hold" + n);
    auto const seat = at(platform, x - to_centre, 0, z), head = at(longer, -c, s);
    if (pinned)
      model.connect(pin(), seat, head, "head" + n);
    else
      model.connect(rail(), seat, head, "head" + n);
    return unit;
  }
};

// Without the holds both units move. In space every bar has its revolute joints about z, so that ten of 62 constraint
// equations are redundant.
TEST(ScottRussellLift, HasTwoDegreesOfFreedom) {
  auto const expect = [](auto const& lift, Index rows, Index rank) {
    Redundancy const found = redundancy(lift.model, lift.model.reference_state());
    EXPECT_EQ(found.rows, rows);
    EXPECT_EQ(found.rank, rank);
    EXPECT_EQ(found.degrees_of_freedom, 2);
    EXPECT_TRUE(found.consistent());
  };
  expect(Lift<false>({.left_held = false, .right_held = false}), 13, 13);
  expect(Lift<true>({.left_held = false, .right_held = false}), 62, 52);
}

/// Forces of one unit under the load N of its head, by virtual work and equilibrium of the unit. With minimum-norm
/// multipliers each frame has its share. Tolerance: 1e-8 of the largest force.
template <bool space>
void expect_unit(Lift<space> const& lift, State const& x, bool is_left, char const* formulation) {
  double const load = platform_mass * g * (is_left ? 1.0 - to_centre / span : to_centre / span),
               push = (load + (long_mass / 2 + short_mass / 4) * g) / std::tan(angle),
               foot = (long_mass / 2 + short_mass / 4) * g, weight = (long_mass + short_mass) * g;
  EXPECT_NEAR(push, is_left ? 1190.861215 : 630.455938, 5e-7);  // digits of case X7
  auto const& units = is_left ? lift.left : lift.right;
  std::string const side = is_left ? "left" : "right";
  for (std::size_t k = 0; k < units.size(); ++k) {
    Instance const at{side + (k == 0 ? ", front" : ", back"), push};
    auto const compare = [&](char const* what, char const* source, double value, double reference) {
      held({"X7", what, By::closed_form, source, formulation}, double(units.size()) * value, reference, 1.2e-5, at);
    };
    Vec3 const pin = reaction(lift.model, x, units[k].ground_pin).f;
    compare("force that holds a foot [N]", "(N + m_l g/2 + m_s g/4) cot ϑ",
            -reaction(lift.model, x, units[k].hold).f[0], push);
    compare("horizontal force of a ground pin [N]", "(N + m_l g/2 + m_s g/4) cot ϑ", pin[0], push);
    compare("vertical force of a ground pin [N]", "N + m_l g/2 + 3 m_s g/4", pin[1], load + weight - foot);
    compare("force of the floor on a foot [N]", "m_l g/2 + m_s g/4", reaction(lift.model, x, units[k].foot).f[1], foot);
  }
}
template <bool space>
void expect_lift(char const* formulation) {
  Lift<space> const lift({});
  auto const compare = [&](State x) {
    held({"X7", "height of the platform [m]", By::closed_form, "2 a sin ϑ", formulation},
         position(lift.model, x, lift.platform.centre())[1], 0.68829172, 1e-8);
    x.lambda = minimum_norm_multipliers(lift.model, x);
    expect_unit(lift, x, true, formulation);
    expect_unit(lift, x, false, formulation);
  };
  State x = lift.model.reference_state();
  equilibrium(lift.model, x);
  compare(x);
  x = lift.model.reference_state();
  RunReport const report =
      simulate(lift.model, x, GeneralisedAlpha{}, {.end_time = 0.02, .step = 1e-3, .minimum_norm = true}).run();
  compare(x);
  EXPECT_TRUE(report.warnings.empty()) << report.warnings.front();
  EXPECT_EQ(report.redundant.empty(), !space);
}
TEST(ScottRussellLift, IsHeldByItsFeet) {
  expect_lift<false>("planar Rigid");
  expect_lift<true>("Rigid, minimum norm");
}

// With pinned right heads the distance of the heads is that of the seats: (y₁ − y₂)² = 0. This equation has no first
// derivative and determines no force. The sentence names the right head.
template <bool space>
void expect_sentences() {
  for (bool const left_held : space ? std::vector{true} : std::vector{true, false}) {
    Lift<space> const lift({.left_held = left_held, .right_held = !left_held, .right_pinned = true});
    State x = lift.model.reference_state();
    std::string const refused = message_of<SingularMatrix>([&] { equilibrium(lift.model, x); });
    EXPECT_TRUE(has(refused, "The initial state is a singular configuration: the constraint equations of joint \""));
    EXPECT_TRUE(has(refused, "joint \"head right"));
    EXPECT_TRUE(has(refused, "Replace one of these joints by a joint with fewer constraint equations"));
    auto const warnings =
        simulate(lift.model, x, GeneralisedAlpha{}, {.end_time = 0.01, .step = 1e-3}).report().warnings;
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_TRUE(has(warnings[0], "singular configuration"));
    EXPECT_TRUE(has(warnings[0], "joint \"head right"));
  }
  // with both feet held only the force along the platform is not determined
  Lift<space> const lift({.right_pinned = true});
  State x = lift.model.reference_state();
  std::vector<std::string> const redundant = equilibrium(lift.model, x).redundant;
  EXPECT_TRUE(std::any_of(redundant.begin(), redundant.end(),
                          [](std::string const& name) { return name.find("head right") != std::string::npos; }));
  double sum = 0.0;
  for (auto const& unit : lift.left) sum -= reaction(lift.model, x, unit.hold).f[0];
  EXPECT_NEAR(sum, 1190.861215, 1e-6);
}
TEST(ScottRussellLift, WithPinnedHeadsIsReportedAsSingular) {
  expect_sentences<false>();
  expect_sentences<true>();
}

}  // namespace scott_russell_lift_test
}  // namespace polybody
