// ANCF cable in space. The elastica (S2) and the cantilever of Gerstmayr & Irschik 2008 (S3) are in an inclined
// plane. The other cases are a hanging cable (S11) and the very flexible spinning pendulum of Gerstmayr and of
// Chrono's utest_FEA_ANCFCable (D6a). The pendulum is also modelled by Lrvf and Se3Beam.

#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/se3/se3_beam.hpp>

#include <gtest/gtest.h>

#include <polybody/forces/loads.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/statics/equilibrium.hpp>

#include "support/held.hpp"
#include "support/refusal.hpp"
#include "support/spinning_pendulum.hpp"

using namespace polybody;

namespace spatial_cable_test {

using Cable = AncfCable<EngineeringStrain>;
using Clamp = Joint<Revolute, Constraint>;
using Ball = Joint<Spherical, Constraint>;
/// Model type for bodies on ball joints, which is compiled once.
using Hung = Model<Bodies<Cable, Lrvf<>, Se3Beam>, Joints<Ball>>;

Placement const askew = Placement::at({0.3, -0.2, 0.7}, {0.8, -1.1, 0.4});

/// Displacement of the tip in the placement's axes under a dead tip force and moment in these axes.
Vec3 tip(Bar bar, Index n, Vec3 const& force, Vec3 const& moment = Vec3::Zero()) {
  bar.placement = askew;
  Model<Bodies<Cable>, Joints<Clamp>, Forces<PointForce<>, PointMoment<>>> model;
  auto const cable = model.add(Cable::from(bar, n), "cable");
  model.connect(Clamp{Revolute{.axis = askew.axes.col(0)}, {}}, model.ground().at(askew), cable.at(0.0), "clamp");
  model.apply(PointForce<>{.force = askew.axes * force}, cable.at(double(bar.length)));
  model.apply(PointMoment<>{.moment = askew.axes * moment}, cable.at(double(bar.length)));
  State x = model.reference_state();
  Vec3 const start = position(model, x, cable.at(double(bar.length)));
  equilibrium(model, x, {.load_steps = 10});
  return askew.axes.transpose() * (position(model, x, cable.at(double(bar.length))) - start);
}

Bar slender() { return {.length = 1.0, .constants = BarConstants{.EA = 1e6, .EI = 1.0, .mass_per_length = 1.0}}; }

// S2, w/L and u/L of the elastica, with the tolerances of the planar cable.
TEST(SpatialElastica, BendsInAnyPlane) {
  for (double const angle : {0.0, 0.7, 2.5}) {
    Vec3 const across(0.0, std::cos(angle), std::sin(angle));
    Vec3 const one = tip(slender(), 16, across), ten = tip(slender(), 16, 10.0 * across);
    auto const elastica = [](char const* what) {
      return Claim{"S2", what, By::independent, "elliptic integrals, 40 digits; the decimals of Mattiasson 1981",
                   "AncfCable in planes at 0, 0.7 and 2.5 rad, 16 elements"};
    };
    Instance const at_one{"PL²/EI = 1, " + equals("plane", angle)}, at_ten{"PL²/EI = 10, " + equals("plane", angle)};
    held(elastica("w/L of the tip"), one.dot(across), 0.3017207737998135, 8e-6, at_one);
    held(elastica("u/L of the tip"), -one[0], 0.05643323628337688, 1e-5, at_one);
    held(elastica("w/L of the tip"), ten.dot(across), 0.8106090248802965, 2.5e-4, at_ten);
    held(elastica("u/L of the tip"), -ten[0], 0.5549955977537513, 5e-4, at_ten);
    EXPECT_LT(one.cross(across)[0] * one.cross(across)[0], 1e-18);  // the tip stays in the plane
  }
}

// With EA l²/EI = 6e10 a step of 1 ms does not converge: a rotation of 1e-3 rad of an element causes an axial force of
// 5e5 N. The corrections of 100 m/s² do not consist of round-off. The refusal names this ratio.
TEST(SpatialCable, NamesTheAxialStiffnessIfAStepDoesNotConverge) {
  using Stiff = AncfCable<>;
  Model<Bodies<Stiff>, Joints<Ball>> model{Gravity{0, -9.81, 0}};
  Bar const bar{.length = 1.0, .constants = BarConstants{.EA = 1e12, .EI = 1.0, .mass_per_length = 1.0}};
  auto const cable = model.add(Stiff::from(bar, 4), "cable");
  model.connect(Ball{}, model.ground().at({0, 0, 0}), cable.at(0.0));
  State x = model.reference_state();
  std::string const message = message_of<NewtonConvergenceFailure>(
      [&] { simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.5, .step = 1e-3, .max_step_halvings = 0}).run(); });
  EXPECT_TRUE(has(message, "an axial stiffness EA of \"cable\" of at most 1e8 EI/l²")) << message;
  EXPECT_TRUE(has(message, "(now 6.25e+10 EI/l²)")) << message;
}

