// Stress after a rigid run. The references are textbook formulas of rigid rods in motion, and the equations of motion
// of a part cut from a body. The comparison with the coupled formulations is in decoupled_and_coupled_test.cpp.
#include <polybody/stress/decoupled_stress.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ffr/matrix_structure.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/integrators/adams_bashforth_moulton.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/signals/filter.hpp>

#include "support/held.hpp"
#include "support/refusal.hpp"

using namespace polybody;

namespace decoupled_stress_test {

constexpr double pi = std::numbers::pi, g = 9.81, density = 7800, young = 2e11, length = 1.5, width = 0.03,
                 height = 0.02;
constexpr double area = width * height, mass = density * area * length;

Bar rod(Placement const& placement = {}) {
  return {.length = length,
          .section = Rectangle{.height = height, .width = width},
          .material = Material{.density = density, .young = young},
          .placement = placement};
}

using Pin = Joint<Revolute, Constraint>;
using Ball = Joint<Spherical, Constraint>;
using Clamp = Joint<Weld, Constraint>;
using Arms = Model<Bodies<Rigid<>>, Joints<Pin, Ball, Clamp>, Forces<PointForce<>, PointForce<Ramp>>>;
using Exact = RungeKutta4<Projection>;  // its accelerations satisfy the constraint equations to round-off

/// Record of `body` in a run of `model` from x.
template <class M, class B, class I>
BodyRecord record(M const& model, BodyHandle<B> const& body, State x, I const& integrator, RunOptions const& options) {
  LoadRecorder recorder(model);
  recorder.add(body);
  for (State const& now : simulate(model, x, integrator, options)) recorder.record(now);
  return recorder.of(body);
}

double largest(std::vector<Vec6> const& a, std::vector<Vec6> const& b) {
  EXPECT_EQ(a.size(), b.size());
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).norm());
  return most;
}

// σ(x) = ½ ρ ω² (L² − x²) for any number of elements, and no other stress.
TEST(DecoupledStress, OfARotatingRodIsTheCentrifugalOne) {
  Placement const askew = Placement::at({1, 2, 3}, {0.4, -0.9, 1.7});
  Arms model;
  auto const arm = model.add(Rigid<>::from(rod(askew)), "arm");
  model.connect(Pin{{.axis = askew.axes.col(2)}, {}}, model.ground().at(askew), arm.at(0.0), "pin");
  State x = model.reference_state();
  double const omega = 80.0;
  Vec3 const spin = omega * askew.axes.col(2);
  model.set_velocity(x, arm, -spin.cross(askew.origin), spin);
  BodyRecord const run =
      record(model, arm, x, Exact{}, {.end_time = 0.01, .step = 5e-4});  // ωh = 0.04: (ωh)⁶/144 per step
  double const full = 0.5 * density * omega * omega * length * length;
  for (Index const n : {1, 3, 8}) {
    auto const stress = DecoupledStress::quasi_static(structure_of(rod(), n), run);
    for (double const part : {0.0, 0.1, 1.0 / 3.0, 0.5, 0.77, 0.99, 1.0}) {
      for (double const s : stress.axial_stress(rod(), part * length, 0.5 * height, 0.5 * width))
        held(
            {"thesis §4.3", "stress of a rotating rod [Pa]", By::closed_form, "½ ρω² (L² − x²)", "Rigid, quasi-static"},
            s, full * (1.0 - part * part), 1e-9 * full, {equals("x/L", part), full});
      for (double const e : stress.axial_strain(part * length))
        EXPECT_NEAR(e, full / young * (1.0 - part * part), 1e-9 * full / young);
    }
  }
}

/// Rod hinged at its first end, swinging from the horizontal. With φ from the downward vertical, J φ¨ = −½ m g L sin
/// φ about the hinge, J = mL²/3 + ρI L. The part beyond the section at x has the mass m′ = ρA(L − x). Along the rod,
/// across it and about its own middle it requires
///   N = m′ (φ˙² (L + x)/2 + g cos φ),   F = m′ (φ¨ (L + x)/2 + g sin φ),   M = ½ (L − x) F + (m′ (L − x)²/12 + ρI (L −
///   x)) φ¨.
/// Without ρI: F = ρA g sin φ (L − x)(L − 3x)/4L and M = −ρA g sin φ x (L − x)²/4L. The moment is largest at L/3, the
/// section at which falling chimneys break.
struct Swing {
  double axial, across, bending;
  Swing(double x, double phi, double rate, double rotary) {
    double const beyond = density * area * (length - x), rest = length - x;
    double const acceleration =
        -0.5 * mass * g * length * std::sin(phi) / (mass * length * length / 3.0 + rotary * length);
    axial = beyond * (rate * rate * 0.5 * (length + x) + g * std::cos(phi));
    across = beyond * (acceleration * 0.5 * (length + x) + g * std::sin(phi));
    bending = 0.5 * rest * across + (beyond * rest * rest / 12.0 + rotary * rest) * acceleration;
  }
};

