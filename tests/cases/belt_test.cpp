// Belts over pulleys: creep, tensions and frequencies in closed form.
#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/belt.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/belt_spans.hpp>
#include <polybody/run/energy_audit.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/statics/equilibrium.hpp>
#include <polybody/vibration/modes.hpp>

#include "support/held.hpp"

namespace polybody {
namespace belt_test {

Claim closed_form(char const* what, char const* source, char const* formulation) {
  return {"drives", what, By::closed_form, source, formulation};
}
using Pin = Joint<Revolute>;
using Drive = Joint<PrescribedRate<SmoothRamp>>;
constexpr double inertia = 0.05;
Rigid<> disc(Vec3 const& centre) { return {2.0, Mat3(Mat3::Identity() * inertia), Placement::at(centre)}; }
Pin const about_z{Revolute{.axis = Vec3::UnitZ()}};

/// Pulleys on the ground. The first one turns at `speed`; a moment acts on the second one.
template <int N>
struct Transmission {
  using Belt = BeltAndPulley<N>;
  Model<Bodies<Rigid<>>, Joints<Pin, Drive>, Forces<Belt, PointMoment<>>> model;
  std::vector<BodyHandle<Rigid<>>> pulleys;
  std::vector<ElementHandle<Pin>> pins;
  ElementHandle<Belt> belt;
  State x;