// S3, published digits for each mesh.
TEST(SpatialGerstmayrIrschik, GivesThePublishedDigits) {
  Bar const bar{.length = 2.0,
                .section = Rectangle{.height = 0.1, .width = 0.1},
                .material = Material{.density = 7850, .young = 2.07e11}};
  double const force = 3.0 * 1.725e6 / 4.0;
  struct Mesh {
    Index n;
    double x, y;
  };
  for (Mesh const& m :
       {Mesh{1, -0.36224472989050654, -0.9941447587249747}, Mesh{2, -0.4889263086109102, -1.1752228652637502},
        Mesh{4, -0.5074287154557922, -1.2055337025602493}}) {
    Vec3 const u = tip(bar, m.n, Vec3(0, -force, 0));
    auto const printed = [](char const* what) {
      return Claim{"S3", what, By::published, "Gerstmayr & Irschik 2008, Exudyn's ANCFcantileverTest.py",
                   "AncfCable, 1, 2 and 4 elements"};
    };
    Instance const at{equals("n", double(m.n))};
    held(printed("u_x of the tip, mesh by mesh [m]"), u[0], m.x, 1e-9, at);
    held(printed("u_y of the tip, mesh by mesh [m]"), u[1], m.y, 1e-9, at);
    EXPECT_NEAR(u[2], 0.0, 1e-9) << m.n;
  }
}

// S1: an arc of 1.2 rad under a tip moment about any axis across the cable, x = sin θ/θ, y = (1 − cos θ)/θ. (Without
// torsional stiffness the arc can rotate about its clamp. A dead moment stabilises it only up to a quarter of a
// circle.)
TEST(SpatialRollUp, TakesAMomentAcrossItsTangent) {
  double const turn = 1.2;
  for (double const angle : {0.0, 1.3}) {
    Vec3 const about(0.0, -std::sin(angle), std::cos(angle)), across(0.0, std::cos(angle), std::sin(angle));
    Vec3 const u = tip(slender(), 16, Vec3::Zero(), turn * about);
    auto const arc = [](char const* what, char const* source) {
      return Claim{"S1", what, By::closed_form, source, "AncfCable, 16 elements"};
    };
    Instance const at{equals("moment about", angle)};
    held(arc("x of the tip, turned by 1.2 rad [L]", "sin θ/θ"), u[0] + 1.0, std::sin(turn) / turn, 1e-6, at);
    held(arc("y of the tip, turned by 1.2 rad [L]", "(1 − cos θ)/θ"), u.dot(across), (1.0 - std::cos(turn)) / turn,
         1e-6, at);
    // the component of a moment along the tangent has no effect
    Vec3 const tangent = std::cos(turn) * Vec3::UnitX() + std::sin(turn) * across;
    EXPECT_LT((tip(slender(), 16, Vec3::Zero(), turn * about + 0.3 * tangent) - u).norm(), 1e-6);
  }
}

TEST(SpatialClamp, RefusesAPinAcrossTheTangent) {
  Model<Bodies<Cable>, Joints<Clamp>> model;
  auto const cable = model.add(Cable::from(slender(), 2), "cable");
  EXPECT_TRUE(has(refusal([&] {
                    model.connect(Clamp{Revolute{.axis = Vec3::UnitY()}, {}}, model.ground().at({0, 0, 0}),
                                  cable.at(0.0), "pin");
                  }),
                  "\"pin\": the second marker has a tangent but no axes"));
}

