// Rotating beams by the floating frame of reference: spin-up (D2) and rotating cantilever (E3), and the effect of
// each coupling term.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"

namespace ffr_rotating_test {

using namespace polybody;

// D2: beam of Kane, Ryan & Banerjee 1987.
Bar kane_bar() {
  return {.length = 10.0,
          .constants = BarConstants{.EA = 2.8e7, .EI = 1.4e4, .mass_per_length = 1.2, .rotary_inertia = 6e-4}};
}

planar::Ffr kane_arm(Index modes, bool stiffening, FfrTerms terms = {}) {
  Structure const s = planar::Ffr::structure_in_plane(kane_bar(), 16);
  ReferenceConditions frame = ReferenceConditions::clamped();
  frame.restrict_to_plane();
  return {s, fixed_interface_modes(s, modes, frame), {.terms = terms, .stiffening = stiffening}};
}

struct SpinningArm {
  using Pin = Joint<planar::Revolute, Constraint>;
  using Drive = Joint<PrescribedAngle<SpinUp>, Constraint>;
  SpinUp const law{.speed = 6.0, .duration = 15.0};
  Model<Bodies<planar::Ffr>, Joints<Pin, Drive>> model;
  BodyHandle<planar::Ffr> arm;
  State x;

  explicit SpinningArm(planar::Ffr const& body) : arm(model.add(body, "arm")), x() {
    model.connect(Pin{}, model.ground().at({0, 0, 0}), arm.at(0.0), "pin");
    model.connect(Drive{{law}, {}}, model.ground().at({0, 0, 0}), arm.at(0.0), "drive");
    x = model.reference_state();
  }
  /// Displacement of the tip in the frame of the hub, which follows the driving constraint.
  Vec2 tip(State const& now) const {
    Vec3 const r = position(model, now, arm.at(10.0));
    double const psi = law(now.t).value, c = std::cos(psi), s = std::sin(psi);
    return {c * r[0] + s * r[1] - 10.0, c * r[1] - s * r[0]};
  }
  auto run(double end_time) {
    return simulate(model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = end_time, .step = 5e-3});
  }
};

Claim spin_up(char const* what, char const* formulation) {
  return {"D2", what, By::independent, "spectral geometrically exact beam, two meshes", formulation};
}

// With geometric stiffening and three bending modes the tolerance is 2 % of the largest deflection. The remaining
// vibration after 15 s agrees within 5 % of itself. Bending modes do not stretch. The exact u₁ contains the
// centrifugal stretch ρA ψ˙² L³/3EA (closed form), which this arm does not have.
TEST(SpinUp, StiffenedFrameFollowsTheIndependentSolution) {
  SpinningArm arm(kane_arm(3, true));
  char const* const modes = "planar Ffr with stiffening, 3 bending modes";
  struct Row {
    double t, u1, u2;
  };
  std::vector<Row> const rows{{2.5, -0.00132267702, -0.15128355864},
                              {5.0, -0.01265463625, -0.46847618344},
                              {6.5, -0.01860342132, -0.56994836841},
                              {7.5, -0.01774186447, -0.55908345896},
                              {10.0, -0.00707233630, -0.36281451565}};
  double const swing = 0.00364;  // remaining vibration of the independent solution from 15 s on [m]
  std::size_t next = 0;
  double largest = 0.0;
  for (State const& now : arm.run(18.0)) {
    Vec2 const u = arm.tip(now);
    if (next < rows.size() && std::abs(now.t - rows[next].t) < 1e-9) {
      held(spin_up("u₂ of the tip up to 10 s [m]", modes), u[1], rows[next].u2, 0.02 * 0.573835, {equals("t", now.t)});
      double const speed = arm.law(now.t).rate, stretch = 1.2 * speed * speed * 1000.0 / (3.0 * 2.8e7);
      held(spin_up("u₁ of the tip less the centrifugal stretch, up to 10 s [m]", modes), u[0], rows[next].u1 - stretch,
           0.02 * 0.0188, {equals("t", now.t), 0.0188});
      ++next;
    }
    if (std::abs(now.t - 15.0) < 1e-9) {
      held(spin_up("u₂ of the tip at 15 s [m]", modes), u[1], 1.30362629e-3, 0.05 * swing, {.scale = swing});
    }
    if (now.t > 15.0) largest = std::max(largest, std::abs(u[1]));
  }
  EXPECT_EQ(next, rows.size());
  held(spin_up("largest swing from 15 s on [m]", modes), largest, swing, 0.05 * swing);
}