// In the plane x–y the rod's x axis is at the angle φ − π/2, and a positive rotation φ is from x to y. The force of
// the part beyond has the opposite sign.
template <class M, class B>
void swings(M const& model, BodyHandle<B> const& arm) {
  BodyRecord const run = record(model, arm, model.reference_state(), Exact{}, {.end_time = 1.5, .step = 2e-3});
  double const rotary = constants(rod()).rotary_inertia, weight = mass * g;
  auto const stress = DecoupledStress::quasi_static(structure_of(rod(), 4), run);
  double least = 10.0, most = 0.0;
  for (double const part : {0.0, 0.2, 1.0 / 3.0, 0.5, 0.9, 1.0}) {
    std::vector<Vec6> const forces = stress.section_forces(part * length);
    double worst = 0.0;
    for (std::size_t i = 0; i < forces.size(); ++i) {
      Frame<double> const& f = run.samples[i].frame;
      double const phi = std::atan2(f.A(1, 0), f.A(0, 0)) + 0.5 * pi;
      Swing const at(part * length, phi, f.w[2], rotary);
      Vec6 const expected = (Vec6() << at.axial, -at.across, 0.0, 0.0, 0.0, -at.bending).finished();
      worst = std::max(worst, (forces[i] - expected).norm() / weight);
      least = std::min(least, at.axial / weight);
      most = std::max(most, at.axial / weight);
    }
    held_within({"thesis §4.3", "section forces of a swinging rod, of its weight", By::closed_form,
                 "what the part beyond the section needs",
                 std::is_same_v<B, Rigid<>> ? "Rigid, quasi-static" : "planar Rigid, quasi-static"},
                worst, 1e-8, {equals("x/L", part), 1.0});
  }
  EXPECT_GT(most, 2.4);  // at the lowest point the hinge carries (1 + 3/2) m g
  EXPECT_LT(least, 1e-3);
}

TEST(DecoupledStress, OfASwingingRodIsTheTextbooks) {
  Arms model{Gravity{0, -g, 0}};
  auto const arm = model.add(Rigid<>::from(rod()), "arm");
  model.connect(Pin{{.axis = {0, 0, 1}}, {}}, model.ground().at({0, 0, 0}), arm.at(0.0), "pin");
  swings(model, arm);
}

TEST(DecoupledStress, OfASwingingRodInThePlaneIsTheTextbooks) {
  Model<Bodies<planar::Rigid>, Joints<Joint<planar::Revolute, Constraint>>> model{Gravity{0, -g, 0}};
  auto const arm = model.add(planar::Rigid::from(rod()), "arm");
  model.connect(Joint<planar::Revolute, Constraint>{}, model.ground().at({0, 0, 0}), arm.at(0.0), "pin");
  swings(model, arm);
}

TEST(DecoupledStress, OfAFallingBodyIsNone) {
  Arms model{Gravity{0, 0, -g}};
  auto const arm = model.add(Rigid<>::from(rod(Placement::at({0, 0, 0}, {0, 0.7, 0}))), "arm");
  BodyRecord const run = record(model, arm, model.reference_state(), Exact{}, {.end_time = 0.1, .step = 0.01});
  for (Vec6 const& n : DecoupledStress::quasi_static(structure_of(rod(), 3), run).section_forces(0.4))
    held_within({"thesis §4.3", "section forces of a rod that falls, of its weight", By::closed_form, "0",
                 "Rigid, quasi-static"},
                n.norm() / (mass * g), 1e-12, {.scale = 1.0});
}

