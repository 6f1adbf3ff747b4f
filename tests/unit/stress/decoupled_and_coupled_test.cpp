// Decoupled stress after a rigid run compared with the stress of flexible bodies. Both agree for small velocities.
// The difference grows with velocity². One cause is the effect of the deformation on the moment arm of centrifugal
// forces. The other cause is its effect on the motion of the body (coupling of mass and deformation, m_rf).
#include <polybody/stress/decoupled_stress.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/marker_frames.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/vibration/steady_rotation.hpp>

#include "support/held.hpp"

using namespace polybody;

namespace decoupled_and_coupled_test {

/// Rotation at `speed` [rad/s] from the start, or accelerated to it by SpinUp in `ramp` seconds.
struct Turn {
  double speed = 0.0, ramp = 0.0;
  Motion operator()(double t) const {
    return ramp > 0.0 ? SpinUp{.speed = speed, .duration = ramp}(t) : Motion{speed * t, speed, 0.0};
  }
};

// Flexible bodies are not recorded, because their stress is part of the run.
static_assert(HasRigidPoints<Rigid<>> && !HasRigidPoints<Ffr> && !HasRigidPoints<AncfCable<>> &&
              !HasRigidPoints<Lrvf<>>);

using Pin = Joint<Revolute, Constraint>;
using Drive = Joint<PrescribedAngle<Turn>, Constraint>;
using Clamp = Joint<Weld, Constraint>;
using Push = PointForce<SmoothRamp>;

template <class B>
struct Types {
  using Held = Bodies<Rigid<>, B>;
};
template <>
struct Types<Rigid<>> {
  using Held = Bodies<Rigid<>>;
};

/// Hub that rotates about z at the origin. An arm along x is clamped to it there. A force acts at the tip of the arm.
template <class B>
struct OnHub {
  Model<typename Types<B>::Held, Joints<Pin, Drive, Clamp>, Forces<PointForce<>, Push>> model;
  BodyHandle<Rigid<>> hub = model.add(Rigid<>(1.0, Mat3::Identity()), "hub");
  BodyHandle<B> arm;
  ElementHandle<Clamp> clamp;
  State x;

