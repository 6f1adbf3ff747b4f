// Energy balance of a run: powers in any state, work compared with exact values, energy errors of integrators.
#include <polybody/run/energy_audit.hpp>

#include <gtest/gtest.h>

#include <numeric>
#include <sstream>

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/rigid/rigid_euler_parameters.hpp>
#include <polybody/forces/contact.hpp>
#include <polybody/forces/contact_group.hpp>
#include <polybody/forces/user_force.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/testing/differences.hpp>

#include "support/held.hpp"
#include "support/mixed_models.hpp"
#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace energy_audit_test {

double const gravity = 9.81;

Claim work(char const* what, By by, char const* source, char const* formulation) {
  return {"energy", what, by, source, formulation};
}

/// Accelerations x.a that satisfy M a − f + Gᵀλ = 0 for any λ, also if the constraint equations are violated. M is
/// computed column by column.
void obey(System& system, State& x) {
  Index const n = system.velocities();
  VecX at_rest(n), r(n), a = VecX::Zero(n);
  MatX mass(n, n);
  system.evaluate(x.q, x.v, x.t);
  system.residual(a, x.lambda, at_rest);
  for (Index j = 0; j < n; ++j) {
    a[j] = 1.0;
    system.residual(a, x.lambda, r);
    mass.col(j) = r - at_rest;
    a[j] = 0.0;
  }
  auto const lu = mass.partialPivLu();
  x.a = lu.solve(-at_rest);
  for (int k = 0; k < 2; ++k) {  // the columns are differences, and a distorted mesh has accelerations of 1e7
    system.residual(x.a, x.lambda, r);
    x.a -= lu.solve(r);
  }
}

/// Rate Ė by finite differences along the motion, minus drives + loads − dissipated, relative to the largest of
/// these.
template <class M>
double rate_mismatch(M const& model, State x) {
  System system(model);
  obey(system, x);
  system.evaluate(x.q, x.v, x.t);
  Powers const p = powers(system, x);
  double const rate = slope_at_zero(
      [&](double h) {
        State near = x;
        system.plus(x.q, h * x.v, near.q);
        near.v += h * x.a;
        near.t += h;
        return energy(model, near).total();
      },
      1e-4);
  return std::abs(rate - (p.drives + p.loads - p.dissipated)) /
         std::max({std::abs(p.drives), std::abs(p.loads), std::abs(p.dissipated)});
}

// Bodies of several kinds, joints with violated constraint equations and arbitrary multipliers, compliant joints,
// springs, loads. The differences have the errors h⁴ E⁽⁵⁾/30 and 1e-16 E/h, some 1e-10 of powers of some hundred
// watts.
TEST(Powers, AreTheRateOfTheEnergyInAnyState) {
  for (unsigned const seed : {1u, 2u, 3u}) {
    for (double const damping : {0.0, 5.0}) {
      auto const space = MixedSpace::model(damping);
      EXPECT_LT(rate_mismatch(space, scrambled(space, seed)), 1e-8);
      auto const plane = MixedPlane::model(damping);
      EXPECT_LT(rate_mismatch(plane, scrambled(plane, seed)), 1e-8);
    }
    auto const bushed = MixedBushings::model(3.0);
    EXPECT_LT(rate_mismatch(bushed, scrambled(bushed, seed)), 1e-8);
  }
}

/// Dissipated power of a single body in an arbitrary state.
template <class B>
double dissipated_alone(B const& body) {
  Model<Bodies<B>, Joints<>> model;
  model.add(body, "body");
  System system(model);
  State const x = scrambled(model);
  system.evaluate(x.q, x.v, x.t);
  return powers(system, x).dissipated;
}
/// Damping force as the difference between the body and one without damping: v·(f(undamped) − f).
template <class B>
double expected_alone(B const& body, B const& undamped) {
  Model<Bodies<B>, Joints<>> model, other;
  model.add(body, "body");
  other.add(undamped, "body");
  System system(model), free(other);
  State const x = scrambled(model);
  VecX r(x.v.size()), r0(x.v.size());
  system.evaluate(x.q, x.v, x.t);
  system.residual(x.a, x.lambda, r);
  free.evaluate(x.q, x.v, x.t);
  free.residual(x.a, x.lambda, r0);
  return x.v.dot(r - r0);
}
template <class Make>
void expect_lost_in(Make const& make) {
  Bar bar{.length = 1.3,
          .constants = BarConstants{.EA = 90,
                                    .EI = 4,
                                    .mass_per_length = 2.0,
                                    .GA = 30,
                                    .GJ = 2.5,
                                    .rotary_inertia = 0.05,
                                    .EI_y = 6,
                                    .GA_z = 20,
                                    .rotary_inertia_y = 0.08},
          .damping = {.axial = 0.01, .shear = 0.02, .bending = 0.03}};
  auto const body = make(bar);
  bar.damping = {};
  auto const undamped = make(bar);
  double const expected = expected_alone(body, undamped);
  EXPECT_GT(expected, 0.1);
  EXPECT_NEAR(dissipated_alone(body), expected, 1e-12 * expected);
  EXPECT_NEAR(dissipated_alone(undamped), 0.0, 1e-12 * expected);
}