// Cantilever under its weight w per length: Q = w (L − x), M = w (L − x)²/2, with the upper side in tension. A
// vibrating cantilever that has settled has the same stress. A sudden load is solved in one mode φ with λ =
// 1.8751041, σ = 0.7340955, ω = (λ/L)² √(EI/ρA) and ∫φ²dx = L. From q¨ = w/ρA · ∫φdx/L · cos ωt, ∫φdx = 2σL/λ and
// ∫xφdx = 2L²/λ² (two integrations by parts, φ'''' = (λ/L)⁴φ), the root moment is
//   ½ wL² − ∫ρA xφ q¨ dx = ½ wL² (1 − 8σ/λ³ cos ωt).
TEST(DecoupledStress, OfACantileverIsThatOfStatics) {
  Arms model{Gravity{0, -g, 0}};
  auto const arm = model.add(Rigid<>::from(rod()), "arm");
  model.connect(Clamp{}, model.ground().at({0, 0, 0}), arm.at(0.0), "clamp");
  BodyRecord const run =
      record(model, arm, model.reference_state(), GeneralisedAlpha{}, {.end_time = 1.0, .step = 5e-3});
  double const lambda = 1.875104069, sigma = 0.7340955, w = density * area * g, root = 0.5 * w * length * length;
  double const omega = std::pow(lambda / length, 2) * height * std::sqrt(young / (12.0 * density));
  Structure const structure = structure_of(rod(), 6);
  auto const still = DecoupledStress::quasi_static(structure, run);
  auto const settled = DecoupledStress::vibrating(structure, run, GeneralisedAlpha{}, {});
  for (double const x : {0.0, 0.3, 0.8, 1.4}) {
    double const rest = length - x;
    Vec6 const expected = (Vec6() << 0.0, -w * rest, 0.0, 0.0, 0.0, -0.5 * w * rest * rest).finished();
    Instance const at{equals("x", x), 1.0};
    for (Vec6 const& n : still.section_forces(x))
      held_within({"thesis §4.3", "section forces of a cantilever, of ½ w L²", By::closed_form,
                   "w (L − x), ½ w (L − x)²", "Rigid, quasi-static"},
                  (n - expected).norm() / root, 1e-9, at);
    held_within({"thesis §4.3", "section forces of a cantilever, of ½ w L²", By::itself, "quasi-static",
                 "Rigid, settled vibration"},
                largest(still.section_forces(x), settled.section_forces(x)) / root, 1e-7, at);
    double const fibre = still.axial_stress(rod(), x, 0.5 * height)[0], modulus = width * height * height / 6.0;
    held({"thesis §4.3", "stress in the outermost fibre of a cantilever [Pa]", By::closed_form, "½ w (L − x)²/W",
          "Rigid, quasi-static"},
         fibre, 0.5 * w * rest * rest / modulus, 1e-9 * root / modulus, {equals("x", x)});
    held({"thesis §4.3", "shear stress in the middle of a cantilever [Pa]", By::closed_form, "3/2 w (L − x)/A",
          "Rigid, quasi-static"},
         still.stress(rod(), x, 0.0, 0.0)[0].shear[0], -1.5 * w * rest / area, 1e-9 * w * length / area,
         {equals("x", x)});
  }
  // the damping of the body and the damping of the option are equivalent
  Bar slow = rod();
  slow.damping = {.axial = 2e-3, .shear = 2e-3, .bending = 2e-3};
  Vibration const from_rest{.settled = false};
  Vibration damped = from_rest;
  damped.stiffness_damping = 2e-3;
  auto const by_bars = DecoupledStress::vibrating(structure_of(slow, 6), run, GeneralisedAlpha{}, from_rest);
  auto const by_option = DecoupledStress::vibrating(structure, run, GeneralisedAlpha{}, damped);
  EXPECT_LT(largest(by_bars.section_forces(0.3), by_option.section_forces(0.3)), 1e-9 * root);
  MatX const shape = fixed_interface_modes(structure, 1);
  auto const sudden = DecoupledStress::vibrating(structure, run, Exact{}, {.shapes = shape, .settled = false});
  std::vector<Vec6> const forces = sudden.section_forces(0.0);
  for (std::size_t i = 0; i < forces.size(); ++i)
    held({"thesis §4.3", "root moment of a cantilever under a sudden load, of ½ w L²", By::closed_form,
          "1 − 8σ/λ³ cos ωt", "Rigid, vibrating, 1 mode"},
         forces[i][5] / -root, 1.0 - 8.0 * sigma / std::pow(lambda, 3) * std::cos(omega * run.samples[i].t), 0.01,
         {equals("t", run.samples[i].t), 1.0});
}