  OnHub(B const& body, Turn const& turn) : arm(model.add(body, "arm")) {
    model.connect(Pin{{.axis = {0, 0, 1}}, {}}, model.ground().at({0, 0, 0}), hub.at({0, 0, 0}), "shaft");
    model.connect(Drive{{turn, {0, 0, 1}}, {}}, model.ground().at({0, 0, 0}), hub.at({0, 0, 0}), "drive");
    if constexpr (B::observes == MarkerKind::frame) {
      clamp = model.connect(Clamp{}, hub.at({0, 0, 0}), arm.at(0.0), "clamp");
    } else {
      model.connect(Pin{{.axis = {1, 0, 0}}, {}}, hub.at({0, 0, 0}), arm.at(0.0), "clamp");
    }
    x = model.reference_state();
    double const speed = turn.ramp > 0.0 ? 0.0 : turn.speed;
    model.set_velocity(x, hub, Vec3::Zero(), {0, 0, speed});
    model.set_velocity(x, arm, Vec3::Zero(), {0, 0, speed});
  }
};

/// Record of a rigid arm in steady rotation, including forces: one state at two times.
BodyRecord steady_record(OnHub<Rigid<>>& rigid, double speed) {
  relative_equilibrium(rigid.model, rigid.x, {.angular_velocity = {0, 0, speed}});
  LoadRecorder recorder(rigid.model);
  recorder.add(rigid.arm);
  recorder.record(rigid.x);
  rigid.x.t += 1.0;
  recorder.record(rigid.x);
  return recorder.of(rigid.arm);
}

Bar steel() {
  return {.length = 1.0, .section = Circle{.radius = 0.01}, .material = Material{.density = 7800, .young = 2e11}};
}

/// σ = ½ ρω²(L² − x²) of the coupled formulation, in the middles of its elements. The linear shapes of the floating
/// frame give the mean over an element, which is too small by (h/L)²/12 of the largest stress.
template <class B>
void is_centrifugal(B const& body, double omega) {
  OnHub<B> flexible(body, {.speed = omega});
  relative_equilibrium(flexible.model, flexible.x, {.angular_velocity = {0, 0, omega}});
  double const full = 0.5 * 7800 * omega * omega;
  for (double const x : {0.03125, 0.28125, 0.53125, 0.78125, 0.96875}) {
    double const stress = axial_stress(flexible.model, flexible.x, flexible.arm.at(x), steel()),
                 expected = full * (1.0 - x * x);
    held({"thesis §4.3", "stress of a rotating rod, coupled [Pa]", By::closed_form, "½ ρω² (L² − x²)",
          std::is_same_v<B, Ffr> ? "Ffr, 16 elements" : "AncfCable, 16 elements"},
         stress, expected, 0.01 * expected, {equals("x/L", x)});
  }
}

TEST(DecoupledAndCoupled, BothGiveTheCentrifugalStress) {
  double const omega = 100.0, full = 0.5 * 7800 * omega * omega;
  OnHub<Rigid<>> rigid(Rigid<>::from(steel()), {.speed = omega});
  auto const decoupled = DecoupledStress::quasi_static(structure_of(steel(), 2), steady_record(rigid, omega));
  for (double const x : {0.03125, 0.28125, 0.53125, 0.78125, 0.96875})
    held({"thesis §4.3", "stress of a rod that turns steadily [Pa]", By::closed_form, "½ ρω² (L² − x²)",
          "Rigid, quasi-static"},
         decoupled.axial_stress(steel(), x).back(), full * (1.0 - x * x), 1e-8 * full, {equals("x/L", x)});
  is_centrifugal(Ffr::from(steel(), 16), omega);
  is_centrifugal(AncfCable<>::from(steel(), 16), omega);
}

/// Unit length, bending stiffness and mass per length: Ω² is ρAΩ²L⁴/EI.
Bar blade(double axial = 1e8) {
  return {.length = 1.0,
          .constants = BarConstants{
              .EA = axial, .EI = 1.0, .mass_per_length = 1.0, .GA = 1e8, .GJ = 1.0, .rotary_inertia = 1e-6}};
}

// A force P along the axis of rotation bends the blade by w = P x²(3L − x)/6EI. The centrifugal forces ρAΩ² x have
// the moment arm w and reduce the bending:
//   root moment = P L − ρAΩ² ∫ x w dx + O(Ω⁴) = P L (1 − 11/120 η),   η = ρAΩ²L⁴/EI,
// for the coupled body. For the decoupled body it is P L. δ/η = 11/120 − c η + …, extrapolated from η and 4η to zero.
TEST(DecoupledAndCoupled, PartByTheArmOfCentrifugalForcesAsTheSpeedSquared) {
  double const push = 1e-3;
  auto const part = [&](double omega) {
    OnHub<Rigid<>> rigid(Rigid<>::from(blade()), {.speed = omega});
    rigid.model.apply(PointForce<>{.force = {0, 0, push}}, rigid.arm.at(1.0), "tip");
    double const decoupled =
        std::abs(DecoupledStress::quasi_static(structure_of(blade(), 1), steady_record(rigid, omega))
                     .section_forces(0.0)
                     .back()[4]);
    EXPECT_NEAR(decoupled, push, 1e-9 * push);
    OnHub<Lrvf<>> flexible(Lrvf<>::from(blade(), 32), {.speed = omega});
    flexible.model.apply(PointForce<>{.force = {0, 0, push}}, flexible.arm.at(1.0), "tip");
    relative_equilibrium(flexible.model, flexible.x, {.angular_velocity = {0, 0, omega}}, {.tolerance = 1e-10});
    return 1.0 - std::abs(reaction(flexible.model, flexible.x, flexible.clamp).m[1]) / decoupled;
  };
  double const small = part(0.2), large = part(0.4);
  EXPECT_NEAR(std::log2(large / small), 2.0, 0.03);
  double const at_low = small / 0.04, at_high = large / 0.16;
  held({"thesis §4.3", "relative reduction of a root moment by centrifugal forces, divided by ρAΩ²L⁴/EI",
        By::closed_form, "11/120", "Lrvf, 32 elements, against Rigid, quasi-static"},
       at_low + (at_low - at_high) / 3.0, 11.0 / 120.0, 2e-3 * 11.0 / 120.0);
}

/// Tip displacement across the arm, in the arm's axes, for a run of three seconds in steps of 5 ms.
std::vector<double> coupled_tip(Turn const& turn, Push const& push) {
  OnHub<Ffr> flexible(Ffr::from(blade(1e4), 3, {.frame = FfrFrame::clamped, .stiffening = false}), turn);
  flexible.model.apply(push, flexible.arm.at(1.0), "tip");
  std::vector<double> out;
  for (State const& now : simulate(flexible.model, flexible.x, GeneralisedAlpha{}, {.end_time = 3.0, .step = 5e-3}))
    out.push_back(coordinates_of(flexible.model, now, flexible.arm)[7 + 6 * 2 + 1]);
  return out;
}
std::vector<double> decoupled_tip(Turn const& turn, Push const& push, bool follows) {
  OnHub<Rigid<>> rigid(Rigid<>::from(blade(1e4)), turn);
  rigid.model.apply(push, rigid.arm.at(1.0), "tip");
  LoadRecorder recorder(rigid.model);
  recorder.add(rigid.arm);
  for (State const& now : simulate(rigid.model, rigid.x, GeneralisedAlpha{}, {.end_time = 3.0, .step = 5e-3}))
    recorder.record(now);
  auto const stress =
      DecoupledStress::vibrating(structure_of(blade(1e4), 3), recorder.of(rigid.arm), GeneralisedAlpha{},
                                 {.follows_deformation = follows, .settled = false});
  VecX const tip = stress.displacements().row(6 * 3 + 1);
  return {tip.data(), tip.data() + tip.size()};
}
double parting(Turn const& turn, bool follows, double force = 1e-3) {
  Push const push{.force = {0, force, 0}, .axes = LoadAxes::marker, .law = {.target = 1.0, .duration = 1.0}};
  std::vector<double> const coupled = coupled_tip(turn, push), decoupled = decoupled_tip(turn, push, follows);
  EXPECT_EQ(coupled.size(), decoupled.size());
  double worst = 0.0, most = 0.0;
  for (std::size_t i = 0; i < coupled.size(); ++i) {
    worst = std::max(worst, std::abs(coupled[i] - decoupled[i]));
    most = std::max(most, std::abs(coupled[i]));
  }
  return worst / most;
}

// Ramp of a force across a rotating arm. The hub's motion is prescribed, so the arm does not act back on it. The
// decoupled equations of Wallin 2016 lack only the terms linear in the deformation and quadratic in the velocity.
// With these terms they are complete.
TEST(DecoupledAndCoupled, AgreeAtLowSpeedAndPartAsItsSquare) {
  double const slow = parting({.speed = 1e-3}, false), one = parting({.speed = 0.2}, false),
               two = parting({.speed = 0.4}, false);
  auto const parts = [](char const* motion, double found, double tolerance) {
    held_within({"thesis §4.3", "tip of a turning arm, decoupled, of the largest", By::itself,
                 "Ffr, 3 elements, coupled", motion},
                found, tolerance, {.scale = 1.0});
  };
  parts("Rigid, vibrating, loads follow, Ω = 0.4", parting({.speed = 0.4}, true), 1e-5);
  parts("Rigid, vibrating, Ω = 1e-3", slow, 1e-5);
  EXPECT_NEAR(std::log2(two / one), 2.0, 0.1);
  // acceleration: Ω˙ bends the arm, which is also reproduced, without a force that would rotate with the tip
  parts("Rigid, vibrating, loads follow, up to Ω = 1", parting({.speed = 1.0, .ramp = 2.0}, true, 0.0), 1e-4);
  EXPECT_GT(parting({.speed = 1.0, .ramp = 2.0}, false, 0.0), 0.1);
}

/// Half a period: the time of the first turning point of a motion that starts as 1 − cos, by a parabola through three
/// samples.
double half_period(std::vector<double> const& times, std::vector<double> const& x) {
  for (std::size_t i = 2; i + 1 < x.size(); ++i) {
    double const before = x[i] - x[i - 1], after = x[i + 1] - x[i];
    if (before * after <= 0.0) return times[i] + 0.5 * (times[i + 1] - times[i]) * (before + after) / (before - after);
  }
  ADD_FAILURE() << "no turning point";
  return 0.0;
}

// Free rod with a sudden force at one end. With unit EA, ρA and L the lowest free axial frequency is π. A frame fixed
// to the end has one mode, sin πx/2, of frequency π/2. In the coupled equations the frame recoils when the rod
// vibrates. Its mass reduces that of the mode by c² = 8/π², so the frequency is π/2 / √(1 − 8/π²), 15 % above π. This
// error is due to the single mode. In the decoupled equations the frame does not recoil, and π/2 remains. In the
// frame of the mean motion frame and mode do not interact, and one mode has the frequency π.
TEST(DecoupledAndCoupled, OnlyTheCoupledFrameRecoils) {
  Bar const rod{
      .length = 1.0,
      .constants = BarConstants{.EA = 1.0, .EI = 1.0, .mass_per_length = 1.0, .GJ = 1.0, .rotary_inertia = 1e-3}};
  Structure const structure = structure_of(rod, 16);
  MatX const tied = fixed_interface_modes(structure, 1), mean = free_interface_modes(structure, 1);
  PointForce<> const push{.force = {1e-3, 0, 0}};
  RunOptions const run{.end_time = 3.0, .step = 5e-3};

  Model<Bodies<Ffr>, Joints<>, Forces<PointForce<>>> flexible;
  auto const body = flexible.add(Ffr(structure, tied, {}), "rod");
  flexible.apply(push, body.at(0.0), "push");
  State x = flexible.reference_state();
  std::vector<double> times, force;
  for (State const& now : simulate(flexible, x, Trapezoidal{}, run)) {
    times.push_back(now.t);
    force.push_back(section_forces(flexible, now, body.at(0.5))[0]);
  }
  double const pi = std::numbers::pi, coupled = pi / half_period(times, force);

  Model<Bodies<Rigid<>>, Joints<>, Forces<PointForce<>>> rigid;
  auto const same = rigid.add(Rigid<>::from(rod), "rod");
  rigid.apply(push, same.at(0.0), "push");
  LoadRecorder recorder(rigid);
  recorder.add(same);
  State y = rigid.reference_state();
  for (State const& now : simulate(rigid, y, Trapezoidal{}, run)) recorder.record(now);
  double least = 0.0;
  auto const frequency = [&](Vibration const& how) {
    auto const stress = DecoupledStress::vibrating(structure, recorder.of(same), Trapezoidal{}, how);
    std::vector<double> n;
    for (Vec6 const& at : stress.section_forces(0.5)) n.push_back(at[0]);
    least = *std::min_element(n.begin(), n.end());
    return pi / half_period(stress.times(), n);
  };
  // 16 elements: (πh/2)²/24 = 4e-4 of π/2, four times that for π; steps of ωh = 0.016: 2e-5
  auto const of_rod = [](char const* source, char const* formulation, double value, double exact, double part) {
    held({"thesis §4.3", "frequency of a free rod pushed at its end [rad/s]", By::closed_form, source, formulation},
         value, exact, part * std::numbers::pi);
  };
  of_rod("π/2/√(1 − 8/π²)", "Ffr tied to the end, 1 mode, coupled", coupled,
         0.5 * pi / std::sqrt(1.0 - 8.0 / (pi * pi)), 2e-3);
  of_rod("π/2", "Rigid, vibrating, 1 mode of a frame tied to the end", frequency({.shapes = tied, .settled = false}),
         0.5 * pi, 5e-4);
  of_rod("π", "Rigid, vibrating, 1 mode of mean axes",
         frequency({.frame = ReferenceConditions::none(), .shapes = mean, .settled = false}), pi, 2e-3);
  // The static force in the middle is −F/2, applied at once. For the mode √2 cos πx, q¨ = √2 F cos πt. The part on
  // one side of the middle requires ∫ √2 cos πx q¨ dx = 2F/π cos πt. The error of the mesh is (πh)²/12 = 3e-3.
  held({"thesis §4.3", "least force in the middle of a free rod pushed at its end [N]", By::closed_form, "−F (½ + 2/π)",
        "Rigid, vibrating, 1 mode of mean axes"},
       least, -1e-3 * (0.5 + 2.0 / pi), 3e-6);
}

}  // namespace decoupled_and_coupled_test