// Sums of some hundred terms, none of them much larger than the sum.
TEST(Powers, OfDampingInBodiesOfEveryKind) {
  expect_lost_in([](Bar const& bar) { return planar::AncfCable<>::from(bar, 2); });
  expect_lost_in([](Bar const& bar) { return planar::Lrvf::from(bar, 2); });
  expect_lost_in([](Bar const& bar) { return AncfCable<>::from(bar, 2); });
  expect_lost_in([](Bar const& bar) { return AncfBeam<>::from(bar, 2); });
  expect_lost_in([](Bar const& bar) { return Lrvf<>::from(bar, 2); });
  expect_lost_in([](Bar const& bar) { return Ffr::from(bar, 2); });
  Mat3 const inertia = Vec3(0.3, 0.4, 0.5).asDiagonal();
  EXPECT_EQ(dissipated_alone(Rigid<>(2.0, inertia, {})), 0.0);
  EXPECT_EQ(dissipated_alone(Rigid<EulerParameters>(2.0, inertia, {})), 0.0);
}

/// Rod of 2 kg and 1 m, pinned at its end by Policy and raised from hanging by ψ(t). The moment of inertia about the
/// pin is 2/3 kg m².
template <class Policy, class DrivePolicy = Constraint>
struct Crane {
  using Pin = Joint<planar::Revolute, Policy>;
  using Drive = Joint<PrescribedAngle<SmoothRamp>, DrivePolicy>;
  Model<Bodies<planar::Rigid>, Joints<Pin, Drive>> model{Gravity{0, -gravity, 0}};
  SmoothRamp const law{.target = 2.0, .duration = 1.0};
  double const weight = 2.0 * gravity * 0.5, inertia = 2.0 / 3.0;

  explicit Crane(DrivePolicy const& policy = {}) {
    auto const rod = model.add(planar::Rigid(2.0, 2.0 / 12.0, Placement::planar(0.0, -0.5)), "rod");
    auto const home = model.ground().at({0, 0, 0});
    model.connect(Pin{}, home, rod.at(Vec2(0, 0.5)), "pin");
    model.connect(Drive{{.law = law}, policy}, home, rod.at(Vec2(0, 0.5)), "drive");
  }
  /// Energy audit of a run that ends while the drive is active.
  template <class I>
  auto run(I const& integrator, double h, double end_time = 0.6) const {
    EnergyAudit audit(model);
    State x = model.reference_state();
    for (State const& now : simulate(model, x, integrator, {.end_time = end_time, .step = h})) audit.record(now);
    return audit;
  }
};