// Bending in the direction of the width: the side at −z is in tension, with the modulus of the other axis.
TEST(DecoupledStress, OfACantileverThatBendsAcross) {
  Arms model{Gravity{0, 0, g}};
  auto const arm = model.add(Rigid<>::from(rod()), "arm");
  model.connect(Clamp{}, model.ground().at({0, 0, 0}), arm.at(0.0), "clamp");
  BodyRecord const run =
      record(model, arm, model.reference_state(), GeneralisedAlpha{}, {.end_time = 0.1, .step = 5e-3});
  auto const stress = DecoupledStress::quasi_static(structure_of(rod(), 6), run);
  double const w = density * area * g, x = 0.4, moment = 0.5 * w * std::pow(length - x, 2),
               modulus = height * width * width / 6.0;
  for (double const side : {-1.0, 0.5}) {
    double const fibre = -side * moment / modulus;
    held({"thesis §4.3", "stress of a cantilever that bends across [Pa]", By::closed_form, "½ w (L − x)²/W",
          "Rigid, quasi-static"},
         stress.axial_stress(rod(), x, 0.0, 0.5 * side * width)[0], fibre, 1e-9 * moment / modulus,
         {equals("side", side)});
    EXPECT_NEAR(stress.axial_strain(x, 0.0, 0.5 * side * width)[0], fibre / young, 1e-9 * moment / modulus / young);
    EXPECT_NEAR(fibre_stress(rod(), stress.section_forces(x)[0], 0.0, 0.5 * side * width), fibre,
                1e-9 * moment / modulus);
  }
}

// ε − y κ_z + z κ_y with the strains in the order ε, γ_y, γ_z, κ_x, κ_y, κ_z.
TEST(FibreStrain, OfASectionThatStaysPlane) {
  Vec6 const strains = (Vec6() << 1.0, 20.0, 30.0, 40.0, 0.5, 0.25).finished();
  EXPECT_DOUBLE_EQ(fibre_strain(strains, 2.0, 3.0), 1.0 - 2.0 * 0.25 + 3.0 * 0.5);
}

// Rod that rotates and vibrates. If loads follow its deformation, the section force at its free end is zero. Without
// ω² u, some 1e-4 of the centrifugal force here, an error of 5e-3 of it would remain relative to the root.
TEST(DecoupledStress, OfAVibratingRodEndsInNothing) {
  Arms model;
  auto const arm = model.add(Rigid<>::from(rod()), "arm");
  model.connect(Pin{{.axis = {0, 0, 1}}, {}}, model.ground().at({0, 0, 0}), arm.at(0.0), "pin");
  State x = model.reference_state();
  model.set_velocity(x, arm, Vec3::Zero(), Vec3(0, 0, 300.0));
  BodyRecord const run = record(model, arm, x, Exact{}, {.end_time = 2e-3, .step = 1e-5});
  auto const stress =
      DecoupledStress::vibrating(structure_of(rod(), 5), run, GeneralisedAlpha{}, {.follows_deformation = true});
  double const root = 0.5 * mass * length * 300.0 * 300.0;
  for (Vec6 const& n : stress.section_forces(length))
    held_within({"thesis §4.3", "section forces at the free end of a rod that spins and shakes, of the root's",
                 By::closed_form, "0", "Rigid, vibrating, loads follow"},
                n.norm() / root, 1e-8, {.scale = 1.0});
  EXPECT_NEAR(stress.section_forces(0.0).back()[0], root, 5e-3 * root);
}