// Joints whose second marker provides only a point have their axis in any direction. A cable with one clamped end rests
// on such a joint across its tangent: force 3/8 m g. A sag of 1e-5 m changes it by 1e-6 of itself.
TEST(SpatialProp, HoldsACableAcrossItsTangent) {
  using Plane = Joint<PointInPlane, Constraint>;
  using Line = Joint<PointOnLine, Constraint>;
  using Slide = Joint<PrescribedTranslation<Constant>, Constraint>;
  auto const force = [](auto const& prop) {
    Bar const bar{.length = 1.0, .constants = BarConstants{.EA = 1e7, .EI = 1e4, .mass_per_length = 2.0}};
    Model<Bodies<Cable>, Joints<Clamp, Plane, Line, Slide>> model{Gravity{0, 0, -10}};
    auto const cable = model.add(Cable::from(bar, 8), "cable");
    model.connect(Clamp{Revolute{.axis = Vec3::UnitX()}, {}}, model.ground().at({0, 0, 0}), cable.at(0.0), "clamp");
    auto const joint = model.connect(prop, model.ground().at({1, 0, 0}), cable.at(1.0), "prop");
    State x = model.reference_state();
    equilibrium(model, x);
    return reaction(model, x, joint).f[2];
  };
  EXPECT_NEAR(force(Plane{PointInPlane{.normal = Vec3::UnitZ()}, {}}), 7.5, 1e-5);
  EXPECT_NEAR(force(Line{PointOnLine{.axis = Vec3::UnitY()}, {}}), 7.5, 1e-5);
  EXPECT_NEAR(force(Slide{{.law = {.value = 0.0}, .axis = Vec3::UnitZ()}, {}}), 7.5, 1e-5);
}

// S11: elastic catenary, 10 m of 10 N/m with supports at equal heights 8 m apart; 20 elements, EI = 1e-3 N m². The
// stiffer cable starts from the equilibrium of the softer one. EA = 1e9 approximates the inextensible cable: H
// differs by 5e-6.
TEST(SpatialCatenary, HangsWithThePublishedForceAndSag) {
  struct Row {
    double EA, H, sag;
  };
  // initial shape: an arc of 10 m over a chord of 8 m, sin u = 0.8 u for half of its angle
  double half = 1.0;
  for (int i = 0; i < 50; ++i) half -= (std::sin(half) - 0.8 * half) / (std::cos(half) - 0.8);
  double const radius = 5.0 / half;
  auto const arc = [&](double s) {
    double const u = s / radius - half;
    Placement p;
    p.origin = Vec3(4.0 + radius * std::sin(u), 0.0, radius * (std::cos(half) - std::cos(u)));
    p.axes = exp_so3<double>(Vec3(0, -u, 0));
    return p;
  };
  VecX hanging;
  for (Row const& row :
       {Row{1e4, 33.35480862, 2.687462764}, Row{1e6, 33.81541787, 2.654709857}, Row{1e9, 33.82018790, 2.654375092}}) {
    Bar const bar{.length = 10.0, .constants = BarConstants{.EA = row.EA, .EI = 1e-3, .mass_per_length = 1.0}};
    Hung model{Gravity{0, 0, -10.0}};
    auto const cable = model.add(Cable::from(bar, 20, arc), "cable");
    auto const left = model.connect(Ball{}, model.ground().at({0, 0, 0}), cable.at(0.0), "left");
    model.connect(Ball{}, model.ground().at({8, 0, 0}), cable.at(10.0), "right");
    State x = model.reference_state();
    if (hanging.size() > 0) x.q = hanging;
    equilibrium(model, x, {.max_iterations = 200});
    hanging = x.q;
    Wrench<double> const r = reaction(model, x, left);
    char const* const mesh = "AncfCable, 20 elements";
    Instance const at{row.EA == 1e9 ? "EA = 1e9, inextensible" : equals("EA", row.EA)};
    auto const elastic = [&](char const* what) {
      return Claim{"S11", what, By::independent, "elastic catenary without bending", mesh};
    };
    held(elastic("horizontal force of the cable [N]"), std::abs(r.f[0]), row.H, 1e-3 * row.H, at);
    held({"S11", "vertical force of the cable [N]", By::closed_form, "half of its weight", mesh}, std::abs(r.f[2]),
         50.0, 1e-6, at);
    held(elastic("sag of the cable [m]"), -position(model, x, cable.at(5.0))[2], row.sag, 1e-3 * row.sag, at);
  }
}