// The drive prescribes the motion: its work is ½ J ψ̇² + m g l/2 (1 − cos ψ). The unaccounted energy is the error of the
// rule of the audit for the exact power P = (J ψ̈ + m g l/2 sin ψ) ψ̇. With equal steps, the corrections of the parabolas
// are −h/12 times the last less the first difference of P. Runge–Kutta contributes less than 1e-11 J.
TEST(EnergyAudit, OfADrivenPendulumFindsTheWorkOfItsDrive) {
  Crane<Constraint> const crane;
  Motion const psi = crane.law(0.6);
  double const raised = crane.weight * (1.0 - std::cos(psi.value)), moving = 0.5 * crane.inertia * psi.rate * psi.rate;
  auto const coarse = crane.run(RungeKutta4<Projection>{}, 5e-3), fine = crane.run(RungeKutta4<Projection>{}, 2.5e-3);
  char const* const by_rk = "planar Rigid, Runge–Kutta 4, h = 2.5e-3 s";
  held(work("kinetic energy of a driven pendulum [J]", By::closed_form, "½ J ψ̇²", by_rk), fine.kinetic(), moving, 1e-9);
  held(work("work of gravity on a driven pendulum [J]", By::closed_form, "½ m g l (cos ψ − 1)", by_rk),
       fine.work_of_gravity(), -raised, 1e-9);
  held(work("work of the drive of a pendulum [J]", By::closed_form, "½ J ψ̇² + ½ m g l (1 − cos ψ)", by_rk),
       fine.work_of_drives(), raised + moving, 1e-7 * (raised + moving));
  EXPECT_LT(fine.relative(), 1e-8);
  auto const error_of_rule = [&](int steps) {
    double const h = 0.6 / steps;
    std::vector<double> power;
    for (int i = 0; i <= steps; ++i) {
      Motion const m = crane.law(i * h);
      power.push_back((crane.inertia * m.acceleration + crane.weight * std::sin(m.value)) * m.rate);
    }
    std::size_t const n = power.size() - 1;
    double const sum = std::accumulate(power.begin(), power.end(), -0.5 * (power[0] + power[n]));
    return h * (sum - (power[n] - power[n - 1] - power[1] + power[0]) / 12.0) - (raised + moving);
  };
  held(work("unaccounted energy of a driven pendulum [J]", By::closed_form, "error of the rule for the exact power",
            by_rk),
       fine.unaccounted(), error_of_rule(240), 1e-11);
  EXPECT_NEAR(coarse.unaccounted(), error_of_rule(120), 1e-11);
  EXPECT_EQ(fine.dissipated(), 0.0);
  EXPECT_EQ(fine.stored(), 0.0);
  EXPECT_EQ(fine.work_of_loads(), 0.0);
}

TEST(EnergyAudit, OfAnImplicitRunConvergesLikeTheIntegrator) {
  Crane<Constraint> const crane;
  Motion const psi = crane.law(0.6);
  double const spent = crane.weight * (1.0 - std::cos(psi.value)) + 0.5 * crane.inertia * psi.rate * psi.rate;
  GeneralisedAlpha const alpha{.tolerance =
                                   1e-11};  // Newton's tolerance is negligible compared with the error of the step
  auto const coarse = crane.run(alpha, 5e-3), fine = crane.run(alpha, 2.5e-3);
  held({"energy", "work of the drive of a pendulum [J]", By::closed_form, "½ J ψ̇² + ½ m g l (1 − cos ψ)",
        "planar Rigid, generalised-α, h = 2.5e-3 s"},
       fine.work_of_drives(), spent, 1e-3 * spent);
  EXPECT_NEAR(coarse.unaccounted() / fine.unaccounted(), 4.0, 0.4);
}

// Joints without constraint equations in a step: `simulate` computes their forces.
TEST(EnergyAudit, OfJointCoordinatesIsThatOfRows) {
  auto const rows = Crane<Constraint>{}.run(RungeKutta4<Projection>{}, 2.5e-3);
  auto const joint_coordinates = Crane<JointCoordinates>{}.run(RungeKutta4<Projection>{}, 2.5e-3);
  held_within(work("work of the drive of a pendulum [J]", By::itself, "Constraint", "joint coordinates, Runge–Kutta 4"),
              std::abs(joint_coordinates.work_of_drives() - rows.work_of_drives()), 1e-8, {.scale = 1.0});
  EXPECT_NEAR(joint_coordinates.unaccounted(), rows.unaccounted(), 1e-8);
  EXPECT_GT(rows.work_of_drives(), 1.0);
}

// A compliant drive with k = 2e3 N m and c = 10 N m s prescribes the angle. Its work includes the energy of the rod
// and the energy that spring and damper store and dissipate.
TEST(EnergyAudit, OfACompliantDrivePaysForWhatItLosesAndStores) {
  Crane<Constraint, Penalty> const crane({.stiffness = 2e3, .damping = 10.0});
  auto const coarse = crane.run(RungeKutta4<Projection>{}, 5e-4), fine = crane.run(RungeKutta4<Projection>{}, 2.5e-4);
  EXPECT_GT(fine.dissipated(), 1e-4);
  EXPECT_GT(fine.stored(), 1e-4);
  EXPECT_LT(std::abs(fine.unaccounted()), 1e-2 * std::min(fine.dissipated(), fine.stored()));  // both are small
  EXPECT_GT(coarse.unaccounted() / fine.unaccounted(), 7.0);                                   // h³ or better
}