// The steady stretch ω² ρA L³/3EA requires axial coordinates: all coordinates of four elements.
TEST(SpinUp, AxialCoordinatesGiveTheSteadyStretch) {
  Structure const s = planar::Ffr::structure_in_plane(kane_bar(), 4);
  ReferenceConditions frame = ReferenceConditions::clamped();
  SpinningArm arm({s, nodal_coordinates(s, frame.restrict_to_plane()), {.stiffening = true}});
  double sum = 0.0;
  int count = 0;
  for (State const& now : arm.run(18.0))
    if (now.t > 15.0) {
      sum += arm.tip(now)[0];
      ++count;
    }
  held(spin_up("mean stretch u₁ from 15 s on [m]", "planar Ffr, all coordinates of 4 elements"), sum / count,
       5.139493e-4, 1e-4 * 5.139493e-4);
}

// Negative control: the first frequency, 3.798 rad/s, is below the angular velocity of 6 rad/s. Without stiffening,
// centrifugal forces bend the arm away: u grows as exp(√(36 − 3.798²) t).
TEST(SpinUp, WithoutStiffeningTheDeflectionRunsAway) {
  SpinningArm arm(kane_arm(3, false));
  double const twice = 2.0 * 0.573835;  // largest lag of the arm with stiffening [m]
  double largest = 0.0, reached = 0.0;
  try {
    for (State const& now : arm.run(18.0)) {
      largest = std::max(largest, std::abs(arm.tip(now)[1]));
      reached = now.t;
      if (largest > 10.0) break;
    }
  } catch (Error const&) {  // diverges
  }
  EXPECT_GT(largest, twice) << "at " << reached;
}

// m_rf excites the arm. Without it the hub's acceleration does not excite the deformation.
TEST(SpinUp, WithoutCouplingTheArmDoesNotBend) {
  SpinningArm arm(kane_arm(3, true, {.coupling = false}));
  for (State const& now : arm.run(5.0)) EXPECT_LT(std::abs(arm.tip(now)[1]), 1e-9) << now.t;
}

/// Frequencies of a cantilever of unit EI, ρA and L that rotates steadily about z at the clamp: M q̈ + G q̇ + K q = 0
/// with the body's own matrices, dimensionless.
VecX spinning_frequencies(Ffr const& body, double omega) {
  Index const n = body.deformations();
  VecX q(body.coordinates()), v = VecX::Zero(body.velocities());
  body.reference({q.data(), std::size_t(q.size())});
  v[5] = omega;
  // about the stretch at which centrifugal and elastic forces are in balance
  std::span<double const> const qs(q.data(), std::size_t(q.size())), vs(v.data(), std::size_t(v.size()));
  VecX f(body.velocities());
  MatX k, g, m;
  for (int i = 0; i < 3; ++i) {
    body.force<double>(0, qs, vs, f);
    body.tangent(0, qs, vs, 1.0, 0.0, k);
    q.tail(n) += MatX(k.bottomRightCorner(n, n)).partialPivLu().solve(f.tail(n));
  }
  body.tangent(0, qs, vs, 1.0, 0.0, k);
  body.tangent(0, qs, vs, 0.0, 1.0, g);
  body.mass(0, qs, m);
  MatX a = MatX::Zero(2 * n, 2 * n);
  a.topRightCorner(n, n).setIdentity();
  Eigen::PartialPivLU<MatX> const lu(m.bottomRightCorner(n, n));
  a.bottomLeftCorner(n, n) = -lu.solve(MatX(k.bottomRightCorner(n, n)));
  a.bottomRightCorner(n, n) = -lu.solve(MatX(g.bottomRightCorner(n, n)));
  Eigen::EigenSolver<MatX> const solver(a, false);
  std::vector<double> w;
  for (Index i = 0; i < 2 * n; ++i)
    if (solver.eigenvalues()[i].imag() > 0.0) w.push_back(solver.eigenvalues()[i].imag());
  std::sort(w.begin(), w.end());
  return Eigen::Map<VecX>(w.data(), Index(w.size()));
}