// Equilibrium of the part beyond any section: its inertia is the sum of the section forces and of its loads. The
// model has a ball joint, an oblique follower load at the tip and gyroscopic terms. All six components are compared,
// including the rotary inertia of the section.
TEST(DecoupledStress, GivesWhatTheCutOffPartNeeds) {
  Arms model{Gravity{1, -2, -g}};
  Placement const askew = Placement::at({0, 0, 0}, {0.3, 0.2, -0.4});
  auto const arm = model.add(Rigid<>::from(rod(askew)), "arm");
  model.connect(Ball{}, model.ground().at({0, 0, 0}), arm.at(0.0, 0.01, -0.01), "ball");
  Vec3 const push(40, 60, -80);
  double const off_y = 0.01, off_z = 0.015, midway = 0.6;
  model.apply(PointForce<>{.force = push, .axes = LoadAxes::marker}, arm.at(length, off_y, off_z), "tip");
  model.apply(PointForce<>{.force = -2.0 * push, .axes = LoadAxes::marker}, arm.at(midway), "midway");
  State x = model.reference_state();
  Vec3 const spin(3.0, -4.0, 5.0), hinge = askew.axes * Vec3(0.0, 0.01, -0.01);
  model.set_velocity(x, arm, -spin.cross(hinge), spin);
  State start = x;
  assemble(model, start);
  BodyRecord const run = record(model, arm, start, Exact{}, {.end_time = 0.4, .step = 1e-3});
  Structure const structure = structure_of(rod(), 4);  // the intermediate load is within an element
  auto const stress = DecoupledStress::quasi_static(structure, run);
  BarConstants const c = constants(rod());
  double size = 0.0;
  for (Vec6 const& n : stress.section_forces(0.5)) size = std::max(size, n.norm());
  for (double const s : {0.0, 0.25, 0.6, 0.7, 1.2, 1.5}) {
    double worst = 0.0;
    std::vector<Vec6> const forces = stress.section_forces(s);
    double const rest = length - s, beyond = c.mass_per_length * rest, along = beyond * rest * rest / 12.0;
    Mat3 const inertia = Vec3((c.rotary_inertia + *c.rotary_inertia_y) * rest, along + *c.rotary_inertia_y * rest,
                              along + c.rotary_inertia * rest)
                             .asDiagonal();
    for (std::size_t i = 0; i < forces.size(); ++i) {
      BodySample const& at = run.samples[i];
      Mat3 const to_body = at.frame.A.transpose();
      Vec3 const omega = to_body * at.frame.w, alpha = to_body * at.angular_acceleration, middle(0.5 * s, 0, 0);
      Vec3 const a = to_body * (at.acceleration - run.gravity) + alpha.cross(middle) + omega.cross(omega.cross(middle));
      Vec3 force = beyond * a,
           moment = inertia * alpha + omega.cross(inertia * omega) + Vec3(0.5 * rest, 0, 0).cross(force);
      if (s < length) {  // at the last end the load of the tip is part of the remainder
        force -= push;
        moment -= Vec3(rest, off_y, off_z).cross(push);
      } else {
        force = -push;
        moment = -Vec3(0, off_y, off_z).cross(push);
      }
      if (s < midway) {
        force += 2.0 * push;
        moment += 2.0 * Vec3(midway - s, 0, 0).cross(push);
      }
      Vec6 expected;
      expected << -force, -moment;
      worst = std::max(worst, (forces[i] - expected).norm() / size);
    }
    held_within({"thesis §4.3", "section forces of a rod on a ball joint, of the largest", By::closed_form,
                 "what the part beyond the section needs", "Rigid, quasi-static"},
                worst, 1e-9, {equals("x", s), 1.0});
  }
  // the stress of self-balanced loads is independent of the reference conditions
  for (ReferenceConditions const& frame :
       {ReferenceConditions::clamped(4), ReferenceConditions::clamped(2), ReferenceConditions::simply_supported(0, 4)})
    EXPECT_LT(largest(stress.section_forces(0.7),
                      DecoupledStress::quasi_static(structure, run, {}, frame).section_forces(0.7)),
              1e-9 * size);
}