/// m ẍ + c ẋ + k x = 0 from x₀ at rest with m = 1, k = 100, c = 2: ẋ = −x₀ (k/ω_d) e^(−t) sin ω_d t, ω_d = √99, and
/// x = x₀ e^(−t) (cos ω_d t + sin ω_d t/ω_d).
double left_after(double t) {
  double const w = std::sqrt(99.0), decay = std::exp(-t);
  double const x = decay * (std::cos(w * t) + std::sin(w * t) / w), v = -100.0 / w * decay * std::sin(w * t);
  return 0.5 * (v * v + 100.0 * x * x);
}

// The oscillator as a spring along a slide, and as a compliant pin. Both dissipate the energy of the formula. The
// unaccounted part is at most the error of the parabolas, and falls with h³.
template <class M>
void expect_damped(char const* formulation, M const& model, State const& from) {
  double const end_time = 0.35;
  EXPECT_NEAR(energy(model, from).total(), 50.0, 1e-12);
  std::array<double, 2> left{};
  double h = 2e-3;
  for (double& unaccounted : left) {
    EnergyAudit audit(model);
    State x = from;
    for (State const& now : simulate(model, x, RungeKutta4<Projection>{}, {.end_time = end_time, .step = h}))
      audit.record(now);
    char const* const decay = "damped oscillator";
    held(work("what a damped oscillator has less [J]", By::closed_form, decay, formulation),
         -audit.kinetic() - audit.stored(), 50.0 - left_after(end_time), 1e-5,
         {equals("h", h)});  // RungeKutta4: (ωh)⁴ of 50 J
    held(work("what a damped oscillator loses [J]", By::closed_form, decay, formulation), audit.dissipated(),
         50.0 - left_after(end_time), 1e-4 * 50.0, {equals("h", h)});
    EXPECT_EQ(audit.work_of_loads(), 0.0);
    EXPECT_LT(audit.relative(), 1e-4);
    unaccounted = audit.unaccounted();
    h *= 0.5;
  }
  EXPECT_NEAR(left[0] / left[1], 8.0, 0.5);
}

TEST(EnergyAudit, OfASpringDamperLosesWhatTheFormulaSays) {
  using Slide = Joint<planar::Prismatic, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Slide>, Forces<SpringDamper>> model;
  auto const mass = model.add(planar::Rigid(1.0, 1.0, Placement::planar(3.0, 0.0)), "mass");
  auto const home = model.ground().at({0, 0, 0});
  model.connect(Slide{}, home, mass.at(Vec2(0, 0)), "slide");
  model.apply(SpringDamper{.stiffness = 100.0, .damping = 2.0, .free_length = 2.0}, home, mass.at(Vec2(0, 0)),
              "spring");
  expect_damped("SpringDamper, Runge–Kutta 4", model, model.reference_state());
}

TEST(EnergyAudit, OfADampedCompliantPinLosesWhatTheFormulaSays) {
  using Pin = Joint<planar::Revolute, Penalty>;
  Model<Bodies<planar::Rigid>, Joints<Pin>> model;
  auto const mass = model.add(planar::Rigid(1.0, 1.0), "mass");
  model.connect(Pin{{}, {.stiffness = 100.0, .damping = 2.0}}, model.ground().at({0, 0, 0}), mass.at(Vec2(0, 0)),
                "pin");
  State x = model.reference_state();
  x.q[0] = 1.0;
  expect_damped("Penalty, Runge–Kutta 4", model, x);
}

// Component of a bushing whose law has no potential. The work of its static part counts as that of a load. The work
// of its rate-dependent part is dissipated.
TEST(EnergyAudit, OfALawWithoutPotentialCountsAsALoad) {
  auto const law = [](auto const& x, auto const& rate) { return x * 100.0 + rate * 2.0; };
  LinearLaw const none{.stiffness = 0.0, .damping = 0.0};
  NonlinearBushing const bushing{law, none, none, none, none, none};
  using Mount = Joint<RelativeCoordinates, std::decay_t<decltype(bushing)>>;
  Model<Bodies<Rigid<>>, Joints<Mount>> model;
  auto const mass = model.add(Rigid<>(1.0, Mat3::Identity(), {}), "mass");
  model.connect(Mount{{.axis = Vec3::UnitZ()}, bushing}, model.ground().at({0, 0, 0}), mass.at(Vec3(0, 0, 0)), "mount");
  State x = model.reference_state();
  x.q[0] = 1.0;
  EXPECT_EQ(energy(model, x).joints, 0.0);
  EnergyAudit audit(model);
  for (State const& now : simulate(model, x, RungeKutta4<>{}, {.end_time = 0.35, .step = 1e-3})) audit.record(now);
  double const at_rest = 50.0 * (1.0 - x.q[0] * x.q[0]);
  EXPECT_NEAR(audit.work_of_loads(), at_rest, 1e-4 * 50.0);
  held(work("what a damped oscillator loses [J]", By::closed_form, "damped oscillator",
            "NonlinearBushing, Runge–Kutta 4"),
       audit.dissipated(), 50.0 - left_after(0.35), 1e-4 * 50.0);
  EXPECT_EQ(audit.stored(), 0.0);
  EXPECT_LT(audit.relative(), 1e-4);
}