Ffr unit_blade(FfrTerms terms = {}, bool stiffening = true) {
  Bar const bar{
      .length = 1.0,
      .constants = BarConstants{.EA = 1e6, .EI = 1.0, .mass_per_length = 1.0, .GJ = 0.1, .rotary_inertia = 1e-6}};
  return Ffr::from(bar, 10, {.terms = terms, .frame = FfrFrame::clamped, .stiffening = stiffening});
}

// E3: first three flap and chord frequencies of an inextensible cantilever. Here EA = 1e6 EI/L², with a rotary
// inertia of 1e-6 ρA L².
TEST(RotatingCantilever, HasTheFrequenciesOfTheTable) {
  struct Row {
    double omega, flap[3], chord[3];
  };
  for (Row const& row : {Row{0.0, {3.516015, 22.034491, 61.697214}, {3.516015, 22.034491, 61.697214}},
                         Row{2.0, {4.137320, 22.614922, 62.273184}, {3.621797, 22.526311, 62.241059}},
                         Row{6.0, {7.360373, 26.809082, 66.683914}, {4.263225, 26.129042, 66.413436}},
                         Row{12.0, {13.170150, 37.603112, 79.614478}, {5.427049, 35.636976, 78.704925}}}) {
    VecX const w = spinning_frequencies(unit_blade(), row.omega);
    std::vector<double> expected(row.flap, row.flap + 3);
    expected.insert(expected.end(), row.chord, row.chord + 3);
    std::sort(expected.begin(), expected.end());
    for (std::size_t i = 0; i < expected.size(); ++i)
      held({"E3", "flap and chord frequencies of a rotating cantilever, ω √(ρA L⁴/EI)", By::independent,
            "collocation; Wright et al. 1982 at Ω = 12", "Ffr, the body's own matrices, 10 elements"},
           w[Index(i)], expected[i], 1e-3 * expected[i], {equals("Ω", row.omega) + ", mode " + std::to_string(i + 1)});
  }
}

// Without stiffening the flap frequencies do not depend on the angular velocity, and the chord softens: ω² − Ω² [e.g.
// Kane, Ryan & Banerjee 1987]. S̃₂ causes this softening: without S̃₂ the chord keeps its frequency. S̃₁ couples the
// chord to the axial motion only, whose frequencies are far away.
TEST(RotatingCantilever, EachTermDoesWhatItIsSaidToDo) {
  double const omega = 3.0, first = 3.516015;
  VecX const soft = spinning_frequencies(unit_blade({}, false), omega);
  EXPECT_NEAR(soft[0], std::sqrt(first * first - omega * omega), 2e-3);
  EXPECT_NEAR(soft[1], first, 1e-3);
  VecX const plain = spinning_frequencies(unit_blade({.centrifugal = false}, false), omega);
  EXPECT_NEAR(plain[0], first, 1e-3);
  EXPECT_NEAR(plain[1], first, 1e-3);
  // S̃₁: the gyroscopic part of the tangent
  for (bool const coriolis : {true, false}) {
    Ffr const body = unit_blade({.coriolis = coriolis}, false);
    VecX q(body.coordinates()), v = VecX::Zero(body.velocities());
    body.reference({q.data(), std::size_t(q.size())});
    v[5] = omega;
    MatX g;
    body.tangent(0, {q.data(), std::size_t(q.size())}, {v.data(), std::size_t(v.size())}, 0.0, 1.0, g);
    EXPECT_EQ(g.bottomRightCorner(60, 60).norm() > 0.1, coriolis);
  }
}

}  // namespace ffr_rotating_test