// General body: two rods at an angle, given to the rigid model by its integrals. Section forces of the second rod are
// known as above. The corner transmits its forces to the first rod.
TEST(DecoupledStress, OfABodyOfSeveralBarsIsThatOfEach) {
  Bar const first = rod(Placement::at({0.2, 0, 0}));
  Bar const second = rod(Placement::at({0.2 + length, 0, 0}, {0, 0, 0.5 * pi}));
  Structure const structure = structure_of({first, second}, {3, 4});
  Vec3 const centre = structure.first / structure.mass;
  Mat3 const central = structure.second - structure.mass * centre * centre.transpose();
  Arms model{Gravity{0, -3, -g}};
  auto const body =
      model.add(Rigid<>(structure.mass, central.trace() * Mat3::Identity() - central, Placement::at(centre)), "angle");
  model.connect(Ball{}, model.ground().at({0.2, 0, 0}), body.at(Vec3(Vec3(0.2, 0, 0) - centre)), "ball");
  BodyRecord const run = record(model, body, model.reference_state(), Exact{}, {.end_time = 0.5, .step = 5e-3});
  auto const stress = DecoupledStress::quasi_static(structure, run);
  BarConstants const c = constants(rod());
  for (double const s : {0.0, 0.4, 1.1}) {
    std::vector<Vec6> const forces = stress.section_forces(s, 1);
    double const rest = length - s, beyond = c.mass_per_length * rest, along = beyond * rest * rest / 12.0;
    Mat3 const inertia = Vec3((c.rotary_inertia + *c.rotary_inertia_y) * rest, along + *c.rotary_inertia_y * rest,
                              along + c.rotary_inertia * rest)
                             .asDiagonal();
    for (std::size_t i = 0; i < forces.size(); ++i) {
      BodySample const& at = run.samples[i];
      Mat3 const to_bar = (at.frame.A * second.placement.axes).transpose();
      Vec3 const omega = to_bar * at.frame.w, alpha = to_bar * at.angular_acceleration;
      Vec3 const middle =
          second.placement.axes.transpose() * (Vec3(second.placement.origin) - centre) + Vec3(s + 0.5 * rest, 0, 0);
      Vec3 const force =
          beyond * (to_bar * (at.acceleration - run.gravity) + alpha.cross(middle) + omega.cross(omega.cross(middle)));
      Vec6 expected;
      expected << -force, -(inertia * alpha + omega.cross(inertia * omega) + Vec3(0.5 * rest, 0, 0).cross(force));
      held_within({"thesis §4.3", "section forces of an angle of two rods, of the weight of one", By::closed_form,
                   "what the part beyond the section needs", "Rigid, quasi-static"},
                  (forces[i] - expected).norm() / (mass * g), 1e-9, {equals("x", s), 1.0});
    }
  }
  std::vector<Vec6> const before = stress.section_forces(length, 0), after = stress.section_forces(0.0, 1);
  Mat3 const turn = second.placement.axes;
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_LT((before[i].head<3>() - turn * after[i].head<3>()).norm(), 1e-9 * mass * g);
    EXPECT_LT((before[i].tail<3>() - turn * after[i].tail<3>()).norm(), 1e-9 * mass * g);
  }
}

// Block of eight masses without rotations, all joined by springs. A force and a moment in a general direction act on
// its upper face. The springs between the faces carry the inertia of the lower face.
TEST(DecoupledStress, OfNodesWithoutRotationsIsCarriedByAPatch) {
  double const stiff = 1e6, node_mass = 0.5;
  std::vector<Vec3> nodes;
  for (int i = 0; i < 8; ++i) nodes.emplace_back(i & 1 ? 0.1 : -0.1, i & 2 ? 0.15 : -0.15, i & 4 ? 0.3 : -0.3);
  auto const along = [&](int i, int j) { return Vec3((nodes[std::size_t(j)] - nodes[std::size_t(i)]).normalized()); };
  MatX k = MatX::Zero(24, 24);
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < i; ++j) {
      VecX pull = VecX::Zero(24);
      pull.segment<3>(3 * i) = -along(i, j);
      pull.segment<3>(3 * j) = along(i, j);
      k += stiff * pull * pull.transpose();
    }
  Structure const block = structure_of(Structure::Sparse((node_mass * MatX::Identity(24, 24)).sparseView()),
                                       Structure::Sparse(k.sparseView()), nodes);
  Model<Bodies<Rigid<>>, Joints<>, Forces<PointForce<>, PointMoment<>>> model{Gravity{0, 0, -g}};
  Mat3 const inertia = block.second.trace() * Mat3::Identity() - block.second;
  auto const body = model.add(Rigid<>(8 * node_mass, inertia, Placement::at({1, 0, 0}, {0.3, 0.5, 0})), "block");
  auto const hook = body.at(Vec3(0.05, 0.02, 0.35));
  model.apply(PointForce<>{.force = {30, -20, 400}}, hook, "lift");
  model.apply(PointMoment<>{.moment = {3, 2, 5}}, hook, "twist");
  BodyRecord const run = record(model, body, model.reference_state(), Exact{}, {.end_time = 0.1, .step = 0.005});
  auto const stress = DecoupledStress::quasi_static(block, run, {.patch = 0.3});
  for (std::size_t t = 0; t < run.samples.size(); ++t) {
    BodySample const& at = run.samples[t];
    Mat3 const to_body = at.frame.A.transpose();
    Vec3 const omega = to_body * at.frame.w, alpha = to_body * at.angular_acceleration;
    Vec3 force = Vec3::Zero(), moment = force;
    for (int i = 0; i < 4; ++i) {
      Vec3 const r = nodes[std::size_t(i)];
      Vec3 f = -node_mass * (to_body * (at.acceleration - run.gravity) + alpha.cross(r) + omega.cross(omega.cross(r)));
      for (int j = 4; j < 8; ++j) {
        VecX const u = stress.displacements().col(Index(t));
        f += stiff * along(i, j).dot(u.segment<3>(3 * j) - u.segment<3>(3 * i)) * along(i, j);
      }
      force += f;
      moment += r.cross(f);
    }
    Claim const faces{"thesis §4.3",
                      "what springs give a face of a block of masses, less what its motion needs, of the load",
                      By::closed_form, "0", "Rigid, quasi-static, masses and springs"};
    held_within(faces, force.norm() / 400.0, 1e-9, {"force", 1.0});
    held_within(faces, moment.norm() / 400.0, 1e-9, {"moment", 1.0});
  }
  // The stiffness against rigid motions of a matrix from a file is round-off, and constrains nothing.
  Structure rounded = block;
  rounded.stiffness += (1e-9 * stiff * MatX::Identity(24, 24)).sparseView();
  MatX const again = DecoupledStress::quasi_static(rounded, run, {.patch = 0.3}).displacements();
  EXPECT_LT((again - stress.displacements()).norm(), 1e-6 * stress.displacements().norm());
  EXPECT_TRUE(
      has(refusal([&] { DecoupledStress::quasi_static(block, run); }),
          "nodes within 0 m of a load: a patch needs at least three nodes that are not in line, but this patch has 0. "
          "Enlarge the patch."));
}