// F²t²/2m + M²t²/2J. Both powers are linear in t, so the rule of the audit is exact.
TEST(EnergyAudit, OfPointLoadsIsExact) {
  Model<Bodies<planar::Rigid>, Joints<>, Forces<PointForce<>, PointMoment<>>> model;
  auto const body = model.add(planar::Rigid(2.0, 0.25), "body");
  model.apply(PointForce<>{.force = {3, 0, 0}}, body.at(Vec2(0, 0)), "force");
  model.apply(PointMoment<>{.moment = {0, 0, 0.5}}, body.at(Vec2(0, 0)), "moment");
  EnergyAudit audit(model);
  State x = model.reference_state();
  for (State const& now : simulate(model, x, RungeKutta4<>{}, {.end_time = 1.0, .step = 0.05})) audit.record(now);
  held(work("work of a force and a moment [J]", By::closed_form, "F²t²/2m + M²t²/2J", "planar Rigid, Runge–Kutta 4"),
       audit.work_of_loads(), 9.0 / 4.0 + 0.25 / 0.5, 1e-12);
  EXPECT_NEAR(audit.kinetic(), audit.work_of_loads(), 1e-12);
  EXPECT_LT(audit.relative(), 1e-13);
  held(work("power of a force and a moment [W]", By::closed_form, "F²t/m + M²t/J", "planar Rigid, Runge–Kutta 4"),
       audit.powers().loads, 3.0 * 1.5 + 0.5 * 2.0, 1e-12);
}

// m v̇ = −c v leaves e^(−2ct/m) of the kinetic energy. A user-defined force has no potential. It counts as a load,
// here with negative work.
TEST(EnergyAudit, OfAUsersForceIsTheWorkOfALoad) {
  auto const drag = user_force<1>([](auto const& frames, double) {
    std::array<Wrench<std::decay_t<decltype(frames[0].r[0])>>, 1> w;
    w[0].f = frames[0].v * -0.5;
    return w;
  });
  Model<Bodies<planar::Rigid>, Joints<>, Forces<std::decay_t<decltype(drag)>>> model;
  auto const body = model.add(planar::Rigid(1.0, 1.0), "body");
  model.apply(drag, body.at(Vec2(0, 0)), "drag");
  EnergyAudit audit(model);
  State x = model.reference_state();
  x.v[0] = 2.0;
  for (State const& now : simulate(model, x, RungeKutta4<>{}, {.end_time = 1.0, .step = 0.01})) audit.record(now);
  held(work("work of a user's drag [J]", By::closed_form, "½ m v₀² (e^(−2ct/m) − 1)", "UserForce, Runge–Kutta 4"),
       audit.work_of_loads(), 2.0 * (std::exp(-1.0) - 1.0), 2e-5);  // h²/12 [P′] = 8e-6 · 0.63 · 2
  EXPECT_EQ(audit.dissipated(), 0.0);
  EXPECT_LT(audit.relative(), 1e-5);
}

/// Balls of 1 kg and 0.1 m on the ground. Each has its own contact, or all are in a group. The i-th ball is 0.2 i
/// above the contact height.
template <class Law, bool grouped = false>
struct Balls {
  using F = std::conditional_t<grouped, ContactGroup<Law>, Law>;
  Model<Bodies<Rigid<>>, Joints<>, Forces<F>> model{Gravity{0, 0, -gravity}};
  State x;