// D6a, h = 1 ms. The tolerance for 16 cable elements is 2e-3 to t = 1 s and 1e-2 at 2 s.
Claim spinning(char const* what, char const* formulation) {
  return {"D6a", what, By::independent, "spectral geometrically exact beam, two meshes", formulation};
}
template <class B>
void spins(Index n, char const* formulation) {
  Hung model{Gravity{0, -9.81, 0}};
  auto const rod = model.add(B::from(spinning_pendulum::bar(), n), "rod");
  model.connect(Ball{}, model.ground().at({0, 0, 0}), rod.at(0.0), "hinge");
  State x = model.reference_state();
  model.set_velocity(x, rod, Vec3::Zero(), Vec3(0, 4, 0));
  struct Row {
    double t;
    Vec3 tip, mid;
  };
  Row const rows[] = {{0.1, {0.917305, -0.049063, -0.387767}, {0.456406, -0.048748, -0.193291}},
                      {0.2, {0.660150, -0.196223, -0.699564}, {0.311624, -0.185786, -0.341537}},
                      {0.5, {-0.690713, -0.710316, -0.086963}, {-0.322446, -0.372293, -0.096017}},
                      {1.0, {0.653327, 0.045767, 0.658895}, {0.273900, -0.108163, 0.398954}},
                      {1.5, {-0.555340, -0.487708, -0.649961}, {-0.312379, -0.280193, -0.273679}},
                      {2.0, {-0.239876, -0.202892, 0.903284}, {-0.010451, -0.170533, 0.468231}}};
  for (Row const& row : rows) {
    simulate(model, x, GeneralisedAlpha{}, {.end_time = row.t, .step = 1e-3}).run();
    double const tolerance = row.t > 1.0 ? 1e-2 : 2e-3;
    Instance const at{equals("t", row.t), 1.0};
    held_within(spinning("tip [m]", formulation), (position(model, x, rod.at(1.0)) - row.tip).norm(), tolerance, at);
    held_within(spinning("middle [m]", formulation), (position(model, x, rod.at(0.5)) - row.mid).norm(), tolerance, at);
  }
}
TEST(SpinningPendulum, CableFollowsTheConvergedMotion) {
  spins<Cable>(16, "AncfCable, 16 elements, generalised-α, h = 1e-3 s");
}

// With many elements and small steps Newton's method must resolve the round-off of stretches. The small masses of the
// nodes convert it into accelerations beyond the tolerance. With large steps the corrections alternate between good
// and poor contraction.
TEST(SpinningPendulum, CableFollowsTheConvergedMotionWithRadau) {
  struct Run {
    Index n;
    double step, end_time;
    Vec3 tip;
  };
  for (Run const& run :
       {Run{32, 1e-3, 0.1, {0.917305, -0.049063, -0.387767}}, Run{16, 4e-3, 0.5, {-0.690713, -0.710316, -0.086963}}}) {
    Hung model{Gravity{0, -9.81, 0}};
    auto const rod = model.add(Cable::from(spinning_pendulum::bar(), run.n), "rod");
    model.connect(Ball{}, model.ground().at({0, 0, 0}), rod.at(0.0), "hinge");
    State x = model.reference_state();
    model.set_velocity(x, rod, Vec3::Zero(), Vec3(0, 4, 0));
    simulate(model, x, Radau{}, {.end_time = run.end_time, .step = run.step}).run();
    held_within(spinning("tip [m]", "AncfCable, 32 and 16 elements, Radau IIA, h = 1e-3 and 4e-3 s"),
                (position(model, x, rod.at(1.0)) - run.tip).norm(), 2e-3, {equals("t", run.end_time), 1.0});
  }
}
TEST(SpinningPendulum, LrvfFollowsTheConvergedMotion) {
  spins<Lrvf<>>(32, "Lrvf, 32 elements, generalised-α, h = 1e-3 s");
}
// With 32 helices the error of the tip is 2.2e-3 at 1 s, that of Lrvf 0.9e-3.
TEST(SpinningPendulum, Se3BeamFollowsTheConvergedMotion) {
  spins<Se3Beam>(40, "Se3Beam, 40 elements, generalised-α, h = 1e-3 s");
}

}  // namespace spatial_cable_test
