// Springs by tables, two slopes and functions, ropes and winches: law suites and closed forms.
#include <polybody/forces/spring_laws.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/energy_audit.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/testing/force_laws.hpp>

#include "support/refusal.hpp"

namespace polybody {
using namespace laws;
namespace spring_laws_test {

MonotoneTable const progressive({{-1.0, -50.0}, {0.0, 0.0}, {1.0, 20.0}, {2.0, 90.0}});

struct TwoSlopeCase {
  static auto force() {
    return on_translation(TwoSlopeSpring{
        .stiffness_above = 80.0, .stiffness_below = 30.0, .damping_rising = 3.0, .damping_falling = 1.0, .free = 0.1});
  }
};
struct TableSpringCase {
  static auto force() { return on_angle(TableSpring{.table = progressive, .damping = 2.0}); }
};
struct FunctionSpringCase {
  static auto force() { return on_distance(FunctionSpring{TabulatedLaw{.force = progressive, .damping = 2.0}}); }
};
struct RopeCase {
  static auto force() { return on_distance(Rope{.stiffness = 80.0, .damping = 3.0, .length = 0.1}); }
};
/// Frames whose points depart from each other, so that the rope is taut.
struct WinchCase {
  static auto force() {
    return on_distance(Winch<Ramp>{
        .axial_stiffness = 80.0, .damping = 3.0, .length = 0.4, .reeled = {.target = 0.3, .duration = 2.0}});
  }
};
bool const forces_obey[] = {obeys<TwoSlopeCase, ForceLaws>("TwoSlopeSpring"),
                            obeys<TableSpringCase, ForceLaws>("TableSpring"),
                            obeys<FunctionSpringCase, ForceLaws>("FunctionSpring"), obeys<RopeCase, ForceLaws>("Rope"),
                            obeys<WinchCase, ForceLaws>("Winch")};

TEST(TwoSlopeSpring, HasASlopeOnEachSide) {
  TwoSlopeSpring const spring{
      .stiffness_above = 80.0, .stiffness_below = 30.0, .damping_rising = 3.0, .damping_falling = 1.0, .free = 0.1};
  EXPECT_NEAR(spring.force<double>(0.6, 2.0, 0.0), -46.0, 1e-12);
  EXPECT_NEAR(spring.force<double>(0.6, -2.0, 0.0), -38.0, 1e-12);
  EXPECT_NEAR(spring.force<double>(-0.4, -2.0, 0.0), 17.0, 1e-12);
  EXPECT_NEAR(spring.potential(-0.4, 0.0), 0.5 * 30.0 * 0.25, 1e-12);
}

TEST(TableDamper, ResistsByItsTable) {
  TableDamper const damper{MonotoneTable({{-1.0, -10.0}, {0.0, 0.0}, {1.0, 30.0}})};
  EXPECT_NEAR(damper.force<double>(0.3, 1.0, 0.0), -30.0, 1e-12);
  EXPECT_NEAR(damper.force<double>(0.3, -1.0, 0.0), 10.0, 1e-12);
  TableDamper const wrong{MonotoneTable({{0.0, 2.0}, {1.0, 30.0}})};
  EXPECT_EQ(refusal([&] { on_translation(wrong).check("\"strut\""); }),
            "\"strut\": the table of a damper must be zero at the rate zero, but is 2 N.");
}

TEST(FunctionSpring, AppliesALambda) {
  auto const hardening = on_translation(FunctionSpring{[](auto x, auto rate) { return x * x * x * 5.0 + rate * 2.0; }});
  std::array<Frame<double>, 2> f;
  f[1].r = {0, 0, 2};
  f[1].v = {0, 0, 3};
  EXPECT_NEAR(hardening.wrenches<double>(f, 0.0)[1].f[2], -46.0, 1e-12);
  static_assert(!HasPotential<decltype(hardening)>);
  static_assert(HasPotential<decltype(FunctionSpringCase::force())>);
}

TEST(Rope, PullsOnly) {
  Rope const rope{.stiffness = 100.0, .damping = 5.0, .length = 2.0};
  EXPECT_EQ(rope.force<double>(1.9, 7.0, 0.0), 0.0);
  EXPECT_NEAR(rope.force<double>(2.1, 1.0, 0.0), -15.0, 1e-12);
  EXPECT_EQ(rope.force<double>(2.1, -3.0, 0.0), 0.0);
  EXPECT_EQ(rope.potential(1.0, 0.0), 0.0);
  EXPECT_NEAR(rope.potential(2.5, 0.0), 12.5, 1e-12);
}

/// Mass of 2 kg on a vertical force from the origin, with gravity of 9.81 m/s².
template <class F>
struct Hung {
  Model<Bodies<Rigid<>>, Joints<>, Forces<F>> model{Gravity{0, 0, -9.81}};
  BodyHandle<Rigid<>> mass;
  State x;
  Hung(F const& force, double depth, double speed = 0.0)
      : mass(model.add(Rigid<>(2.0, Mat3::Identity(), Placement::at({0, 0, -depth})), "mass")) {
    model.apply(force, model.ground().at({0, 0, 0}), mass.at(Vec3(0, 0, 0)), "force");
    x = model.reference_state();
    model.set_velocity(x, mass, Vec3(0, 0, -speed), Vec3::Zero());
  }
  double depth(State const& at) const { return -position(model, at, mass.at(Vec3(0, 0, 0)))[2]; }
};

// The mass falls 0.8 m freely, stretches the rope and returns. Taut, with ω² = k/m, the static elongation s = g/ω² and
// the speed v = √(2 g h), the elongation is s (1 − cos ωτ) + (v/ω) sin ωτ. It returns to zero after τ = 2 (π − φ)/ω
// with tan φ = v/(ω s), and the mass rises to its start. A cycle lasts 2 √(2 h/g) + τ.
TEST(Rope, GoesSlackAndTaut) {
  double const k = 800.0, g = 9.81, h = 0.8, w = std::sqrt(k / 2.0), s = g / (w * w), v = std::sqrt(2.0 * g * h);
  double const fall = std::sqrt(2.0 * h / g), taut = 2.0 * (std::numbers::pi - std::atan2(v, w * s)) / w;
  Hung<OnDistance<Rope>> hung({{.stiffness = k, .length = 1.0}}, 0.2);
  EnergyAudit audit(hung.model);
  double deepest = 0.0;
  DormandPrince<> const method{.relative_tolerance = 1e-11, .absolute_tolerance = 1e-12};
  for (State const& now :
       simulate(hung.model, hung.x, method, {.end_time = 3.0 * (2.0 * fall + taut), .step = 1e-3, .max_step = 2e-3})) {
    audit.record(now);
    deepest = std::max(deepest, hung.depth(now));
  }
  EXPECT_NEAR(hung.depth(hung.x), 0.2, 1e-6);
  EXPECT_NEAR(deepest, 1.0 + s + std::sqrt(s * s + v * v / (w * w)), 1e-4);  // between steps of up to 2 ms
  EXPECT_LT(audit.relative(), 1e-9);
}

// MSL#476: a mass of 100 kg on a spring of 40 N/m with the free length 0.2 m, released at 0.3 m. The period is
// 2π √(m/k) = 9.9345883 s, and the centre of the oscillation is 0.2 + m g/k = 24.725 m below.
TEST(LinearSpring, OscillatesAboutItsEquilibrium) {
  Model<Bodies<Rigid<>>, Joints<>, Forces<OnDistance<LinearSpring>>> model{Gravity{0, 0, -9.81}};
  auto const mass = model.add(Rigid<>(100.0, Mat3::Identity(), Placement::at({0, 0, -0.3})), "mass");
  model.apply(OnDistance<LinearSpring>{{.stiffness = 40.0, .free = 0.2}}, model.ground().at({0, 0, 0}),
              mass.at(Vec3(0, 0, 0)), "spring");
  double const period = 9.934588265796102, centre = 0.2 + 981.0 / 40.0;
  for (auto const& [part, depth] : {std::pair{0.25, centre}, {0.5, 2.0 * centre - 0.3}, {0.75, centre}, {1.0, 0.3}}) {
    State x = model.reference_state();
    simulate(model, x, Radau{.tolerance = 1e-11}, {.end_time = part * period, .step = 1e-2}).run();
    EXPECT_NEAR(-position(model, x, mass.at(Vec3(0, 0, 0)))[2], depth, 1e-6) << part;
  }
}

// The drum stops after 2 s. With EA so large that the cable is nearly rigid, the mass has then risen by the reeled
// length of 1.5 m, and the winch has done the work m g s.
TEST(Winch, LiftsAMass) {
  using Hoist = OnDistance<Winch<SmoothRamp>>;
  Hoist const winch{{.axial_stiffness = 2e6,
                     .damping = 2e3,
                     .length = 3.0,
                     .reeled = {.target = 1.5, .duration = 2.0, .start = 0.5}}};
  double const stretch = 2.0 * 9.81 * 3.0 / 2e6;
  Hung<Hoist> hung(winch, 3.0 + stretch);
  EnergyAudit audit(hung.model);
  for (State const& now : simulate(hung.model, hung.x, Radau{.tolerance = 1e-10}, {.end_time = 3.0, .step = 1e-3}))
    audit.record(now);
  EXPECT_NEAR(hung.depth(hung.x), 1.5 + 2.0 * 9.81 * 1.5 / 2e6, 1e-7);
  EXPECT_NEAR(audit.work_of_loads(), 2.0 * 9.81 * 1.5, 1e-2);
  EXPECT_LT(audit.relative(), 1e-6);
}

// A ramp of the reeled length has kinks at both ends; steps of the run end there.
TEST(Winch, ReportsItsBreakpoints) {
  OnDistance<Winch<Ramp>> const winch{
      {.axial_stiffness = 1e3, .length = 3.0, .reeled = {.target = 0.5, .duration = 0.77, .start = 0.3331}}};
  Hung<OnDistance<Winch<Ramp>>> hung(winch, 3.0);
  int met = 0;
  for (State const& now :
       simulate(hung.model, hung.x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = 2.0, .step = 1e-2}))
    met += std::abs(now.t - 0.3331) < 1e-12 || std::abs(now.t - 1.1031) < 1e-12;
  EXPECT_EQ(met, 2);
}

TEST(Winch, RefusesToReelMoreThanItsLength) {
  Hung<OnDistance<Winch<Ramp>>> hung(
      {{.axial_stiffness = 1e3, .length = 1.0, .reeled = {.target = 2.0, .duration = 1.0}}}, 0.9);
  EXPECT_TRUE(
      has(refusal([&] {
            simulate(hung.model, hung.x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = 1.0, .step = 1e-2}).run();
          }),
          "Winch: the value of the reeled length must be less than the length of 1 m"));
}

TEST(SpringLaws, RefuseWrongNumbers) {
  auto const message = [](auto const& force) { return refusal([&] { force.check("\"part\""); }); };
  TwoSlopeSpring slopes{.stiffness_above = 1.0, .stiffness_below = 1.0};
  slopes.stiffness_below = -1.0;
  EXPECT_EQ(message(on_angle(slopes)),
            "\"part\": the stiffness below must be zero or positive, and finite, but is -1 N m/rad.");
  EXPECT_EQ(message(on_translation(TableSpring{progressive, -2.0})),
            "\"part\": the damping must be zero or positive, and finite, but is -2 N s/m.");
  EXPECT_EQ(message(on_distance(Rope{.stiffness = 1.0, .length = 0.0})),
            "\"part\": the free length of the rope must be positive and finite, but is 0 m.");
  EXPECT_EQ(message(on_distance(Winch<Constant>{.axial_stiffness = 0.0, .length = 1.0, .reeled = {0.0}})),
            "\"part\": the axial stiffness must be positive and finite, but is 0 N.");
}

}  // namespace spring_laws_test
}  // namespace polybody