  Balls(Law const& law, int n, double height, Vec3 const& v0, Vec3 const& spin = Vec3::Zero()) {
    std::vector<BodyHandle<Rigid<>>> balls;
    for (int i = 0; i < n; ++i)
      balls.push_back(
          model.add(Rigid<>(1.0, 0.004 * Mat3::Identity(), Placement::at({1.0 * i, 0, 0.1 + height + 0.2 * i}))));
    auto const floor = model.ground().at({0, 0, 0});
    if constexpr (grouped) {
      std::vector<decltype(balls[0].at(Vec3(0, 0, 0)))> many;
      for (auto const& b : balls) many.push_back(b.at(Vec3(0, 0, 0)));
      auto const group = model.apply(F{}, many, "balls");
      model.add_partner(group, law, floor, "ground");
    } else {
      for (auto const& b : balls) model.apply(law, b.at(Vec3(0, 0, 0)), floor);
    }
    x = model.reference_state();
    for (int i = 0; i < n; ++i) {
      x.v.segment<3>(6 * i) = v0;
      x.v.segment<3>(6 * i + 3) = spin;
    }
  }
  auto run(double end_time, double h) const {
    EnergyAudit audit(model);
    State now = x;
    for (State const& s : simulate(model, now, RungeKutta4<>{}, {.end_time = end_time, .step = h})) audit.record(s);
    return audit;
  }
};
using Floor = Contact<SphereOnPlane>;

// Penalty impact (C2, independent computation): a mass of 1 kg falls 1 m on k = 1e5 N/m, c = 63.2 N s/m. It separates
// at 3.2911781211 m/s when k d + c ḋ = 0. At this instant ½ k d² and m g d remain in the overlap. The first is lost,
// because no contact holds the spring of the floor compressed. The run begins at the impact, at which the power of
// the damper jumps by c v². The trapezoidal rule of the first step therefore misses half a step of it, the parabola of
// the second step adds a twelfth, and the integrator, whose first stage has the weight 1/6, gains a sixth.
TEST(EnergyAudit, OfAnImpactLosesWhatThePublishedReboundLeaves) {
  double const k = 1e5, c = 63.245553203, v = std::sqrt(2.0 * gravity), back = 3.2911781211, h = 2e-6;
  Balls<Floor> const ball({.geometry = {.radius = 0.1}, .normal = {.stiffness = k, .damping = c}}, 1, 0.0, {0, 0, -v});
  auto const audit = ball.run(0.02, h);
  double const jump = c * v * v * h;
  held({"C2", "energy lost by an impact on a spring and a damper [J]", By::independent, "rebound by an ordinary solver",
        "Contact, Runge–Kutta 4, h = 2e-6 s"},
       audit.dissipated(), 0.5 * v * v - 0.5 * back * back + gravity * c * back / k, jump);
  EXPECT_EQ(audit.stored(), 0.0);
  EXPECT_NEAR(audit.unaccounted(), (0.5 - 1.0 / 12.0 - 1.0 / 6.0) * jump, 0.02 * jump);
  EXPECT_LT(audit.relative(), 1e-3);
}

// Coulomb sliding (C3, closed form): the mass stops within 1.02 s and loses all of ½ v². With regularisation the
// remainder decays by e in v_s/(μ g) = 0.3 ms. The weight is supported from the start, and the friction acts at the
// centre.
TEST(EnergyAudit, OfASlidingMassLosesAllOfItsSpeedToFriction) {
  Floor const law{
      .geometry = {.radius = 0.0}, .normal = {.stiffness = 1e5}, .friction = {.coefficient = 0.3, .slip_speed = 1e-3}};
  Balls<Floor> const block(law, 1, -0.1 - gravity / 1e5, {3.0, 0, 0});
  auto const audit = block.run(1.5, 1e-4);
  held({"C3", "energy that a sliding mass loses to friction [J]", By::closed_form, "½ m v₀²",
        "Contact, Runge–Kutta 4, h = 1e-4 s"},
       audit.dissipated(), 4.5, 1e-4 * 4.5);
  EXPECT_NEAR(audit.kinetic(), -4.5, 1e-5);
  EXPECT_LT(audit.relative(), 1e-4);
}

// Bounces with friction and spin, in steps of h and of h/8. The force of the damper jumps at each impact. The error
// is of first order, about 1/8, because the impact is within a step. The force of Hunt and Crossley has no jump. Its
// error is at least of second order, 1/64.
template <class N>
std::array<double, 2> unaccounted_of_bounces(N const& normal, double h) {
  Contact<SphereOnPlane, N> const law{
      .geometry = {.radius = 0.1}, .normal = normal, .friction = {.coefficient = 0.3, .slip_speed = 0.05}};
  Balls<Contact<SphereOnPlane, N>> const ball(law, 1, 0.2, {2.0, 0, 0}, {0, -3.0, 1.0});
  std::array<double, 2> sums{};
  for (double& sum : sums) {
    auto const audit = ball.run(1.2, h);
    EXPECT_GT(audit.dissipated(), 1.0);
    EXPECT_LT(audit.relative(), 0.01);
    sum = std::abs(audit.unaccounted());
    h *= 0.125;
  }
  return sums;
}