  Transmission(Belt const& given, double speed, double moment) {
    for (std::size_t k = 0; k < N; ++k) {
      pulleys.push_back(model.add(disc(given.centres[k]), "pulley " + std::to_string(k)));
      pins.push_back(model.connect(about_z, model.ground().at(given.centres[k]), pulleys[k].at({0, 0, 0})));
    }
    auto const at = [&](std::size_t k) { return pulleys[k].at({0, 0, 0}); };
    model.connect(Drive{{.law = {{.target = speed, .duration = 0.5}}, .axis = Vec3::UnitZ()}},
                  model.ground().at(given.centres[0]), at(0), "drive");
    if constexpr (N == 2)
      belt = model.apply(given, std::tuple(at(0), at(1)), "belt");
    else
      belt = model.apply(given, std::tuple(at(0), at(1), at(2)), "belt");
    model.apply(PointMoment<>{.moment = {0, 0, moment}}, at(1), "load");
    x = model.reference_state();
  }
  double speed(std::size_t k) const { return joint_angle_rate(model, x, pins[k]); }
  std::array<BeltSpan, N> spans() const { return belt_spans(model, x, belt); }
};

BeltAndPulley<2> two_pulleys(std::array<int, 2> const& senses, double pretension = 400.0) {
  return {.radii = {0.1, 0.25},
          .centres = {Vec3(0, 0, 0), Vec3(0.8, 0.3, 0)},
          .axial_stiffness = 2e4,
          .damping = 60.0,
          .pretension = pretension,
          .senses = senses};
}

/// Strains of the tight and the slack span under the moment M of the driven pulley. The spans have equal lengths and
/// keep their total unstretched length, so 1/(1 + ε_t) + 1/(1 + ε_s) = 2/(1 + ε₀) with δ = ε_t − ε_s = M/(EA R), a
/// quadratic equation of 1 + ε_s.
std::pair<double, double> steady_strains(double pretension_strain, double delta) {
  double const c = 1.0 + pretension_strain, half = 0.5 * (c - delta);
  double const slack = half + std::sqrt(half * half + 0.5 * delta * c) - 1.0;
  return {slack + delta, slack};
}

void expect_creep(std::array<int, 2> const& senses, double speed, char const* formulation) {
  double const moment = 40.0, sense = senses[0] * senses[1];
  double const load = (speed > 0.0 ? -1.0 : 1.0) * sense * moment;
  Transmission<2> t(two_pulleys(senses), speed, load);
  EnergyAudit audit(t.model);
  for (State const& now : simulate(t.model, t.x, Radau{}, {.end_time = 2.5, .step = 5e-4})) audit.record(now);
  EXPECT_LT(audit.relative(), 1e-6) << audit;
  auto const [tight, slack] = steady_strains(400.0 / 2e4, moment / (0.25 * 2e4));
  std::size_t const pulled = speed * senses[0] > 0.0 ? 1 : 0;  // the span that runs onto the driver
  auto const claim = [&](char const* what, char const* source) { return closed_form(what, source, formulation); };
  std::array<BeltSpan, 2> const spans = t.spans();
  held(claim("strain of the tight span of a belt", "equal unstretched length"), spans[pulled].strain, tight, 1e-8);
  held(claim("strain of the slack span of a belt", "equal unstretched length"), spans[1 - pulled].strain, slack, 1e-8);
  held(claim("difference of the tensions of a belt [N]", "M/R"), spans[pulled].tension - spans[1 - pulled].tension,
       moment / 0.25, 1e-5);
  held(claim("ratio of the surface speeds of a belt drive", "(1 + ε_tight)/(1 + ε_slack)"),
       0.1 * t.speed(0) / (0.25 * t.speed(1)) * sense, (1.0 + tight) / (1.0 + slack), 1e-8);
  EXPECT_GT(tight - slack, 5e-3);
}
TEST(Belt, CreepsByTheRatioOfItsStretches) {
  expect_creep({1, 1}, 20.0, "open belt, Radau IIA");
  expect_creep({1, 1}, -20.0, "open belt backwards, Radau IIA");
  expect_creep({1, -1}, 20.0, "crossed belt, Radau IIA");
}

// The slack span does not push. The tension of the tight span is M/R, and the belt arrives from the slack span without
// stretch.
TEST(Belt, SlackSpanDoesNotPush) {
  Transmission<2> t(two_pulleys({1, 1}, 10.0), 20.0, -40.0);
  simulate(t.model, t.x, Radau{}, {.end_time = 2.5, .step = 5e-4}).run();
  std::array<BeltSpan, 2> const spans = t.spans();
  EXPECT_LT(spans[0].strain, -1e-4);
  EXPECT_EQ(spans[0].tension, 0.0);
  held(closed_form("tension of a belt with a slack span [N]", "M/R", "open belt, Radau IIA"), spans[1].tension, 160.0,
       1e-5);
  held(closed_form("ratio of the surface speeds with a slack span", "1 + M/(R EA)", "open belt, Radau IIA"),
       0.1 * t.speed(0) / (0.25 * t.speed(1)), 1.0 + 160.0 / 2e4, 1e-8);
}

// A free idler transmits no torque. Both spans next to it have equal tensions, and the force of its bearing is their
// sum.
TEST(Belt, IdlerTransmitsNoTorque) {
  BeltAndPulley<3> const belt{.radii = {0.1, 0.2, 0.05},
                              .centres = {Vec3(0, 0, 0), Vec3(0.8, 0, 0), Vec3(0.4, 0.5, 0)},
                              .axial_stiffness = 2e4,
                              .damping = 60.0,
                              .pretension = 400.0};
  Transmission<3> t(belt, 20.0, -20.0);
  simulate(t.model, t.x, Radau{}, {.end_time = 3.0, .step = 1e-3}).run();
  std::array<BeltSpan, 3> const spans = t.spans();
  auto const claim = [](char const* what, char const* source) {
    return closed_form(what, source, "three pulleys, Radau IIA");
  };
  held(claim("difference of the tensions at a free idler [N]", "no torque"), spans[1].tension - spans[2].tension, 0.0,
       1e-5, {.scale = 400.0});
  held(claim("difference of the tensions at a driven pulley [N]", "M/R"), spans[1].tension - spans[0].tension, 100.0,
       1e-5);
  held(claim("surface speed of a free idler, of the driver's", "1"), 0.05 * t.speed(2) / (0.1 * t.speed(0)), 1.0, 1e-8);
  // direction of span k: unit vector of d − (R_{k+1} − R_k) n×t, by the angle of d less asin((R_{k+1} − R_k)/|d|)
  auto const along = [&](std::size_t k) -> Vec3 {
    Vec3 const d = belt.centres[(k + 1) % 3] - belt.centres[k];
    double const turn = std::atan2(d.y(), d.x()) - std::asin((belt.radii[(k + 1) % 3] - belt.radii[k]) / d.norm());
    return {std::cos(turn), std::sin(turn), 0};
  };
  Vec3 const pull = spans[2].tension * along(2) - spans[1].tension * along(1);
  held_within(claim("force of a bearing on an idler [N]", "sum of the tensions"),
              (reaction(t.model, t.x, t.pins[2]).f + pull).norm(), 1e-5, {.scale = pull.norm()});
}

/// A pulley that is held, and one on the slide and the hinge of a carriage. The force on the carriage is 400 N, twice
/// the pretension, and grows to `pull` within 1 s.
struct Tensioner {
  using Slide = Joint<Prismatic>;
  using Fixed = Joint<Weld>;
  using Belt = BeltAndPulley<2>;
  Model<Bodies<Rigid<>>, Joints<Pin, Slide, Fixed>, Forces<Belt, PointForce<>, PointForce<SmoothRamp>>> model;
  ElementHandle<Belt> belt;
  BodyHandle<Rigid<>> carriage;