/// Clamped rod whose tip force grows by `rate` per second, in one mode φ with φᵀMφ = 1 and ω² = φᵀKφ: q¨ + ω²q =
/// φ_tip · rate · t from rest,
///   q = φ_tip · rate/ω² (t − sin ωt/ω).   It is read off the displacements e: K e = f − Mφ q¨ makes φᵀM e = (φᵀf −
///   q¨)/ω² = q.
struct Ramped {
  Structure structure = structure_of(rod(), 3);
  MatX shape = fixed_interface_modes(structure, 1);
  BodyRecord run;
  double omega = std::sqrt((shape.transpose() * (structure.stiffness * shape))(0, 0)), rate = 50.0;

  Ramped() {
    Arms model;
    auto const arm = model.add(Rigid<>::from(rod()), "arm");
    model.connect(Clamp{}, model.ground().at({0, 0, 0}), arm.at(0.0), "clamp");
    model.apply(PointForce<Ramp>{.force = {0, rate, rate}, .law = {.target = 1.0, .duration = 1.0}}, arm.at(length),
                "tip");
    run = record(model, arm, model.reference_state(), GeneralisedAlpha{}, {.end_time = 0.5, .step = 0.01});
  }
  /// Largest error relative to the largest q.
  template <class I>
  double error(I const& integrator, int substeps) const {
    auto const stress = DecoupledStress::vibrating(structure, run, integrator, {.shapes = shape, .substeps = substeps});
    VecX const q = (shape.transpose() * (structure.mass_matrix() * stress.displacements())).transpose();
    double const scale = (shape(19, 0) + shape(20, 0)) * rate / (omega * omega);
    double worst = 0.0, most = 0.0;
    for (std::size_t i = 0; i < run.samples.size(); ++i) {
      double const t = run.samples[i].t, exact = scale * (t - std::sin(omega * t) / omega);
      worst = std::max(worst, std::abs(q[Index(i)] - exact));
      most = std::max(most, std::abs(exact));
    }
    EXPECT_GT(most, 0.0);
    return worst / most;
  }
};

// The load is linear between samples, so each integrator has its own order: half of the step gives a quarter or a
// 16th of the error.
TEST(DecoupledStress, VibratesByAnyIntegrator) {
  Ramped const r;
  for (auto const& [coarse, fine, order] :
       {std::tuple(r.error(GeneralisedAlpha{.rho_inf = 0.9}, 4), r.error(GeneralisedAlpha{.rho_inf = 0.9}, 8), 2),
        {r.error(Trapezoidal{}, 4), r.error(Trapezoidal{}, 8), 2},
        {r.error(Exact{}, 4), r.error(Exact{}, 8), 4}}) {
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.2);
    EXPECT_LT(coarse, 0.01);
  }
  auto const ramped = [&](auto const& integrator, int substeps, double tolerance) {
    held_within({"thesis §4.3", "mode of a rod under a force that grows, of the largest", By::closed_form,
                 "t − sin ωt/ω", std::string("vibrating, ") + std::string(integrator.name)},
                r.error(integrator, substeps), tolerance, {.scale = 1.0});
  };
  ramped(Radau{}, 2, 1e-5);
  ramped(DormandPrince<>{}, 1, 1e-6);
  ramped(AdamsBashforthMoulton<>{}, 1, 1e-5);
}