TEST(EnergyAudit, OfABouncingBallWithFrictionAddsUp) {
  auto const jumping = unaccounted_of_bounces(SpringDamperContact{.stiffness = 1e4, .damping = 20.0}, 2e-4);
  EXPECT_LT(jumping[1], 0.25 * jumping[0]);
  auto const smooth =
      unaccounted_of_bounces(HuntCrossleyContact{.stiffness = 1e5, .exponent = 1.5, .damping = 0.2}, 2e-4);
  EXPECT_LT(smooth[1], 0.02 * smooth[0]);
}

// The energies of a group are the sums over its pairs.
TEST(EnergyAudit, OfAGroupOfContactsIsThatOfTheContacts) {
  Floor const law{.geometry = {.radius = 0.1},
                  .normal = {.stiffness = 1e4, .damping = 20.0},
                  .friction = {.coefficient = 0.3, .slip_speed = 0.05}};
  auto const each = Balls<Floor>(law, 3, 0.2, {2.0, 0, 0}).run(0.5, 2e-4);
  auto const group = Balls<Floor, true>(law, 3, 0.2, {2.0, 0, 0}).run(0.5, 2e-4);
  EXPECT_GT(group.dissipated(), 1.0);
  held_within(work("energy that three bouncing balls lose [J]", By::itself, "contacts one by one",
                   "ContactGroup, Runge–Kutta 4"),
              std::abs(group.dissipated() - each.dissipated()), 1e-10, {.scale = 1.0});
  EXPECT_NEAR(group.stored(), each.stored(), 1e-10);
  EXPECT_NEAR(group.unaccounted(), each.unaccounted(), 1e-10);
  EXPECT_LT(group.relative(), 0.01);
}

/// Free mass of 1 kg on a spring of k [N/m] without free length, released from x = 1 m: ω² = k.
EnergyAudit of_oscillator(Model<Bodies<planar::Rigid>, Joints<>, Forces<SpringDamper>> const& model, double rho_inf,
                          double h, int steps) {
  EnergyAudit audit(model);
  State x = model.reference_state();
  GeneralisedAlpha const integrator{.rho_inf = rho_inf, .tolerance = 1e-12};
  RunOptions options{.end_time = h * steps, .step = h};
  options.limits.energy = std::numeric_limits<double>::infinity();  // a step of 1e4/ω overshoots before the damping
  for (State const& now : simulate(model, x, integrator, options)) audit.record(now);
  return audit;
}

// Linear oscillator (I1, closed form and independent computation): ω = 1 and h = 0.2, after 50 steps of ρ∞ = 0 q =
// −0.887774657662 and h v = 0.077081882918. The method dissipates the remainder of ½. ρ∞ = 1 is the trapezoidal rule,
// which conserves the energy of a linear oscillator. Steps of 1e4/ω with ρ∞ = 0 dissipate all energy.
TEST(EnergyAudit, ShowsWhatTheIntegratorLoses) {
  auto const oscillator = [](double k) {
    Model<Bodies<planar::Rigid>, Joints<>, Forces<SpringDamper>> model;
    auto const mass = model.add(planar::Rigid(1.0, 1.0, Placement::planar(1.0, 0.0)), "mass");
    model.apply(SpringDamper{.stiffness = k, .free_length = 0.0}, model.ground().at({0, 0, 0}), mass.at(Vec2(0, 0)),
                "spring");
    return model;
  };
  auto const soft = oscillator(1.0), stiff = oscillator(1e10);
  double const q = -0.887774657662, v = 0.077081882918 / 0.2;
  auto const damping = of_oscillator(soft, 0.0, 0.2, 50);
  held({"I1", "energy that the method takes off an oscillator in 50 steps [J]", By::independent,
        "formulas of Arnold & Brüls, programmed apart", "generalised-α, ρ = 0, ωh = 0.2"},
       damping.unaccounted(), 0.5 - 0.5 * (q * q + v * v), 1e-11);
  EXPECT_EQ(damping.dissipated(), 0.0);
  held_within({"I1", "energy that the method takes off an oscillator in 50 steps [J]", By::closed_form, "0",
               "generalised-α, ρ = 1, ωh = 0.2"},
              std::abs(of_oscillator(soft, 1.0, 0.2, 50).unaccounted()), 1e-11, {.scale = 0.5});
  auto const quenched = of_oscillator(stiff, 0.0, 0.1, 20);
  held({"I1", "energy that the method takes off an oscillator it does not resolve [J]", By::closed_form, "½ k x₀²",
        "generalised-α, ρ = 0, ωh = 1e4"},
       quenched.unaccounted(), 0.5e10, 1e-6 * 0.5e10);
  EXPECT_EQ(quenched.dissipated(), 0.0);
}