  Tensioner(double pull, double damping) {
    Vec3 const centre(0.8, 0, 0);
    auto const first = model.add(disc({0, 0, 0}), "first"), second = model.add(disc(centre), "second");
    carriage = model.add(disc(centre), "carriage");
    model.connect(Fixed{}, model.ground().at({0, 0, 0}), first.at({0, 0, 0}), "foot");
    model.connect(Slide{Prismatic{.axis = Vec3::UnitX()}}, model.ground().at(centre), carriage.at({0, 0, 0}), "slide");
    model.connect(about_z, carriage.at({0, 0, 0}), second.at({0, 0, 0}), "hinge");
    belt = model.apply(Belt{.radii = {0.1, 0.1},
                            .centres = {Vec3(0, 0, 0), centre},
                            .axial_stiffness = 2e4,
                            .damping = damping,
                            .pretension = 200.0},
                       std::tuple(first.at({0, 0, 0}), second.at({0, 0, 0})), "belt");
    model.apply(PointForce<>{.force = {400.0, 0, 0}}, carriage.at({0, 0, 0}), "pretension");
    model.apply(PointForce<SmoothRamp>{.force = {pull - 400.0, 0, 0}, .law = {.target = 1.0, .duration = 1.0}},
                carriage.at({0, 0, 0}), "pull");
  }
};
// Both spans have the tension F/2 with the force F on the carriage. The displacement is l₀ ((1 + F/2EA)/(1 + ε₀) − 1).
TEST(Belt, MovingCentreStretchesBothSpans) {
  Tensioner t(1000.0, 60.0);
  State x = t.model.reference_state();
  EnergyAudit audit(t.model);
  for (State const& now : simulate(t.model, x, Radau{}, {.end_time = 4.0, .step = 1e-3})) audit.record(now);
  held(closed_form("displacement of a pulley that tensions a belt [m]", "F/2 in each span", "two pulleys, Radau IIA"),
       position(t.model, x, t.carriage.at({0, 0, 0})).x() - 0.8, 0.8 * ((1.0 + 500.0 / 2e4) / 1.01 - 1.0), 1e-8);
  EXPECT_LT(audit.relative(), 1e-6) << audit;
}
// Around the pretension ε both spans are springs k = EA (1 + ε)/l for the rotation of the free pulley and springs
// EA/L = k for the carriage, with L = l/(1 + ε).
TEST(Belt, VibratesAtTheFrequencyOfItsSpans) {
  Tensioner const t(400.0, 0.0);
  DampedModes const found = damped_modes(t.model, t.model.reference_state());
  double const k = 2e4 * 1.01 / 0.8, turning = 0.1 * std::sqrt(2.0 * k / inertia), sliding = std::sqrt(2.0 * k / 4.0);
  for (double const expected : {turning, sliding}) {
    double nearest = expected;
    for (Index i = 0; i < found.eigenvalue.size(); ++i)
      nearest = std::min(nearest, std::abs(found.eigenvalue[i] - std::complex<double>(0.0, expected)));
    held_within(closed_form("frequencies of a pulley in a belt [rad/s]", "√(2 k R²/J), √(2 k/m)", "damped modes"),
                nearest, 1e-6 * expected, {equals("mode", expected), expected});
  }
}

}  // namespace belt_test
}  // namespace polybody