TEST(DecoupledStress, RefusesInSentences) {
  Arms model{Gravity{0, -g, 0}};
  auto const arm = model.add(Rigid<>::from(rod()), "link 7");
  model.connect(Pin{{.axis = {0, 0, 1}}, {}}, model.ground().at({0, 0, 0}), arm.at(0.0), "pin");
  BodyRecord const run =
      record(model, arm, model.reference_state(), GeneralisedAlpha{}, {.end_time = 0.5, .step = 0.01});
  Structure const structure = structure_of(rod(), 2);
  auto const refused = [&](BodyRecord const& r) {
    return refusal([&] { DecoupledStress::quasi_static(structure, r); });
  };

  BodyRecord gap = run;
  gap.samples.erase(gap.samples.begin() + 20, gap.samples.begin() + 25);
  EXPECT_TRUE(has(refused(gap),
                  "Stress of \"link 7\": there is no sample between 0.19 s and 0.25 s, a gap of more than 0.015 s. "
                  "Record every step"));
  EXPECT_EQ(DecoupledStress::quasi_static(structure, gap, {.largest_gap = 0.1}).times().size(), run.samples.size() - 5);
  BodyRecord back = run;
  std::swap(back.samples[3], back.samples[4]);
  EXPECT_TRUE(has(refused(back), "times of the samples must increase"));
  BodyRecord short_one = run;
  short_one.samples.resize(1);
  EXPECT_TRUE(has(refused(short_one), "needs at least two samples, but has 1."));
  BodyRecord unloaded = run;
  for (BodySample& s : unloaded.samples) s.loads.clear();
  EXPECT_TRUE(has(refused(unloaded), "do not balance the inertia of the structure"));
  Bar heavy = rod();
  heavy.material->density = 1.01 * density;
  EXPECT_TRUE(has(refusal([&] { DecoupledStress::quasi_static(structure_of(heavy, 2), run); }),
                  "Give the structure the mass, inertia and placement"));
  Bar tight = rod();
  tight.pretension = 100.0;
  EXPECT_TRUE(has(refusal([&] { DecoupledStress::quasi_static(structure_of(tight, 2), run); }),
                  "a pretension is not computed"));

  auto const stress = DecoupledStress::quasi_static(structure, run);
  EXPECT_TRUE(has(refusal([&] { stress.section_forces(2.0); }), "lies outside the body"));
  EXPECT_TRUE(has(refusal([&] { stress.section_forces(0.5, 1); }), "bar 1 does not exist"));
  EXPECT_TRUE(has(refusal([&] { low_pass(stress.times(), stress.axial_strain(0.5), {.cut_off = 60.0}); }),
                  "the cut-off of 60 Hz is above the Nyquist frequency of 50 Hz for samples 0.01 s apart. Record in "
                  "smaller steps"));
  EXPECT_EQ(low_pass(stress.times(), stress.axial_strain(0.5), {.cut_off = 15.0}).size(), run.samples.size());

  EXPECT_TRUE(has(refusal([&] {
                    DecoupledStress::vibrating(
                        structure, run, Trapezoidal{},
                        {.shapes = fixed_interface_modes(structure, 2, ReferenceConditions::clamped(2))});
                  }),
                  "the shapes move node 0, which the reference conditions fix"));
  MatX twice = fixed_interface_modes(structure, 2);
  twice.col(1) = twice.col(0);
  EXPECT_TRUE(has(refusal([&] { DecoupledStress::vibrating(structure, run, Trapezoidal{}, {.shapes = twice}); }),
                  "linearly dependent shapes"));
  EXPECT_TRUE(has(refusal([&] { DecoupledStress::vibrating(structure, run, Trapezoidal{}, {.substeps = 0}); }),
                  "at least one substep"));
  EXPECT_TRUE(
      has(refusal([&] { DecoupledStress::quasi_static(structure, run, {}, ReferenceConditions::none().fix(0, 0)); }),
          "not positive definite"));
}

}  // namespace decoupled_stress_test