// Two swinging damped cables, pinned to each other by linear constraint equations. The dissipated energy is measured,
// and the balance converges with h².
template <class Policy>
auto of_cables(double h) {
  using Pin = Joint<planar::Revolute, Policy>;
  Model<Bodies<planar::AncfCable<>>, Joints<Pin>> model{Gravity{0, -gravity, 0}};
  Bar bar{.length = 0.5,
          .constants = BarConstants{.EA = 200.0, .EI = 0.02, .mass_per_length = 0.4},
          .damping = {.axial = 0.01, .bending = 0.01}};
  auto const a = model.add(planar::AncfCable<>::from(bar, 2), "a");
  bar.placement = Placement::planar(0.5, 0.0);
  auto const b = model.add(planar::AncfCable<>::from(bar, 2), "b");
  model.connect(Pin{}, model.ground().at({0, 0, 0}), a.at(0.0), "root");
  model.connect(Pin{}, a.at(0.5), b.at(0.0), "hinge");
  EnergyAudit audit(model);
  State x = model.reference_state();
  for (State const& now : simulate(model, x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = 0.3, .step = h}))
    audit.record(now);
  return std::array{audit.dissipated(), audit.unaccounted(), audit.relative(), audit.work_of_drives()};
}

TEST(EnergyAudit, OfDampedCablesOnLinearRowsAddsUp) {
  auto const coarse = of_cables<AncfLinear>(1e-3), fine = of_cables<AncfLinear>(2.5e-4),
             held = of_cables<Constraint>(2.5e-4);
  EXPECT_GT(fine[0], 1e-3);
  EXPECT_NEAR(fine[0], held[0], 1e-3 * held[0]);
  EXPECT_LT(fine[2], 1e-4);
  EXPECT_NEAR(coarse[1] / fine[1], 16.0, 4.0);
  EXPECT_EQ(fine[3], 0.0);
}

// Bar with an initial stretch of a tenth that is later free of strain.
TEST(EnergyAudit, CountsWhatIsStoredFromTheStart) {
  Model<Bodies<AncfCable<>>, Joints<>> model;
  model.add(
      AncfCable<>::from({.length = 1.0, .constants = BarConstants{.EA = 100.0, .EI = 1.0, .mass_per_length = 1.0}}, 2),
      "bar");
  State x = model.reference_state(), stretched = x;
  stretched.q *= 1.1;
  EnergyAudit audit(model);
  audit.start(stretched);
  x.t = 1.0;
  audit.record(x);
  double const strain = 0.5 * (1.1 * 1.1 - 1.0);
  EXPECT_NEAR(audit.stored(), -0.5 * 100.0 * strain * strain, 1e-12);
  std::ostringstream text;
  text << audit;
  EXPECT_TRUE(has(text.str(), "work of drives 0, loads 0, gravity 0 J\nkinetic energy 0, stored -0.551"));
  EXPECT_TRUE(has(text.str(), "dissipated 0 J\nunaccounted 0.551"));
  EXPECT_TRUE(has(text.str(), " of the turnover\n"));
}

TEST(EnergyAudit, BeginsAnewAndRefusesTimeThatRunsBackAndStatesOfOtherModels) {
  Crane<Constraint> const crane;
  auto audit = crane.run(RungeKutta4<Projection>{}, 0.01);
  EXPECT_GT(audit.work_of_drives(), 1.0);
  State const x = crane.model.reference_state();
  EXPECT_TRUE(has(refusal([&] { audit.record(x); }), "is earlier than the last state at t = 0.6 s. Call start()"));
  audit.start(x);
  EXPECT_EQ(audit.work_of_drives(), 0.0);
  EXPECT_EQ(audit.unaccounted(), 0.0);
  EXPECT_EQ(audit.relative(), 0.0);
  State other = x;
  other.lambda.resize(0);
  EXPECT_TRUE(has(refusal([&] { audit.start(other); }), "The state does not fit the model"));
  EXPECT_TRUE(has(refusal([&] { audit.record(other); }), "The state does not fit the model"));
}

}  // namespace energy_audit_test
